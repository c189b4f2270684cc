#include "matchers/indexed_ransam/step_candidates.hpp"

#include <algorithm>
#include <utility>

namespace glocal {

void StepCandidates::add(const Pose2& map_from_local) {
  candidates_.push_back({map_from_local, contact_.share(sample_, Transform(map_from_local))});
}

void StepCandidates::test(const MotionBatch& map_from_local, std::size_t size) {
  // A cheap look at 16 points spares most wrong poses the closer one. To ask for contact of one more point
  // instead, as Winkelbach et al. do, is no faster and loses more poses; both is slower than this alone
  // (bench_indexed, look).
  constexpr std::size_t first_look = 16;
  const std::size_t looked_at = std::min(first_look, sample_.size());
  ContactIndex::BatchColumn begins{};
  ContactIndex::BatchColumn at_most{};
  contact_.count_at_most(sample_, looked_at, map_from_local, size, begins, at_most);
  tested_ += size;
  for (std::size_t i = 0; i < size; ++i) {
    // Even the coarse look is below what is asked for.
    if (static_cast<double>(at_most[i]) < min_contact_ * static_cast<double>(looked_at)) {
      points_tested_ += looked_at;
      continue;
    }
    if (!gate_.is_open() && !gate_.allows(map_from_local[i].pose())) continue;
    points_tested_ += sample_.size();
    const double share = contact_.share(sample_, map_from_local[i]);
    if (share >= min_contact_) candidates_.push_back({map_from_local[i].pose(), share});
  }
}

void StepCandidates::refine(const CandidateRefiner& refiner, const Pose2& local_from_robot) {
  candidates_ = refiner.refined(std::move(candidates_), local_from_robot, sample_, sample_);
  std::erase_if(candidates_, [&](const Candidate& c) { return !gate_.allows(c.map_from_local); });
}

}  // namespace glocal
