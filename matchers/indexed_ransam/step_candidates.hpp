// The poses of one step that are worth a closer look.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "glocal/contact.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "glocal/prior.hpp"
#include "matchers/common/candidates.hpp"

namespace glocal::indexed_ransam {

/// Candidates by the contact of a sample of the local map's points.
class StepCandidates {
 public:
  /// `min_contact`: what a proposed pose needs before it is refined, as the right one may have little then.
  /// Once `enough` have it, a pose needs as much as the worst of the best `enough` has. Candidates that
  /// `gate` does not allow are left out. All that is given must outlive this.
  StepCandidates(const ContactIndex& contact, const Points& sample, double min_contact, std::size_t enough,
                 const PoseGate& gate);

  /// A pose that is known to be worth it.
  void add(const Pose2& map_from_local);
  /// Takes in the first `size` poses of a batch. Those that look good enough wait for a closer look.
  void test(const MotionBatch& map_from_local, std::size_t size);
  /// Adds those that wait and have enough contact.
  void look_closer();
  /// Looks closer, and leaves the distinct ones, refined.
  void refine(const CandidateRefiner& refiner, const Pose2& local_from_robot);

  [[nodiscard]] const std::vector<Candidate>& all() const { return candidates_; }
  /// Poses, and points of them, that test() has looked at.
  [[nodiscard]] std::size_t tested() const { return tested_; }
  [[nodiscard]] std::size_t points_tested() const { return points_tested_; }

 private:
  /// Batches of points in which a pose is looked at, as far as it is promising.
  static constexpr std::size_t looks = 8;

  void take(const Pose2& map_from_local, std::size_t in_contact);
  [[nodiscard]] std::uint32_t promising(std::size_t n) const;
  void set_least();

  const ContactIndex& contact_;
  const Points& sample_;
  std::size_t enough_;
  const PoseGate& gate_;
  std::size_t batch_;                       ///< Points in a look; the last one may have fewer.
  std::size_t bar_;                         ///< Points in contact that a pose needs.
  std::vector<std::size_t> found_;          ///< How many have so many points in contact.
  std::size_t found_above_ = 0;             ///< How many have the bar at least.
  std::array<std::uint32_t, looks> least_;  ///< What a promising pose has after each look.
  std::size_t first_look_;                  ///< Points of it.
  std::uint32_t least_at_first_ = 0;        ///< What a promising pose has then.
  /// Poses by the points that they have in contact at the first look, and how many they are.
  std::vector<std::vector<Transform>> waiting_;
  std::size_t all_waiting_ = 0;
  std::vector<Candidate> candidates_;
  std::size_t tested_ = 0;
  std::size_t points_tested_ = 0;
};

}  // namespace glocal::indexed_ransam
