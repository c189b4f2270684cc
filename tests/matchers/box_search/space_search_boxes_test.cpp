#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "matchers/box_search/rooms_in_space.hpp"
#include "matchers/box_search/search_boxes.hpp"

namespace glocal::space_search_boxes_test {
namespace {

using namespace test::rooms_in_space;

constexpr double cell = 0.1;
constexpr double epsilon = 0.2;

BoxPyramid pyramid_of(const Points& map, int threads = 1, Motion motion = Motion::upright) {
  constexpr auto all_poses = BoxPyramid::Of::all_poses;
  const int top_level = BoxPyramid::default_top_level(all_poses, motion);
  return {all_poses, map, cell, epsilon, top_level, threads, motion};
}

/// All poses but those near this one.
BoxSearchResult search(const BoxPyramid& pyramid, const Points& points, const Pose3& map_from_declared,
                       const BoxSearchRule& rule, int threads = 1) {
  return search_boxes(pyramid, points, local_from_robot, rule, Exclusion{map_from_declared}, threads);
}

/// Of the box that the points fill, at height 0 where they do not tilt.
Vector3 middle_of(const Points& points, const AllPoses& boxes) {
  const auto middle = [](const auto& of) {
    const auto [low, high] = std::minmax_element(of.begin(), of.end());
    return (static_cast<double>(*low) + static_cast<double>(*high)) / 2.0;
  };
  return {middle(points.x), middle(points.y), boxes.tilt() ? middle(points.z) : 0.0};
}

/// A pose of a box: the points tilted about their middle, turned about it, and moved.
Pose3 somewhere_in_box(const AllPoses& boxes, const Points& points, int level, std::size_t rotation,
                       const Vector3& first_cell, Rng& rng) {
  Vector3 tilt = logarithm(boxes.tilted_from_local(level, rotation).rotation);
  if (boxes.tilts()) {
    const double half_side = boxes.tilts()->side(4 - level) / 2.0;
    tilt += Vector3{rng.uniform(-half_side, half_side), rng.uniform(-half_side, half_side), 0.0};
  }
  const double turn = boxes.angle(level, rotation) + rng.uniform(-1.0, 1.0) * boxes.half_turn(level);
  const double size = 1 << level;
  const Vector3 cells = first_cell + Vector3{size * rng.uniform(), size * rng.uniform(),
                                             boxes.layers_of_box(level) * rng.uniform()};
  const CellFrame& frame = boxes.frame();
  const Vector3 place = Vector3{frame.min_x, frame.min_y, frame.min_z} + frame.cell * cells;
  return Pose3(place, turn_about_z(turn) * exponential(tilt)) * Pose3(Vector3(-middle_of(points, boxes)));
}

class BoxPyramidOfMotion : public testing::TestWithParam<Motion> {};

INSTANTIATE_TEST_SUITE_P(InSpace, BoxPyramidOfMotion, testing::Values(Motion::upright, Motion::free),
                         [](const auto& of) { return to_string(of.param); });

TEST_P(BoxPyramidOfMotion, BoundsEveryPoseOfABoxAndNotByMuchMore) {
  Rng rng(1);
  const Points map = random_points(rng, 300, 7.0, 5.0, 3.0);
  const BoxPyramid pyramid = pyramid_of(map, 1, GetParam());
  ASSERT_EQ(pyramid.top_level(), 4);
  TileCounts counts;
  std::size_t poses_with_contact = 0;
  for (int i = 0; i < 120; ++i) {
    const Points points = random_points(rng, 40, 3.0, 2.0, 2.0);
    const AllPoses boxes(points, pyramid.frame(), pyramid.top_level(), GetParam());
    const int level = static_cast<int>(rng.below(5));
    const std::size_t rotation = rng.below(static_cast<std::uint32_t>(boxes.rotations(level)));
    const int size = 1 << level;
    const int column = static_cast<int>(rng.below(80)) - 40 * size;
    const int row = static_cast<int>(rng.below(60)) - 4 * size;
    const int high = boxes.layers_of_box(level);
    const int layer = high * ((static_cast<int>(rng.below(35)) - (boxes.tilt() ? 5 : 15)) / high);
    pyramid.count(level, boxes.cells(level, rotation), column, row, layer, 0, counts);
    for (int k = 0; k < 60; ++k) {
      const int node_column = static_cast<int>(rng.below(TileCounts::columns));
      const int node_row = static_cast<int>(rng.below(TileCounts::rows));
      const Vector3 first(column + node_column * size, row + node_row * size, layer);
      const Pose3 pose = somewhere_in_box(boxes, points, level, rotation, first, rng);
      const std::size_t contact = brute_count(map, points, pose, epsilon);
      ASSERT_LE(contact, counts.at(node_column, node_row)) << "level " << level;
      poses_with_contact += contact > 0 ? 1 : 0;
      if (level > 0) continue;
      const Pose2 above = boxes.pose(0, rotation, first.x() + 0.5, first.y() + 0.5);
      const Pose3 centre = Pose3({above.x, above.y, boxes.height(layer + 0.5)}, turn_about_z(above.theta)) *
                           boxes.tilted_from_local(0, rotation);
      ASSERT_LE(counts.at(node_column, node_row),
                brute_count(map, points, centre, epsilon + pyramid.delta() + 1e-6));
    }
  }
  EXPECT_GT(poses_with_contact, 1000U);  // or there was nothing to be bounded
}

TEST(BoxPyramidInSpace, ClustersBoundEveryPoseOfABox) {
  Rng rng(5);
  const Points map = room(0.0, 0.0, 0.0, true);
  const BoxPyramid pyramid = pyramid_of(map);
  const int top = pyramid.top_level();
  const Points points = room(-2.0, -1.5, -1.0, true);
  const AllPoses boxes(points, pyramid.frame(), top);
  const std::size_t loose = boxes.points_without_cluster();
  ASSERT_LT(loose, points.size() / 5);
  TileCounts counts;
  std::size_t bounded = 0;
  for (int i = 0; i < 20; ++i) {
    const std::size_t rotation = rng.below(static_cast<std::uint32_t>(boxes.rotations(top)));
    const int column = static_cast<int>(rng.below(60)) - 250;
    const int row = static_cast<int>(rng.below(40)) - 30;
    const int layer = static_cast<int>(rng.below(9));
    pyramid.count(top, boxes.cluster_cells(rotation), column, row, boxes.layers_of_box(top) * layer, 0,
                  counts);
    for (int k = 0; k < 10; ++k) {
      const int node_column = static_cast<int>(rng.below(TileCounts::columns));
      const int node_row = static_cast<int>(rng.below(TileCounts::rows));
      const Vector3 first(column + node_column * (1 << top), row + node_row * (1 << top),
                          boxes.layers_of_box(top) * layer);
      const Pose3 pose = somewhere_in_box(boxes, points, top, rotation, first, rng);
      const std::size_t at_most = loose + AllPoses::cluster_size * counts.at(node_column, node_row);
      ASSERT_LE(brute_count(map, points, pose, epsilon), at_most);
      bounded += at_most < points.size() ? 1 : 0;
    }
  }
  EXPECT_GT(bounded, 100U);  // or the clusters say nothing
}

TEST(BoxPyramidInSpace, IsTheSameForAnyNumberOfThreads) {
  const Points map = room(0.0, 0.0, 0.0, true);
  const Points points = seen_in_room();
  const BoxPyramid one = pyramid_of(map, 1);
  const BoxPyramid two = pyramid_of(map, 2);
  const AllPoses boxes(points, one.frame(), one.top_level());
  TileCounts by_one, by_two;
  EXPECT_EQ(one.memory_bytes(), two.memory_bytes());
  for (int level = 0; level <= one.top_level(); ++level) {
    one.count(level, boxes.cells(level, 3), -10, -10, 4, 0, by_one);
    two.count(level, boxes.cells(level, 3), -10, -10, 4, 0, by_two);
    for (int row = 0; row < TileCounts::rows; ++row) {
      for (int column = 0; column < TileCounts::columns; ++column)
        ASSERT_EQ(by_one.at(column, row), by_two.at(column, row));
    }
  }
}

TEST(SearchBoxesInSpace, NoPoseElsewhereHasMoreContactThanItSays) {
  const Points map = two_rooms();
  const Points points = seen_in_room();
  const Pose3 declared = map_from_local_in(0.0, 0.0, 0.0) * local_from_robot;
  const auto found =
      search(pyramid_of(map), points, declared, {.least = points.size() * 7 / 10, .most_places = 20});
  ASSERT_TRUE(found.is_complete);
  ASSERT_LT(found.at_most, points.size());
  Rng rng(4);
  std::size_t best = 0;
  const auto look_at = [&](const Pose3& map_from_local) {
    const Pose3 robot = map_from_local * local_from_robot;
    if (distance(robot, declared) <= 1.0 && rotation_between(robot, declared) <= radians(30.0)) return;
    const std::size_t contact = brute_count(map, points, map_from_local, epsilon);
    best = std::max(best, contact);
    ASSERT_LE(contact, found.at_most);
  };
  const auto turn = [&](double most) { return turn_about_z(rng.uniform(-most, most)); };
  const auto up_to = [&](double most) { return rng.uniform(-most, most); };
  for (int i = 0; i < 1500; ++i)
    look_at(
        {{rng.uniform(-1.0, 11.0), rng.uniform(-1.0, 5.0), rng.uniform(-1.0, 3.0)}, turn(std::numbers::pi)});
  // Close to the best ones, and to the edge of the neighbourhood, above and below it, too.
  ASSERT_FALSE(found.poses.empty());
  for (int i = 0; i < 600; ++i) {
    const Pose3 near = found.poses[rng.below(static_cast<std::uint32_t>(found.poses.size()))].pose();
    look_at({near.translation() + Vector3{up_to(0.1), up_to(0.1), up_to(0.1)}, turn(0.05) * near.rotation});
    const Vector3 way{up_to(1.0), up_to(1.0), up_to(1.0)};
    const Pose3 robot(declared.translation() + (rng.uniform(1.0, 1.1) / way.norm()) * way,
                      turn(0.05) * declared.rotation);
    look_at(robot * inverse(local_from_robot));
    const Pose3 turned(declared.translation() + Vector3{up_to(0.1), up_to(0.1), up_to(0.1)},
                       turn_about_z(radians(rng.uniform(30.0, 34.0))) * declared.rotation);
    look_at(turned * inverse(local_from_robot));
  }
  // Nor is what it says far from the truth.
  EXPECT_GT(best, found.at_most * 2 / 3);
}

TEST(SearchBoxesInSpace, WhatIsNearTheDeclaredPoseIsNoRivalButWhatIsAboveItIs) {
  // What is seen of one floor is seen of the other.
  Points map = room(0.0, 0.0, 0.0, true);
  const BoxPyramid one_floor = pyramid_of(map);
  add(map, room(0.0, 0.0, 2.6, true));
  const Points points = seen_in_room();
  const Pose3 declared = map_from_local_in(0.0, 0.0, 0.0) * local_from_robot;
  const std::size_t least = points.size() * 98 / 100;
  const auto none = search(one_floor, points, declared, {.least = least});
  EXPECT_TRUE(none.poses.empty());
  EXPECT_EQ(none.at_most, least - 1);
  const auto found = search(pyramid_of(map), points, declared, {.least = least});
  ASSERT_FALSE(found.poses.empty());
  EXPECT_NEAR(found.poses.front().z, map_from_local_in(0.0, 0.0, 2.6).z, 0.2);
  EXPECT_EQ(found.at_most, points.size());
}

TEST(SearchBoxesInSpace, LooksOnlyWhereAPriorAllows) {
  Points map = room(0.0, 0.0, 0.0, true);
  add(map, room(7.0, 2.0, 1.0, true));
  const BoxPyramid pyramid = pyramid_of(map);
  const Points points = seen_in_room();
  const Pose3 declared = map_from_local_in(0.0, 0.0, 0.0);
  const auto rivals = [&](double x, double y) {
    const Prior prior{.region = {.x = x, .y = y, .radius = 3.0}, .heading = {}};
    const BoxSearchRule rule{.least = points.size() * 98 / 100, .gate = PoseGate(prior, Pose3{})};
    return search_boxes(pyramid, points, {}, rule, Exclusion{declared}, 1).poses;
  };
  EXPECT_TRUE(rivals(2.0, 1.5).empty());
  EXPECT_FALSE(rivals(9.0, 3.5).empty());
}

TEST(SearchBoxesInSpace, AnswersAlikeForAnyNumberOfThreads) {
  const BoxPyramid pyramid = pyramid_of(two_rooms());
  const Points points = seen_in_room();
  const Pose3 declared = map_from_local_in(0.0, 0.0, 0.0);
  const BoxSearchRule rule{.least = points.size() * 7 / 10};
  const auto one = search(pyramid, points, declared, rule, 1);
  const auto two = search(pyramid, points, declared, rule, 2);
  EXPECT_EQ(one.looks, two.looks);
  EXPECT_EQ(one.at_most, two.at_most);
  ASSERT_FALSE(one.poses.empty());
  ASSERT_EQ(one.poses.size(), two.poses.size());
  for (std::size_t i = 0; i < one.poses.size(); ++i) EXPECT_EQ(one.poses[i].pose(), two.poses[i].pose());
}

}  // namespace
}  // namespace glocal::space_search_boxes_test
