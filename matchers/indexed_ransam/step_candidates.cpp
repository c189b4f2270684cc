#include "matchers/indexed_ransam/step_candidates.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace glocal::indexed_ransam {

StepCandidates::StepCandidates(const ContactIndex& contact, const Points& sample, double min_contact,
                               std::size_t enough, const PoseGate& gate)
    : contact_(contact),
      sample_(sample),
      enough_(enough),
      gate_(gate),
      batch_(std::max<std::size_t>(1, (sample.size() + looks - 1) / looks)),
      bar_(static_cast<std::size_t>(std::ceil(min_contact * static_cast<double>(sample.size())))),
      found_(sample.size() + 1, 0),
      first_look_(std::min<std::size_t>(16, sample.size())),
      waiting_(first_look_ + 1) {
  set_least();
}

void StepCandidates::add(const Pose2& map_from_local) {
  candidates_.push_back({map_from_local, contact_.share(sample_, Transform(map_from_local))});
}

void StepCandidates::test(const MotionBatch& map_from_local, std::size_t size) {
  // A cheap look at 16 points spares most wrong poses the closer one. To ask for contact of one more point
  // instead, as Winkelbach et al. do, is no faster and loses more poses; both is slower than this alone
  // (bench_indexed, look).
  ContactIndex::BatchColumn begins{};
  ContactIndex::BatchColumn at_most{};
  contact_.count_at_most(sample_, first_look_, map_from_local, size, begins, at_most);
  tested_ += size;
  for (std::size_t i = 0; i < size; ++i) {
    // Even the coarse look is below what is asked for.
    if (at_most[i] < least_at_first_) {
      points_tested_ += first_look_;
      continue;
    }
    waiting_[at_most[i]].push_back(map_from_local[i]);
    ++all_waiting_;
  }
  constexpr std::size_t most_waiting = 4096;
  if (all_waiting_ >= most_waiting) look_closer();
}

/// The best at first sight come first: what they have soon raises the bar for the others.
void StepCandidates::look_closer() {
  for (std::size_t at_most = first_look_ + 1; at_most-- > 0;) {
    for (const Transform& map_from_local : waiting_[at_most]) {
      if (at_most < least_at_first_) {
        points_tested_ += first_look_;
        continue;
      }
      if (!gate_.is_open() && !gate_.allows(map_from_local.pose())) continue;
      const ContactIndex::Count count =
          contact_.count_while(sample_, 0, sample_.size(), batch_, least_, map_from_local);
      points_tested_ += count.looked_at;
      if (count.looked_at == sample_.size() && count.in_contact >= bar_)
        take(map_from_local.pose(), count.in_contact);
    }
    waiting_[at_most].clear();
  }
  all_waiting_ = 0;
}

void StepCandidates::take(const Pose2& map_from_local, std::size_t in_contact) {
  candidates_.push_back(
      {map_from_local, static_cast<double>(in_contact) / static_cast<double>(sample_.size())});
  ++found_[in_contact];
  ++found_above_;
  const std::size_t before = bar_;
  while (found_above_ - found_[bar_] >= enough_) found_above_ -= found_[bar_++];
  if (bar_ != before) set_least();
}

/// What a pose has in contact of its first n points, a standard deviation below what the bar asks for: one
/// that has less will hardly be above it.
std::uint32_t StepCandidates::promising(std::size_t n) const {
  const double share = static_cast<double>(bar_) / static_cast<double>(sample_.size());
  const auto points = static_cast<double>(n);
  const double least = points * share - std::sqrt(points * share * (1.0 - share));
  return static_cast<std::uint32_t>(std::max(0.0, std::ceil(least)));
}

void StepCandidates::set_least() {
  least_at_first_ = promising(first_look_);
  for (std::size_t i = 0; i < looks; ++i) least_[i] = promising(std::min((i + 1) * batch_, sample_.size()));
}

void StepCandidates::refine(const CandidateRefiner& refiner, const Pose2& local_from_robot) {
  look_closer();
  candidates_ = refiner.refined(std::move(candidates_), local_from_robot, sample_, sample_);
  std::erase_if(candidates_, [&](const Candidate& c) { return !gate_.allows(c.map_from_local); });
}

}  // namespace glocal::indexed_ransam
