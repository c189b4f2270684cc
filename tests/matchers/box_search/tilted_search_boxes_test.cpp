// The search of boxes where poses tilt.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "matchers/box_search/rooms_in_space.hpp"
#include "matchers/box_search/search_boxes.hpp"

namespace glocal::tilted_search_boxes_test {
namespace {

using namespace test::rooms_in_space;

constexpr double cell = 0.1;
constexpr double epsilon = 0.2;
constexpr int top_level = BoxPyramid::default_top_level(BoxPyramid::Of::all_poses, Motion::free);

BoxPyramid pyramid_of(const Points& map) {
  constexpr auto all_poses = BoxPyramid::Of::all_poses;
  return {all_poses, map,         cell, epsilon, BoxPyramid::default_top_level(all_poses, Motion::free),
          1,         Motion::free};
}

AllPoses boxes_of(const Points& points, const BoxPyramid& pyramid) {
  return {points, pyramid.frame(), top_level, Motion::free};
}

TEST(TiltedBoxes, TheirIntervalsHaveEveryTiltUpToTheLargest) {
  const Points points = seen_in_room();
  const BoxPyramid pyramid = pyramid_of(room(0.0, 0.0, 0.0, true));
  const AllPoses boxes = boxes_of(points, pyramid);
  Rng rng(2);
  for (int i = 0; i < 200; ++i) {
    const double turn = rng.uniform(0.0, 2.0 * std::numbers::pi);
    const double axis = rng.uniform(0.0, 2.0 * std::numbers::pi);
    const double tilt = TiltSquares::most_tilt * std::sqrt(rng.uniform());
    const Vector3 vector{tilt * std::cos(axis), tilt * std::sin(axis), 0.0};
    const auto is_in = [&](int level, std::size_t rotation) {
      const Vector3 off = logarithm(boxes.tilted_from_local(level, rotation).rotation) - vector;
      const double half_side = boxes.tilts()->side(top_level - level) / 2.0 + 1e-9;
      const double turned = std::abs(wrap_angle(turn - boxes.angle(level, rotation)));
      return std::max(std::abs(off.x()), std::abs(off.y())) <= half_side &&
             turned <= boxes.half_turn(level) + 1e-9;
    };
    std::vector<std::size_t> holding;
    for (std::size_t rotation = 0; rotation < boxes.rotations(top_level); ++rotation) {
      if (is_in(top_level, rotation)) holding.push_back(rotation);
    }
    for (int level = top_level; level > 0; --level) {
      ASSERT_FALSE(holding.empty()) << "level " << level;
      std::vector<std::size_t> below;
      for (const std::size_t rotation : holding) {
        for (const std::size_t part : boxes.parts(level, rotation)) {
          if (is_in(level - 1, part)) below.push_back(part);
        }
      }
      holding = below;
    }
    ASSERT_FALSE(holding.empty());
  }
}

TEST(TiltedBoxes, FindARoomThatStandsAslant) {
  // A room that a robot sees, and the same on a slope, which only tilted poses fit.
  const Pose3 slope_from_room({7.3, 1.2, 0.4}, turn_about_z(1.1) * exponential({0.09, -0.07, 0.0}));
  Points map = room(0.0, 0.0, 0.0, true);
  add(map, moved(room(0.0, 0.0, 0.0, true), slope_from_room));
  const Points points = seen_in_room();
  const Pose3 map_from_local = map_from_local_in(0.0, 0.0, 0.0);
  const BoxSearchRule rule{.least = points.size() * 9 / 10, .most_places = 5};
  const Exclusion declared{map_from_local * local_from_robot};
  const auto found = search_boxes(pyramid_of(map), points, local_from_robot, rule, declared, 2);
  ASSERT_TRUE(found.is_complete);
  EXPECT_EQ(found.at_most, points.size());
  ASSERT_FALSE(found.poses.empty());
  const Pose3 rival = found.poses.front().pose();
  const Pose3 truth = slope_from_room * map_from_local;
  EXPECT_LT(distance(rival * local_from_robot, truth * local_from_robot), 0.25);
  EXPECT_LT(rotation_between(rival, truth), radians(6.0));
  EXPECT_GT(rival.tilt(), radians(3.0));
}

TEST(TiltedBoxes, AreGivenUpWhereALocalMapIsSoWideThatTheirIntervalsDoNotFitIntoMemory) {
  Points points = seen_in_room();
  for (const float far : {-1000.0F, 1000.0F}) points.push_back({far, 0.0F, 0.0F});
  const BoxPyramid pyramid = pyramid_of(room(0.0, 0.0, 0.0, true));
  EXPECT_GT(boxes_of(points, pyramid).rotations(top_level), 50'000'000U);
  const BoxSearch search(pyramid, points, local_from_robot, {.least = points.size() / 2}, std::nullopt, 2);
  EXPECT_TRUE(search.is_over());
  EXPECT_FALSE(search.result().is_complete);
}

TEST(TiltedBoxes, NoPoseElsewhereHasMoreContactThanTheSearchSays) {
  const Points map = two_rooms();
  const Points points = seen_in_room();
  const Pose3 declared = map_from_local_in(0.0, 0.0, 0.0) * local_from_robot;
  const BoxSearchRule rule{.least = points.size() * 8 / 10, .most_places = 20};
  const auto found = search_boxes(pyramid_of(map), points, local_from_robot, rule, Exclusion{declared}, 2);
  ASSERT_TRUE(found.is_complete);
  Rng rng(4);
  std::size_t best = 0;
  const auto look_at = [&](const Pose3& map_from_local) {
    if (map_from_local.tilt() > TiltSquares::most_tilt) return;
    if (PoseTolerance{}.are_near(map_from_local * local_from_robot, declared)) return;
    const std::size_t contact = brute_count(map, points, map_from_local, epsilon);
    best = std::max(best, contact);
    ASSERT_LE(contact, found.at_most);
  };
  const auto some = [&](double most) {
    return Vector3{rng.uniform(-most, most), rng.uniform(-most, most), rng.uniform(-most, most)};
  };
  for (int i = 0; i < 1000; ++i) {
    const Vector3 tilt{rng.uniform(-0.12, 0.12), rng.uniform(-0.12, 0.12), 0.0};
    look_at({{rng.uniform(-1.0, 11.0), rng.uniform(-1.0, 5.0), rng.uniform(-1.0, 3.0)},
             turn_about_z(rng.uniform(-std::numbers::pi, std::numbers::pi)) * exponential(tilt)});
  }
  // Close to the best ones, and to the edge of the neighbourhood.
  ASSERT_FALSE(found.poses.empty());
  for (int i = 0; i < 600; ++i) {
    const Pose3 near = found.poses[rng.below(static_cast<std::uint32_t>(found.poses.size()))].pose();
    look_at({near.translation() + some(0.1), exponential(some(0.05)) * near.rotation});
    const Vector3 way = some(1.0);
    const Pose3 robot(declared.translation() + (rng.uniform(1.0, 1.1) / way.norm()) * way,
                      exponential(some(0.05)) * declared.rotation);
    look_at(robot * inverse(local_from_robot));
    const Pose3 turned(declared.translation() + some(0.1),
                       turn_about_z(radians(rng.uniform(30.0, 34.0))) * declared.rotation);
    look_at(turned * inverse(local_from_robot));
  }
  // Nor is what it says far from the truth.
  EXPECT_GT(best, found.at_most * 2 / 3);
}

TEST(TiltedBoxes, AreLookedAtWhereAPriorAllowsOnly) {
  Points map = room(0.0, 0.0, 0.0, true);
  const Pose3 slope_from_room({7.0, 2.0, 0.5}, turn_about_z(2.0) * exponential({0.05, 0.05, 0.0}));
  add(map, moved(room(0.0, 0.0, 0.0, true), slope_from_room));
  const BoxPyramid pyramid = pyramid_of(map);
  const Points points = seen_in_room();
  const Pose3 declared = map_from_local_in(0.0, 0.0, 0.0);
  const Pose3 local_from_start({0.2, 0.1, 0.3}, exponential({0.1, 0.2, 0.5}));
  const Pose3 start = slope_from_room * declared * local_from_start;
  const auto rivals = [&](double x, double heading_deg) {
    const Prior prior{.region = {.x = x, .y = start.y, .radius = 0.3},
                      .heading = {.deg = heading_deg, .width_deg = 10.0}};
    const BoxSearchRule rule{.least = points.size() * 95 / 100, .gate = PoseGate(prior, local_from_start)};
    return search_boxes(pyramid, points, {}, rule, Exclusion{declared}, 2).poses.size();
  };
  const double heading = degrees(start.heading());
  EXPECT_GT(rivals(start.x, heading), 0U);
  EXPECT_EQ(rivals(start.x + 1.0, heading), 0U);
  EXPECT_EQ(rivals(start.x, heading + 40.0), 0U);
}

}  // namespace
}  // namespace glocal::tilted_search_boxes_test
