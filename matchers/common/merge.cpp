#include "matchers/common/merge.hpp"

#include <algorithm>
#include <numbers>
#include <unordered_map>

#include "glocal/pose_cells.hpp"

namespace glocal {
namespace {

/// The best of each cell.
std::vector<Hypothesis> merged(const std::vector<Hypothesis>& hypotheses, const Pose2& local_from_robot,
                               double scale) {
  std::vector<Hypothesis> best;
  const PoseBinning binning{scale * 0.05, parts_of_a_turn(scale * radians(2.0))};
  // Parts of the turn begin at multiples of their width, not half a width before: which hypotheses of the
  // paper's experiments are merged has always depended on that.
  const double half_a_part = std::numbers::pi / binning.turns;
  std::unordered_map<PoseCell, std::size_t, PoseCellHash> place_of_cell;
  place_of_cell.reserve(hypotheses.size());
  for (const Hypothesis& hypothesis : hypotheses) {
    Pose2 robot = hypothesis.map_from_local * local_from_robot;
    robot.theta -= half_a_part;
    const PoseCell cell = binning.cell_of(robot);
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
