#include "matchers/grid_search/upright_branch_and_bound.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "glocal/error.hpp"
#include "glocal/pose_cells.hpp"
#include "matchers/box_search/search_boxes.hpp"
#include "matchers/same_answer.hpp"
#include "matchers/surfels/hall_map.hpp"
#include "matchers/surfels/scanned_hall.hpp"
#include "points.hpp"

namespace glocal::grid_search::upright_branch_and_bound_test {
namespace {

constexpr double cell = 0.3;
constexpr double epsilon = 0.3;
constexpr double robot_height = 0.4;
const Pose3 local_from_robot({0.7, -0.4, robot_height}, turn_about_z(1.0));

/// Points of a small, high room.
Points random_map(Rng& rng) {
  Points map;
  for (int i = 0; i < 150; ++i) {
    map.push_back({static_cast<float>(rng.uniform(-2.0, 2.0)), static_cast<float>(rng.uniform(1.0, 4.0)),
                   static_cast<float>(rng.uniform(-1.0, 2.0))});
  }
  return map;
}

Points random_local(Rng& rng) {
  Points local;
  for (int i = 0; i < 14; ++i) {
    local.push_back({static_cast<float>(rng.uniform(0.0, 2.0)), static_cast<float>(rng.uniform(-1.0, 1.0)),
                     static_cast<float>(rng.uniform(-1.0, 1.5))});
  }
  return local;
}

BoxPyramid pyramid_of(const Points& map, double side = cell, double near = epsilon) {
  return {BoxPyramid::Of::pose_grid, map, side, near, 2, 1, Motion::upright};
}

/// Which cells of a frame are in contact, by the distances from their centres to all points.
class ContactCells {
 public:
  ContactCells(const Points& map, const CellFrame& frame) : frame_(frame) {
    for (int layer = 0; layer < frame.layers; ++layer) {
      for (int row = 0; row < frame.rows; ++row) {
        for (int column = 0; column < frame.columns; ++column) {
          const double x = frame.min_x + (column + 0.5) * cell;
          const double y = frame.min_y + (row + 0.5) * cell;
          const double z = frame.min_z + (layer + 0.5) * cell;
          bool any = false;
          for (std::size_t i = 0; i < map.size() && !any; ++i)
            any = std::hypot(map.x[i] - x, map.y[i] - y, map.z[i] - z) <= epsilon;
          cells_.push_back(any ? 1 : 0);
        }
      }
    }
  }

  [[nodiscard]] bool contain(int column, int row, int layer) const {
    if (column < 0 || row < 0 || layer < 0 || column >= frame_.columns || row >= frame_.rows ||
        layer >= frame_.layers)
      return false;
    const auto line = static_cast<std::size_t>(layer) * static_cast<std::size_t>(frame_.rows) +
                      static_cast<std::size_t>(row);
    return cells_[line * static_cast<std::size_t>(frame_.columns) + static_cast<std::size_t>(column)] != 0;
  }
  /// Points in contact after a translation.
  [[nodiscard]] std::size_t count(const CellPoints& points, int column, int row, int layer) const {
    std::size_t n = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (contain(points.columns()[i] + column, points.rows()[i] + row, points.layers()[i] + layer)) ++n;
    }
    return n;
  }

 private:
  CellFrame frame_;
  std::vector<std::uint8_t> cells_;
};

/// The contact of the best pose in each cell of robot poses, falling: of all poses of the grid, counted one
/// point at a time.
std::vector<std::size_t> brute_force(const Points& map, const Points& local, const CellFrame& frame,
                                     const BoxSearchRule& rule) {
  const ContactCells contact(map, frame);
  const PoseGrid grid(local, frame, rule.min_rotation_step);
  const double side = rule.cell_distance / std::numbers::sqrt2;
  const PoseBinning binning{side, square_parts_of_a_turn(rule.cell_rotation)};
  std::map<std::pair<PoseCell, int>, std::size_t> best;
  for (std::size_t rotation = 0; rotation < grid.rotations(0); ++rotation) {
    const CellPoints points = grid.cells(0, rotation).front();
    for (int layer = -20; layer < frame.layers + 20; ++layer) {
      const double z = frame.min_z + cell * layer + robot_height;
      if (z < frame.min_z || z >= frame.min_z + cell * frame.layers) continue;
      for (int row = -20; row < frame.rows + 20; ++row) {
        for (int column = -20; column < frame.columns + 20; ++column) {
          const std::size_t in_contact = contact.count(points, column, row, layer);
          if (in_contact == 0) continue;
          const Pose2 robot = grid.pose(0, rotation, column, row) * seen_from_above(local_from_robot);
          std::size_t& most = best[{binning.cell_of(robot), static_cast<int>(std::floor(z / side))}];
          most = std::max(most, in_contact);
        }
      }
    }
  }
  std::vector<std::size_t> contacts;
  for (const auto& [place, most] : best) contacts.push_back(most);
  std::sort(contacts.begin(), contacts.end(), std::greater<>());
  return contacts;
}

std::vector<std::size_t> contacts_of(const BoxSearchResult& result) {
  std::vector<std::size_t> contacts;
  for (const auto& pose : result.poses) contacts.push_back(pose.in_contact);
  return contacts;
}

TEST(GridSearchInSpace, FindsWhatBruteForceFinds) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    Rng rng(seed);
    const Points map = random_map(rng);
    const Points local = random_local(rng);
    const BoxPyramid pyramid = pyramid_of(map);
    BoxSearchRule rule{
        .cell_distance = 0.8, .cell_rotation = 0.4, .most_places = 1000000, .min_rotation_step = 0.1};
    std::vector<std::size_t> best = brute_force(map, local, pyramid.frame(), rule);
    const auto found = [&] {
      return contacts_of(search_boxes(pyramid, local, local_from_robot, rule, std::nullopt, 1));
    };
    EXPECT_EQ(found(), best);
    for (const std::size_t limit : {std::size_t{100}, std::size_t{10}, std::size_t{1}}) {
      ASSERT_GT(best.size(), limit);
      best.resize(limit);
      rule.most_places = limit;
      EXPECT_EQ(found(), best);
    }
  }
}

TEST(GridSearchInSpace, PosesBringAsManyPointsIntoContactAsTheySay) {
  Rng rng(4);
  const Points map = random_map(rng);
  const Points local = random_local(rng);
  const BoxPyramid pyramid = pyramid_of(map);
  const ContactCells contact(map, pyramid.frame());
  const CellFrame& frame = pyramid.frame();
  const BoxSearchResult found =
      search_boxes(pyramid, local, local_from_robot,
                   {.least = (6 * local.size() + 9) / 10, .min_rotation_step = 0.1}, std::nullopt, 1);
  ASSERT_FALSE(found.poses.empty());
  for (const auto& pose : found.poses) {
    const Points there = moved(local, pose.pose());
    std::size_t in_contact = 0;
    for (std::size_t i = 0; i < there.size(); ++i) {
      const auto number = [](double value, double least) {
        return static_cast<int>(std::floor((value - least) / cell));
      };
      if (contact.contain(number(there.x[i], frame.min_x), number(there.y[i], frame.min_y),
                          number(there.z[i], frame.min_z)))
        ++in_contact;
    }
    EXPECT_EQ(pose.in_contact, in_contact);
  }
}

TEST(PyramidOfGridInSpace, BoundsEveryPoseOfANodeAndCountsExactlyAtTheBottom) {
  Rng rng(5);
  const Points map = random_map(rng);
  const BoxPyramid pyramid = pyramid_of(map);
  const CellFrame& frame = pyramid.frame();
  const ContactCells contact(map, frame);
  const auto between = [&](int least, int most) {
    return least + static_cast<int>(rng.below(static_cast<std::uint32_t>(most - least)));
  };
  TileCounts counts;
  for (int i = 0; i < 200; ++i) {
    CellPoints points;
    for (int k = 0; k < 30; ++k) points.push_back(between(-10, 10), between(-10, 10), between(-6, 6));
    const int level = between(0, 3);
    const int size = 1 << level;
    const int column = between(-20, 20);
    const int row = between(-20, 20);
    const int layer = between(-8, 16);
    pyramid.count(level, {points}, column, row, layer, 0, counts);
    const int node_column = between(0, 16);
    const int node_row = between(0, TileCounts::rows);
    std::size_t windows = 0;
    for (std::size_t k = 0; k < points.size(); ++k) {
      bool any = false;
      for (int l = 0; l < size; ++l) {
        for (int r = 0; r < size; ++r) {
          for (int c = 0; c < size; ++c) {
            any = any || contact.contain(points.columns()[k] + column + node_column * size + c,
                                         points.rows()[k] + row + node_row * size + r,
                                         points.layers()[k] + layer + l);
          }
        }
      }
      if (any) ++windows;
    }
    ASSERT_EQ(counts.at(node_column, node_row), windows);
  }
}

TEST(PyramidOfGridInSpace, RefusesAMapThatIsTooLarge) {
  const Points map = test::points_of({{0.0F, 0.0F, 0.0F}, {100.0F, 100.0F, 100.0F}});
  EXPECT_NO_THROW(pyramid_of(map, 0.5, 0.5));
  EXPECT_THROW(pyramid_of(map, 0.05, 0.1), ConfigError);
}

const GridRule coarse{
    .contact_epsilon = 0.2, .cell = 0.2, .min_rotation_step_deg = 2.0, .max_points = 100, .max_poses = 10};

MatchResult match(const LocalMap& local, int threads = 1) {
  UprightBranchAndBound matcher(coarse,
                                {.map = test::hall_map(), .threads = threads, .motion = Motion::upright});
  Rng rng(1);
  return matcher.match({local, {}, 0.3}, rng);
}

/// A local map whose frame is not the robot's.
LocalMap local_at(const Pose3& map_from_robot) {
  LocalMap local;
  local.local_from_robot = {{1.5, -0.7, 0.6}, turn_about_z(0.9)};
  local.points = moved(test::scan_of(test::hall(), map_from_robot), local.local_from_robot);
  local.ends = {local.points.size()};
  return local;
}

TEST(UprightBranchAndBound, FindsThePose) {
  const Pose3 truth{{8.0, 4.0, 1.2}, turn_about_z(-2.5)};
  const LocalMap local = local_at(truth);
  const MatchResult result = match(local);
  ASSERT_FALSE(result.hypotheses.empty());
  const Pose3 robot = result.hypotheses.front().map_from_local * local.local_from_robot;
  EXPECT_LT(distance(robot, truth), 0.3);
  EXPECT_LT(rotation_between(robot, truth), radians(4.0));
  double last = 1.0;
  for (const Hypothesis& h : result.hypotheses) {
    EXPECT_EQ(h.map_from_local.rotation.x(), 0.0);
    EXPECT_EQ(h.map_from_local.rotation.y(), 0.0);
    EXPECT_GE(h.score, 0.3);
    EXPECT_LE(h.score, last);
    last = h.score;
    const auto contact = contact_index(*test::hall_map(), "bitset", 0.2);
    EXPECT_EQ(h.quality, contact->share(moved(local.points, h.map_from_local), Transform(Pose2{})));
  }
}

TEST(UprightBranchAndBound, HypothesesAreDistinct) {
  const LocalMap local = local_at({{8.0, 4.0, 1.2}, turn_about_z(-2.5)});
  const MatchResult result = match(local);
  for (std::size_t i = 0; i < result.hypotheses.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const Pose3 a = result.hypotheses[i].map_from_local * local.local_from_robot;
      const Pose3 b = result.hypotheses[k].map_from_local * local.local_from_robot;
      EXPECT_TRUE(distance(a, b) >= candidate_distance || rotation_between(a, b) >= candidate_rotation);
    }
  }
}

TEST(UprightBranchAndBound, AnswersAlikeForAnyNumberOfThreads) {
  const LocalMap local = local_at({{4.0, 5.0, 1.5}, turn_about_z(1.0)});
  test::expect_same_answer(match(local, 1), match(local, 2));
}

TEST(UprightBranchAndBound, FindsNothingForAnEmptyLocalMap) {
  EXPECT_TRUE(match({}).hypotheses.empty());
}

}  // namespace
}  // namespace glocal::grid_search::upright_branch_and_bound_test
