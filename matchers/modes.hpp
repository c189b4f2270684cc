// Distinct poses among many that mean nearly the same.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "glocal/contact.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "glocal/rng.hpp"
#include "matchers/distance_field.hpp"

namespace glocal {

/// A pose of the local map, and how good it looks so far.
struct Mode {
  Pose2 map_from_local;
  double quality = 0.0;
};

/// When two robot poses are one mode: both nearer and turned by less.
struct ModeRule {
  double distance = 0.4;  ///< m
  double rotation = 0.2;  ///< rad
};

[[nodiscard]] inline bool is_same_mode(const Pose2& a, const Pose2& b, const ModeRule& rule) {
  return distance(a, b) < rule.distance && rotation_between(a, b) < rule.rotation;
}

/// At most `most` modes, the best first, leaving out those that only repeat a better one: the same robot
/// pose.
[[nodiscard]] std::vector<Mode> distinct_modes(std::vector<Mode> modes, const Pose2& local_from_robot,
                                               const ModeRule& rule, std::size_t most);

/// Refines each by the anchors, and judges it anew by the contact of `points`.
void refine(std::vector<Mode>& modes, const DistanceField& field, const Points& anchors,
            const PoseRefinement& refinement, const ContactIndex& contact, const Points& points);

/// At most n of the numbers below `below`, each once, in random order.
[[nodiscard]] std::vector<std::uint32_t> draw_numbers(std::size_t n, std::size_t below, Rng& rng);

/// At most n of the points, picked at random, in random order.
[[nodiscard]] Points sample_of(const Points& points, std::size_t n, Rng& rng);

[[nodiscard]] Points first_of(const Points& points, std::size_t n);

}  // namespace glocal
