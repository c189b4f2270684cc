#include "raters/consecutive_rating.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "raters/candidates.hpp"

namespace glocal::raters {
namespace {

/// A cluster is a candidate if its rating (eq. 7) is at least this share of the best one's.
constexpr double candidate_share = 0.4;

}  // namespace

void describe(ParamVisitor& v, ConsecutiveRating::Params& p) {
  v.field("min_rating", p.min_rating,
          {.doc = "The normalised rating (eq. 8) must be larger than this.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::tuner});
  v.field("consecutive", p.consecutive,
          {.doc = "Number of consecutive steps in which the same cluster must be rated so highly.",
           .min = 1,
           .audience = Audience::tuner});
}

Verdict ConsecutiveRating::judge(const StepResult& step) {
  if (step.clusters.empty()) {
    last_.reset();
    return {.kind = VerdictKind::searching, .why = "no pose fits the local map well enough in this step"};
  }
  const Pose3& pose = step.clusters.front().map_from_robot;
  const double rating = step.ratings.front().r_normalised;
  if (rating > params_.min_rating) {
    // A scan with hardly a point leaves the local map as it was, which would be rated the same for ever.
    const int earlier = last_ && last_->pose.may_be(pose, step) ? last_->count : 0;
    const int count = step.saw_nothing ? earlier : earlier + 1;
    last_ = Leader{FollowedPose::of(step, pose), count};
    if (count >= params_.consecutive) {
      return {.kind = VerdictKind::localized,
              .map_from_robot = pose,
              .why = fmt::format("the same cluster had r̄ over {:.2f} in {} consecutive steps",
                                 params_.min_rating, count)};
    }
    return {.kind = VerdictKind::searching,
            .why = fmt::format("a cluster has r̄ = {:.2f}, in {} of {} steps needed", rating, count,
                               params_.consecutive)};
  }
  last_.reset();
  if (std::optional<Verdict> verdict = ambiguous(candidates(step))) return *std::move(verdict);
  return {.kind = VerdictKind::searching,
          .why = fmt::format(
              "the best of {} clusters has only r̄ = {:.2f} of all ratings, and more than {:.2f} is needed",
              step.clusters.size(), rating, params_.min_rating)};
}

/// Robot poses of the highly rated clusters, leaving out those that only repeat a better one.
std::vector<Pose3> ConsecutiveRating::candidates(const StepResult& step) const {
  std::vector<Pose3> poses;
  const double least = candidate_share * step.ratings.front().r;
  for (std::size_t i = 0; i < step.clusters.size() && step.ratings[i].r >= least; ++i) {
    const Pose3& pose = step.clusters[i].map_from_robot;
    if (std::ranges::none_of(poses, [&](const Pose3& other) { return are_same(pose, other); })) {
      poses.push_back(pose);
    }
  }
  return poses;
}

}  // namespace glocal::raters
