// What becomes of a pose that the verdict rule declares, where a verifier looks for its rivals.
#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "glocal/localizer.hpp"
#include "pipeline/in_stage.hpp"
#include "pipeline/stage_contracts.hpp"

namespace glocal {
namespace {

/// The best score of a hypothesis near the declared pose.
double score_near(const Pose3& declared, const PoseTolerance& near, const StepResult& result) {
  for (const Hypothesis& h : result.hypotheses) {
    if (near.are_near(h.map_from_robot, declared)) return h.score;
  }
  return result.score_best;
}

/// Why a pose is not declared after all: it has rivals, or no certificate, or not the one that it needs.
std::string why_refuted(const Verification& v, std::size_t rivals) {
  if (rivals > 0) {
    return fmt::format("a search of the whole map found {} about as good",
                       rivals == 1 ? "another one" : fmt::format("{} others", rivals));
  }
  if (v.mirrored_contact)
    return fmt::format("its mirror image fits better: {:.0f} % contact", 100.0 * *v.mirrored_contact);
  if (!v.certificate) return "the search of the whole map was given up: too many poses are about as good";
  return fmt::format("it has {:.0f} % contact, and up to {:.0f} % cannot be ruled out elsewhere",
                     100.0 * v.certificate->contact, 100.0 * v.certificate->at_most);
}

/// Takes the verdict back where a rival is about as good, or the search was given up; else tells the
/// certificate. Whether it was taken back is noted in the verification.
void settle(Verification& v, Verdict& verdict) {
  std::vector<Pose3> candidates = {*verdict.map_from_robot};
  for (const Hypothesis& rival : v.rivals) {
    if (v.is_about_as_good(rival)) candidates.push_back(rival.map_from_robot);
  }
  const std::size_t rivals = candidates.size() - 1;
  const bool is_topped = v.certificate && v.certificate->at_most > v.certificate->contact;
  v.is_refuted =
      rivals > 0 || !v.certificate || (verdict.needs_certificate && is_topped) || v.mirrored_contact;
  if (!v.is_refuted) {
    verdict.why += fmt::format("; {:.0f} % contact, and at most {:.0f} % at any pose elsewhere",
                               100.0 * v.certificate->contact, 100.0 * v.certificate->at_most);
    return;
  }
  verdict.kind = rivals > 0 ? VerdictKind::ambiguous : VerdictKind::searching;
  verdict.map_from_robot.reset();
  verdict.why = "the best pose was about to be declared, but " + why_refuted(v, rivals);
  if (verdict.estimate)
    verdict.estimate->confidence =
        std::min(verdict.estimate->confidence, 1.0 / static_cast<double>(rivals + 1));
  if (rivals > 0) verdict.candidates = std::move(candidates);
}

}  // namespace

void Localizer::verify(const LocalMap& local, StepResult& result, std::optional<std::size_t> looks_after) {
  if (result.verdict.kind != VerdictKind::localized) {
    verified_.reset();
    return forget_verification(result.step);
  }
  if (local.points.empty() || !by_contact_->verifier) return;
  const auto stage = looks_after ? &StageTimes::after : &StageTimes::verify;
  const Pose3 declared = *result.verdict.map_from_robot;
  const Pose3 map_from_local = declared * inverse(local.local_from_robot);
  if (verified_ && verified_->epoch == local.epoch &&
      verified_->near.are_near(verified_->map_from_local * local.local_from_robot, declared)) {
    // A local map drifts, and its pose with it.
    verified_->map_from_local = map_from_local;
    return;
  }
  verified_.reset();
  Verifier& verifier = *by_contact_->verifier;
  Verification found;
  in_stage(stages_.verifier, result.step, [&] {
    timed(stage, result, [&] {
      found = looks_after ? verifier.go_on(local, map_from_local, gate_, *looks_after)
                          : verifier.verify(local, map_from_local, gate_);
    });
    check_verification(found, motion_);
  });
  if (result.verification) found.points_tested += result.verification->points_tested;
  is_verifying_ = found.goes_on;
  if (is_verifying_) {
    result.verification = std::move(found);
    return;
  }
  in_stage(stages_.matcher, result.step, [&] {
    timed(stage, result,
          [&] { found.rivals = by_contact_->matcher->rescore(std::move(found.rivals), local); });
    for (Hypothesis& h : found.rivals) h.map_from_robot = h.map_from_local * local.local_from_robot;
    check_hypotheses(found.rivals, 0.0, motion_);
  });
  // A matcher that refines what it rescores may have come back to the declared pose, or left the prior.
  std::erase_if(found.rivals, [&](const Hypothesis& h) {
    return found.near.are_near(h.map_from_robot, declared) || !gate_.allows(h.map_from_local);
  });
  found.score = score_near(declared, found.near, result);
  settle(found, result.verdict);
  if (!found.is_refuted) verified_ = {map_from_local, local.epoch, found.near};
  if (found.is_mirrored) {
    result.setup = result.setup.value_or(SetupCheck{});
    result.setup->fault = SetupFault::mirrored;
    result.verdict.why = result.setup->why();
  }
  result.verification = std::move(found);
  if (!result.verification->is_refuted) return;
  in_stage(stages_.verdict_rule, result.step, [&] { verdict_rule_->refute(*result.verification); });
}

void Localizer::forget_verification(std::size_t step) {
  if (!is_verifying_) return;
  is_verifying_ = false;
  in_stage(stages_.verifier, step, [&] {
    for (const auto& [epsilon, stages] : by_epsilon_) stages.verifier->reset();
  });
}

}  // namespace glocal
