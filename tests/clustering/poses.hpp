// Hypotheses at given robot poses, and which of them are together.
#pragma once

#include <algorithm>
#include <numbers>
#include <vector>

#include "glocal/hypothesis.hpp"
#include "glocal/rng.hpp"

namespace glocal::test {

using Groups = std::vector<std::vector<std::size_t>>;

inline Hypothesis at(double x, double y, double theta_deg, std::size_t support = 1) {
  return {.map_from_local = {},
          .map_from_robot = Pose2{x, y, radians(theta_deg)},
          .score = 0.7,
          .support = support};
}

/// The members of each cluster, in the order of their first ones.
inline Groups groups_of(const std::vector<Cluster>& clusters) {
  Groups groups;
  for (const Cluster& cluster : clusters) groups.push_back(cluster.members);
  std::sort(groups.begin(), groups.end());
  return groups;
}

/// What a clusterer with these parameters finds.
template <class Clusterer>
Groups clustered(const std::vector<Hypothesis>& hypotheses, const typename Clusterer::Params& params) {
  Rng rng(1);
  return groups_of(Clusterer(params).cluster(hypotheses, rng));
}

/// Poses around places on both sides of the seam of headings, and some anywhere.
inline std::vector<Hypothesis> crowded(int n, Rng& rng) {
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < n; ++i) {
    const bool anywhere = i % 5 == 0;
    const double x = anywhere ? rng.uniform(-1.0, 2.0) : 0.5 * (i % 3) + rng.normal(0.08);
    const double y = anywhere ? rng.uniform(-1.0, 1.0) : rng.normal(0.08);
    const double theta = anywhere ? rng.uniform(-180.0, 180.0) : 175.0 + 40.0 * (i % 2) + rng.normal(6.0);
    hypotheses.push_back(at(x, y, theta, 1 + static_cast<std::size_t>(i % 7 == 0)));
  }
  return hypotheses;
}

/// The same, raised and tilted a little, and some upside down.
inline std::vector<Hypothesis> in_space(std::vector<Hypothesis> hypotheses, Rng& rng) {
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    Pose3& pose = hypotheses[i].map_from_robot;
    pose.z = 0.4 * static_cast<double>(i % 2) + rng.normal(0.05);
    const double upside_down = i % 3 == 0 ? std::numbers::pi : 0.0;
    const double pitch = rng.normal(0.05);
    pose.rotation = pose.rotation * exponential({upside_down + rng.normal(0.05), pitch, 0.0});
  }
  return hypotheses;
}

}  // namespace glocal::test
