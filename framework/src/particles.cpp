#include "glocal/particles.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <unordered_map>

namespace glocal {

std::vector<Sums<Pose2>> cell_sums(const Particles& particles, const PoseBinning& binning, std::size_t most) {
  const std::vector<Pose2>& poses = particles.poses;
  std::vector<Sums<Pose2>> sums;
  std::unordered_map<PoseCell, std::size_t, PoseCellHash> number_of_cell;
  std::size_t sum = 0;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    // Copies of a particle follow each other.
    if (i == 0 || !(poses[i] == poses[i - 1])) {
      const auto [it, is_new] = number_of_cell.try_emplace(binning.cell_of(poses[i]), sums.size());
      if (is_new) sums.emplace_back();
      sum = it->second;
    }
    sums[sum].add(poses[i], std::cos(poses[i].theta), std::sin(poses[i].theta), particles.weights[i]);
  }
  std::ranges::stable_sort(sums, std::greater<>(), &Sums<Pose2>::weight);
  sums.resize(std::min(sums.size(), most));
  // Sums of less underflow, and have no mean.
  constexpr double least_weight = 1e-290;
  while (!sums.empty() && !(sums.back().weight() >= least_weight)) sums.pop_back();
  return sums;
}

std::vector<Hypothesis> hypotheses_of(const Particles& particles, const Pose2& old_from_new,
                                      const ParticleMerging& merging, const ContactIndex& contact,
                                      const LocalMap& local, const Scan& scan, double omega_max) {
  const std::vector<Sums<Pose2>> sums = cell_sums(
      particles, {merging.distance, square_parts_of_a_turn(merging.rotation)}, merging.max_hypotheses);
  const Pose2 robot_from_local = inverse(seen_from_above(local.local_from_robot));
  std::vector<Hypothesis> found;
  for (const Sums<Pose2>& sum : sums) {
    const Pose2 map_from_robot = sum.mean() * old_from_new;
    const double score = contact.share(scan.hits, Transform(map_from_robot));
    if (score < omega_max) continue;
    const Pose2 map_from_local = map_from_robot * robot_from_local;
    const auto support = std::lround(sum.weight() * static_cast<double>(particles.weights.size()));
    found.push_back({.map_from_local = map_from_local,
                     .quality = contact.share(local.points, Transform(map_from_local)),
                     .score = score,
                     .support = static_cast<std::size_t>(std::max(1L, support))});
  }
  std::ranges::stable_sort(found, std::greater<>(), &Hypothesis::score);
  return found;
}

}  // namespace glocal
