// The poses of one step that are worth a closer look.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/contact.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "glocal/prior.hpp"
#include "matchers/common/candidates.hpp"

namespace glocal {

/// Candidates by the contact of a sample of the local map's points.
class StepCandidates {
 public:
  /// `min_contact`: what a proposed pose needs before it is refined, as the right one may have little then.
  /// Candidates that `gate` does not allow are left out. All that is given must outlive this.
  StepCandidates(const ContactIndex& contact, const Points& sample, double min_contact, const PoseGate& gate)
      : contact_(contact), sample_(sample), min_contact_(min_contact), gate_(gate) {}

  /// A pose that is known to be worth it.
  void add(const Pose2& map_from_local);
  /// Adds those of the first `size` poses of a batch that have enough contact.
  void test(const MotionBatch& map_from_local, std::size_t size);
  /// Leaves the distinct ones, refined.
  void refine(const CandidateRefiner& refiner, const Pose2& local_from_robot);

  [[nodiscard]] const std::vector<Candidate>& all() const { return candidates_; }
  /// Poses, and points of them, that test() has looked at.
  [[nodiscard]] std::size_t tested() const { return tested_; }
  [[nodiscard]] std::size_t points_tested() const { return points_tested_; }

 private:
  const ContactIndex& contact_;
  const Points& sample_;
  double min_contact_;
  const PoseGate& gate_;
  std::vector<Candidate> candidates_;
  std::size_t tested_ = 0;
  std::size_t points_tested_ = 0;
};

}  // namespace glocal
