// Particles that mean nearly the same pose.
#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "glocal/pose2.hpp"
#include "glocal/pose_cells.hpp"

namespace glocal {

/// Particles of one cell, added up.
struct Heap {
  double weight = 0.0, x = 0.0, y = 0.0, cosine = 0.0, sine = 0.0;

  void add(const Pose2& pose, double w) {
    weight += w;
    x += w * pose.x;
    y += w * pose.y;
    cosine += w * std::cos(pose.theta);
    sine += w * std::sin(pose.theta);
  }
  /// The heading is the circular mean.
  [[nodiscard]] Pose2 mean() const { return {x / weight, y / weight, std::atan2(sine, cosine)}; }
};

/// Particles by cells, the heaviest `most` of these first.
[[nodiscard]] std::vector<Heap> heaps_of(const std::vector<Pose2>& particles,
                                         const std::vector<double>& weights, const PoseBinning& binning,
                                         std::size_t most);

}  // namespace glocal
