// Means and variances of robot poses (eq. 6), in the plane and in space.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <type_traits>
#include <vector>

#include "glocal/hypothesis.hpp"

namespace glocal {

/// The same pose; a Pose2 seen from above.
template <class Pose>
[[nodiscard]] Pose pose_as(const Pose3& pose) {
  if constexpr (std::is_same_v<Pose, Pose2>) {
    return seen_from_above(pose);
  } else {
    return pose;
  }
}

/// A hypothesis's robot pose, with what inner loops would compute again and again.
template <class Pose>
struct Item;

template <>
struct Item<Pose2> {
  Item(const Hypothesis& hypothesis, std::size_t number)
      : pose(seen_from_above(hypothesis.map_from_robot)),
        cosine(std::cos(pose.theta)),
        sine(std::sin(pose.theta)),
        weight(static_cast<double>(hypothesis.support)),
        index(number) {}

  Pose2 pose;
  double cosine, sine;
  double weight;  ///< Proposals it stands for.
  std::size_t index;
};

template <>
struct Item<Pose3> {
  Item(const Hypothesis& hypothesis, std::size_t number)
      : pose(hypothesis.map_from_robot), weight(static_cast<double>(hypothesis.support)), index(number) {}

  Pose3 pose;
  double weight;
  std::size_t index;
};

/// Those of the hypotheses with these numbers.
template <class Pose>
[[nodiscard]] std::vector<Item<Pose>> items_of(const std::vector<Hypothesis>& hypotheses,
                                               std::span<const std::size_t> numbers) {
  std::vector<Item<Pose>> items;
  items.reserve(numbers.size());
  for (const std::size_t i : numbers) items.emplace_back(hypotheses[i], i);
  return items;
}

/// Weighted sums, from which a mean pose comes.
template <class Pose>
class Sums;

/// The mean heading is the circular one.
template <>
class Sums<Pose2> {
 public:
  Sums() = default;
  explicit Sums(const Pose2& /*near*/) {}
  void add(const Item<Pose2>& item) { add(item.pose, item.cosine, item.sine, item.weight); }
  /// With the cosine and sine of its heading.
  void add(const Pose2& pose, double cosine, double sine, double weight) {
    weight_ += weight;
    x_ += weight * pose.x;
    y_ += weight * pose.y;
    cosine_ += weight * cosine;
    sine_ += weight * sine;
  }
  [[nodiscard]] double weight() const { return weight_; }
  [[nodiscard]] Pose2 mean() const { return {x_ / weight_, y_ / weight_, std::atan2(sine_, cosine_)}; }

 private:
  double weight_ = 0.0, x_ = 0.0, y_ = 0.0, cosine_ = 0.0, sine_ = 0.0;
};

/// The mean rotation is `near`, turned by the mean of the logarithms of what turns `near` into the others:
/// one step towards the rotation with the least sum of squared angles to all.
template <>
class Sums<Pose3> {
 public:
  explicit Sums(const Pose3& near) : near_(near.rotation), from_near_(near.rotation.conjugate()) {}
  void add(const Item<Pose3>& item) {
    weight_ += item.weight;
    places_ += item.weight * item.pose.translation();
    turns_ += item.weight * logarithm(composed(item.pose.rotation, from_near_));
  }
  [[nodiscard]] double weight() const { return weight_; }
  [[nodiscard]] Pose3 mean() const {
    return {(1.0 / weight_) * places_, composed(exponential((1.0 / weight_) * turns_), near_)};
  }

 private:
  Quaternion near_, from_near_;
  double weight_ = 0.0;
  Vector3 places_ = Vector3::Zero(), turns_ = Vector3::Zero();
};

/// Mean and variances of some items, at least one (eq. 6, diagonal only); members are left empty. In space
/// the mean rotation is found in steps from that of the first item, until they are too small to matter.
/// Rotations vary about the map's axes, by the logarithm of what turns the mean into the item.
[[nodiscard]] Cluster moments(std::span<const Item<Pose2>> items);
[[nodiscard]] Cluster moments(std::span<const Item<Pose3>> items);

/// Between headings in [-pi, pi], rad.
[[nodiscard]] inline double angle_between(double a, double b) {
  const double d = std::abs(a - b);
  return std::min(d, 2.0 * std::numbers::pi - d);
}

/// Whether all robot poses are planar.
[[nodiscard]] bool are_planar(const std::vector<Hypothesis>& hypotheses);

/// The cluster of some hypotheses, at least one: mean robot pose and variances. Those of planar poses are
/// taken in the plane.
[[nodiscard]] Cluster make_cluster(const std::vector<Hypothesis>& hypotheses,
                                   std::vector<std::size_t> members);

}  // namespace glocal
