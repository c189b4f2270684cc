#include "matchers/common/merge.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

#include "matchers/common/pose_cell.hpp"

namespace glocal {
namespace {

constexpr PoseCellSize finest{.metres = 0.05, .radians = radians(2.0)};

/// The best of each cell.
std::vector<Hypothesis> merged(const std::vector<Hypothesis>& hypotheses, const Pose2& local_from_robot,
                               double scale) {
  std::vector<Hypothesis> best;
  const PoseCellSize size{scale * finest.metres, scale * finest.radians};
  std::unordered_map<std::uint64_t, std::size_t> place_of_cell;
  place_of_cell.reserve(hypotheses.size());
  for (const Hypothesis& hypothesis : hypotheses) {
    const std::uint64_t cell = pose_cell(hypothesis.map_from_local * local_from_robot, size);
    const auto [it, is_new] = place_of_cell.try_emplace(cell, best.size());
    if (is_new) {
      best.push_back(hypothesis);
    } else {
      best[it->second].support += hypothesis.support;
    }
  }
  return best;
}

}  // namespace

void merge_hypotheses(std::vector<Hypothesis>& hypotheses, const Pose2& local_from_robot, std::size_t most) {
  for (double scale = 1.0; hypotheses.size() > most; scale *= 2.0)
    hypotheses = merged(hypotheses, local_from_robot, scale);
}

MatchResult joined(const std::vector<MatchResult>& chunks, const Pose2& local_from_robot, std::size_t most) {
  MatchResult result;
  for (const MatchResult& chunk : chunks) {
    result.hypotheses.insert(result.hypotheses.end(), chunk.hypotheses.begin(), chunk.hypotheses.end());
    result.proposals += chunk.proposals;
    result.points_tested += chunk.points_tested;
  }
  std::stable_sort(result.hypotheses.begin(), result.hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
  merge_hypotheses(result.hypotheses, local_from_robot, most);
  return result;
}

}  // namespace glocal
