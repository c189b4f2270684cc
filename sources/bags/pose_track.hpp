// Poses over time, and those between them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>
#include <vector>

#include "glocal/pose3.hpp"

namespace glocal::bags {

/// A straight and even motion from one pose to another one, with an even turn.
class EvenMotion {
 public:
  EvenMotion(const Pose3& from, const Pose3& to)
      : from_(from),
        way_(to.translation() - from.translation()),
        turn_(logarithm(composed(from.rotation.conjugate(), to.rotation))) {}

  /// The pose after a share of it.
  [[nodiscard]] Pose3 at(double share) const {
    return {from_.translation() + share * way_, composed(from_.rotation, exponential(share * turn_))};
  }

 private:
  Pose3 from_;
  Vector3 way_, turn_;
};

/// Poses of one frame in another, by their stamps (ns).
class PoseTrack {
 public:
  void add(std::int64_t stamp_ns, const Pose3& pose) { poses_.emplace_back(stamp_ns, pose); }
  /// To be called once all poses are there, or whenever it is asked where more may come: sorts them; of those
  /// with equal stamps the last one stays.
  void settle();
  /// Forgets what was before the last pose that is not after a time. To be settled.
  void forget_before(std::int64_t stamp_ns);

  [[nodiscard]] std::size_t size() const { return poses_.size(); }
  /// The first stamp and the last one. There must be a pose.
  [[nodiscard]] std::pair<std::int64_t, std::int64_t> span() const {
    return {poses_.front().first, poses_.back().first};
  }
  /// There must be a pose.
  [[nodiscard]] const Pose3& first() const { return poses_.front().second; }
  /// Whether all poses are the same one, so far.
  [[nodiscard]] bool is_still() const { return is_still_; }

  /// The pose at a time: between two that are at most `max_gap_ns` apart, as an even motion has it. None
  /// otherwise.
  [[nodiscard]] std::optional<Pose3> at(std::int64_t stamp_ns, std::int64_t max_gap_ns) const;
  /// The pose whose stamp is nearest to a time; none if it differs by more than `max_difference_ns`.
  [[nodiscard]] std::optional<Pose3> nearest(std::int64_t stamp_ns, std::int64_t max_difference_ns) const;

 private:
  using Poses = std::vector<std::pair<std::int64_t, Pose3>>;

  /// The first pose that is not before a time.
  [[nodiscard]] Poses::const_iterator not_before(std::int64_t stamp_ns) const;

  Poses poses_;
  bool is_still_ = false;
};

}  // namespace glocal::bags
