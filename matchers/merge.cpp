#include "matchers/merge.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

namespace glocal {
namespace {

constexpr double finest_cell_m = 0.05;
const double finest_cell_rad = radians(2.0);

std::uint64_t cell_of(const Pose2& pose, double scale) {
  const auto cell = [](double value, double size) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(std::floor(value / size)));
  };
  const std::uint64_t column = cell(pose.x, scale * finest_cell_m);
  const std::uint64_t row = cell(pose.y, scale * finest_cell_m);
  const std::uint64_t turn = cell(pose.theta, scale * finest_cell_rad);
  constexpr std::uint64_t bits = 24;  // of columns and rows: far more than any map has
  constexpr std::uint64_t mask = (std::uint64_t{1} << bits) - 1;
  return turn << (2 * bits) | (row & mask) << bits | (column & mask);
}

/// The best of each cell.
std::vector<Hypothesis> merged(const std::vector<Hypothesis>& hypotheses, double scale) {
  std::vector<Hypothesis> best;
  std::unordered_map<std::uint64_t, std::size_t> place_of_cell;
  place_of_cell.reserve(hypotheses.size());
  for (const Hypothesis& hypothesis : hypotheses) {
    const auto [it, is_new] =
        place_of_cell.try_emplace(cell_of(hypothesis.map_from_robot, scale), best.size());
    if (is_new) {
      best.push_back(hypothesis);
    } else {
      best[it->second].support += hypothesis.support;
    }
  }
  return best;
}

}  // namespace

void merge_hypotheses(std::vector<Hypothesis>& hypotheses, std::size_t most) {
  for (double scale = 1.0; hypotheses.size() > most; scale *= 2.0) hypotheses = merged(hypotheses, scale);
}

MatchResult joined(const std::vector<MatchResult>& chunks, std::size_t most) {
  MatchResult result;
  for (const MatchResult& chunk : chunks) {
    result.hypotheses.insert(result.hypotheses.end(), chunk.hypotheses.begin(), chunk.hypotheses.end());
    result.collisions += chunk.collisions;
    result.checks += chunk.checks;
  }
  std::stable_sort(result.hypotheses.begin(), result.hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.quality > b.quality; });
  merge_hypotheses(result.hypotheses, most);
  return result;
}

}  // namespace glocal
