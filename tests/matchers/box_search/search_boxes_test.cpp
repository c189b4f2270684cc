#include "matchers/box_search/search_boxes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "glocal/rng.hpp"
#include "points.hpp"

namespace glocal::search_boxes_test {
namespace {

using test::random_points;

constexpr double cell = 0.05;
constexpr double epsilon = 0.1;

/// Points nearer to one of the map than this, each looked at.
std::size_t brute_count(const Points& map, const Points& points, const Pose2& map_from_local, double near) {
  std::size_t n = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double c = std::cos(map_from_local.theta);
    const double s = std::sin(map_from_local.theta);
    const double x = c * points.x[i] - s * points.y[i] + map_from_local.x;
    const double y = s * points.x[i] + c * points.y[i] + map_from_local.y;
    bool found = false;
    for (std::size_t k = 0; k < map.size() && !found; ++k) {
      const double dx = map.x[k] - x;
      const double dy = map.y[k] - y;
      found = dx * dx + dy * dy <= near * near;
    }
    n += found ? 1 : 0;
  }
  return n;
}

BoxPyramid pyramid_of(const Points& map) {
  return {BoxPyramid::Of::all_poses, map, cell, epsilon,
          BoxPyramid::default_top_level(BoxPyramid::Of::all_poses)};
}

/// All poses but those near this one.
BoxSearchResult search(const BoxPyramid& pyramid, const Points& points, const Pose2& declared,
                       const BoxSearchRule& rule, int threads = 1) {
  return search_boxes(pyramid, points, {}, rule, Exclusion{declared}, threads);
}

/// A room of 4 m x 3 m with a wall into it, at the left or elsewhere, so that it looks different from every
/// side.
Points room(float x0, float y0, bool is_left) {
  Points points;
  for (int i = 0; i <= 80; ++i) {
    const float along = 0.05F * static_cast<float>(i);
    points.push_back({x0 + along, y0, 0.0F});
    points.push_back({x0 + along, y0 + 3.0F, 0.0F});
    points.push_back({x0, y0 + 0.75F * along, 0.0F});
    points.push_back({x0 + 4.0F, y0 + 0.75F * along, 0.0F});
    points.push_back({x0 + (is_left ? 0.8F : 2.9F), y0 + 0.4F * along, 0.0F});
  }
  return points;
}

void add(Points& points, const Points& more) {
  for (std::size_t i = 0; i < more.size(); ++i) points.push_back(more[i]);
}

/// What a robot in the middle of such a room sees.
Points seen_in_room() {
  return room(-2.0F, -1.5F, true);
}

/// A pose of a box, turned about the middle of the points, which poses() turns about for any angle.
Pose2 somewhere_in_box(const PoseBoxes& boxes, const CellFrame& frame, int level, std::size_t rotation,
                       double first_column, double first_row, Rng& rng) {
  const Pose2 middle = boxes.pose(level, rotation, 0.0, 0.0);
  const double angle = rng.uniform(-1.0, 1.0) * boxes.half_width(level);
  const Pose2 at_zero{frame.min_x, frame.min_y, 0.0};
  const Pose2 turned = at_zero * Pose2{0.0, 0.0, angle} * inverse(at_zero) * middle;
  const int size = 1 << level;
  return {turned.x + cell * (first_column + rng.uniform() * size),
          turned.y + cell * (first_row + rng.uniform() * size), turned.theta};
}

TEST(BoxPyramid, BoundsEveryPoseOfABoxAndNotByMuchMore) {
  Rng rng(1);
  const Points map = random_points(rng, 80, 9.0, 5.0);
  const BoxPyramid pyramid = pyramid_of(map);
  TileCounts counts;
  std::size_t poses_with_contact = 0;
  for (int i = 0; i < 60; ++i) {
    const Points points = random_points(rng, 30, 4.0, 3.0);
    const AllPoses boxes(points, pyramid.frame(), pyramid.top_level());
    const int level = static_cast<int>(rng.below(4));
    const std::size_t rotation = rng.below(static_cast<std::uint32_t>(boxes.rotations(level)));
    const int size = 1 << level;
    const int column = static_cast<int>(rng.below(200)) - 40 * size;
    const int row = static_cast<int>(rng.below(100)) - 4 * size;
    pyramid.count(level, boxes.cells(level, rotation), column, row, 0, 0, counts);
    for (int k = 0; k < 40; ++k) {
      const int node_column = static_cast<int>(rng.below(TileCounts::columns));
      const int node_row = static_cast<int>(rng.below(TileCounts::rows));
      const double first_column = column + node_column * size;
      const double first_row = row + node_row * size;
      const Pose2 pose =
          somewhere_in_box(boxes, pyramid.frame(), level, rotation, first_column, first_row, rng);
      const std::size_t contact = brute_count(map, points, pose, epsilon);
      ASSERT_LE(contact, counts.at(node_column, node_row));
      poses_with_contact += contact > 0 ? 1 : 0;
      if (level > 0) continue;
      const Pose2 centre = boxes.pose(0, rotation, first_column + 0.5, first_row + 0.5);
      ASSERT_LE(counts.at(node_column, node_row),
                brute_count(map, points, centre, epsilon + pyramid.delta() + 1e-6));
    }
  }
  EXPECT_GT(poses_with_contact, 500U);  // or there was nothing to be bounded
}

TEST(BoxPyramid, CountsNothingThatIsFartherThanItSaysNearTheMiddleEither) {
  Rng rng(8);
  Points points;
  points.push_back({-4.0F, 0.0F, 0.0F});
  points.push_back({4.0F, 0.0F, 0.0F});
  for (int i = 0; i < 20; ++i)
    points.push_back(
        {static_cast<float>(rng.uniform(-0.3, 0.3)), static_cast<float>(rng.uniform(-0.3, 0.3)), 0.0F});
  std::size_t counted = 0;
  TileCounts counts;
  for (int i = 0; i < 60; ++i) {
    const Points map = random_points(rng, 1, 1.0, 1.0);
    const BoxPyramid pyramid = pyramid_of(map);
    const AllPoses boxes(points, pyramid.frame(), pyramid.top_level());
    const std::size_t rotation = rng.below(static_cast<std::uint32_t>(boxes.rotations(0)));
    pyramid.count(0, boxes.cells(0, rotation), -20, 0, 0, 0, counts);
    for (int row = 0; row < TileCounts::rows; ++row) {
      for (int column = 0; column < TileCounts::columns; ++column) {
        const Pose2 middle = boxes.pose(0, rotation, column - 19.5, row + 0.5);
        const double near = epsilon + pyramid.delta() + 1e-6;
        ASSERT_LE(counts.at(column, row), brute_count(map, points, middle, near));
        counted += counts.at(column, row);
      }
    }
  }
  EXPECT_GT(counted, 10'000U);
}

TEST(BoxPyramid, ClustersBoundEveryPoseOfABox) {
  Rng rng(5);
  const Points map = random_points(rng, 200, 9.0, 5.0);
  const BoxPyramid pyramid = pyramid_of(map);
  const int top = pyramid.top_level();
  TileCounts counts;
  std::size_t bounded = 0;
  for (int i = 0; i < 40; ++i) {
    const Points points = random_points(rng, 300, 4.0, 3.0);
    const AllPoses boxes(points, pyramid.frame(), top);
    const std::size_t loose = boxes.points_without_cluster();
    ASSERT_LT(loose, 150U);
    const std::size_t rotation = rng.below(static_cast<std::uint32_t>(boxes.rotations(top)));
    const int column = static_cast<int>(rng.below(100)) - 320;
    const int row = static_cast<int>(rng.below(60)) - 30;
    pyramid.count(top, boxes.cluster_cells(rotation), column, row, 0, 0, counts);
    for (int k = 0; k < 40; ++k) {
      const int node_column = static_cast<int>(rng.below(TileCounts::columns));
      const int node_row = static_cast<int>(rng.below(TileCounts::rows));
      const Pose2 pose =
          somewhere_in_box(boxes, pyramid.frame(), top, rotation, column + node_column * (1 << top),
                           row + node_row * (1 << top), rng);
      const std::size_t at_most = loose + AllPoses::cluster_size * counts.at(node_column, node_row);
      ASSERT_LE(brute_count(map, points, pose, epsilon), at_most);
      bounded += at_most < points.size() ? 1 : 0;
    }
  }
  EXPECT_GT(bounded, 500U);  // or the clusters say nothing
}

TEST(AllPoses, IntervalsOfALevelAreHalvesOfThoseAbove) {
  Rng rng(2);
  const Points points = random_points(rng, 30, 8.0, 6.0);
  const AllPoses boxes(points, {.cell = cell, .columns = 100, .rows = 100}, 3);
  EXPECT_EQ(boxes.rotations(0), 8 * boxes.rotations(3));
  EXPECT_NEAR(boxes.half_width(2), 0.5 * boxes.half_width(3), 1e-12);
  EXPECT_NEAR(boxes.angle(2, 10) + boxes.half_width(2), boxes.angle(3, 5), 1e-12);
  // The farthest point is moved by one cell at most by a whole interval of level 0.
  EXPECT_LE(2.0 * boxes.half_width(0) * 4.5, cell * 1.01);
}

TEST(SearchBoxes, FindsTheOtherRoomThatLooksAlike) {
  Points map = room(0.0F, 0.0F, true);
  add(map, room(10.0F, 3.0F, true));
  add(map, room(20.0F, 0.0F, false));
  const BoxPyramid pyramid = pyramid_of(map);
  const Points points = seen_in_room();
  const auto all = static_cast<double>(points.size());
  const auto least = static_cast<std::size_t>(0.97 * all);
  const auto found = search(pyramid, points, {2.0, 1.5, 0.0}, {.least = least});
  ASSERT_TRUE(found.is_complete);
  ASSERT_FALSE(found.poses.empty());
  const Pose2 rival = found.poses.front().map_from_local;
  EXPECT_NEAR(rival.x, 12.0, 0.15);
  EXPECT_NEAR(rival.y, 4.5, 0.15);
  EXPECT_NEAR(wrap_angle(rival.theta), 0.0, 0.05);
  EXPECT_EQ(found.at_most, points.size());
  EXPECT_GE(found.poses.front().in_contact, least);
  for (const auto& r : found.poses) {
    EXPECT_GE(brute_count(map, points, r.map_from_local, epsilon + pyramid.delta() + 1e-6), least);
    EXPECT_GT(std::hypot(r.map_from_local.x - 2.0, r.map_from_local.y - 1.5), 0.9);
  }
}

TEST(SearchBoxes, NoPoseElsewhereHasMoreContactThanItSays) {
  Rng rng(3);
  Points map = room(0.0F, 0.0F, true);
  add(map, room(6.0F, 1.0F, false));
  add(map, random_points(rng, 60, 10.0, 6.0));
  const BoxPyramid pyramid = pyramid_of(map);
  const Points points = seen_in_room();
  const Pose2 declared{2.0, 1.5, 0.0};
  const auto found = search(pyramid, points, declared, {.least = points.size() / 2, .most_places = 20});
  ASSERT_TRUE(found.is_complete);
  ASSERT_LT(found.at_most, points.size());
  std::size_t best = 0;
  const auto look_at = [&](const Pose2& pose) {
    if (distance(pose, declared) <= 1.0 && rotation_between(pose, declared) <= radians(30.0)) return;
    const std::size_t contact = brute_count(map, points, pose, epsilon);
    best = std::max(best, contact);
    ASSERT_LE(contact, found.at_most);
  };
  for (int i = 0; i < 2000; ++i)
    look_at(
        {rng.uniform(-1.0, 11.0), rng.uniform(-1.0, 7.0), rng.uniform(-std::numbers::pi, std::numbers::pi)});
  // Close to the best ones, and to the edge of the neighbourhood.
  for (int i = 0; i < 1000; ++i) {
    const Pose2 near = found.poses[rng.below(static_cast<std::uint32_t>(found.poses.size()))].map_from_local;
    look_at({near.x + rng.uniform(-0.1, 0.1), near.y + rng.uniform(-0.1, 0.1),
             near.theta + rng.uniform(-0.05, 0.05)});
    const double angle = rng.uniform(-std::numbers::pi, std::numbers::pi);
    const double away = rng.uniform(1.0, 1.1);
    look_at({2.0 + away * std::cos(angle), 1.5 + away * std::sin(angle), rng.uniform(-0.05, 0.05)});
  }
  // Nor is what it says far from the truth.
  EXPECT_GT(best, found.at_most * 2 / 3);
}

TEST(SearchBoxes, LooksOnlyWhereAPriorAllows) {
  Points map = room(0.0F, 0.0F, true);
  add(map, room(10.0F, 3.0F, true));
  const BoxPyramid pyramid = pyramid_of(map);
  const Points points = seen_in_room();
  const std::size_t least = points.size() * 9 / 10;
  const auto search_about = [&](double x, double y) {
    const Prior prior{.region = {.x = x, .y = y, .radius = 3.0}, .heading = {}};
    return search(pyramid, points, {2.0, 1.5, 0.0}, {.least = least, .gate = PoseGate(prior, Pose3{})});
  };
  EXPECT_TRUE(search_about(2.0, 1.5).poses.empty());
  EXPECT_EQ(search_about(2.0, 1.5).at_most, least - 1);
  EXPECT_FALSE(search_about(12.0, 4.5).poses.empty());
}

void expect_same(const BoxSearchResult& one, const BoxSearchResult& two) {
  EXPECT_EQ(one.is_complete, two.is_complete);
  EXPECT_EQ(one.looks, two.looks);
  EXPECT_EQ(one.tested, two.tested);
  EXPECT_EQ(one.at_most, two.at_most);
  ASSERT_EQ(one.poses.size(), two.poses.size());
  for (std::size_t i = 0; i < one.poses.size(); ++i) {
    EXPECT_EQ(one.poses[i].map_from_local.x, two.poses[i].map_from_local.x);
    EXPECT_EQ(one.poses[i].in_contact, two.poses[i].in_contact);
  }
}

TEST(SearchBoxes, AnswersAlikeForAnyNumberOfThreadsAndGivesUpWhenToldTo) {
  Points map = room(0.0F, 0.0F, true);
  add(map, room(10.0F, 3.0F, false));
  const BoxPyramid pyramid = pyramid_of(map);
  const Points points = seen_in_room();
  BoxSearchRule rule{.least = points.size() * 2 / 3};
  const auto one = search(pyramid, points, {2.0, 1.5, 0.0}, rule, 1);
  EXPECT_TRUE(one.is_complete);
  EXPECT_GT(one.poses.size(), 1U);
  expect_same(one, search(pyramid, points, {2.0, 1.5, 0.0}, rule, 2));
  rule.most_looks = 10;
  EXPECT_FALSE(search(pyramid, points, {2.0, 1.5, 0.0}, rule).is_complete);
  // As many as it takes, and no fewer, though a single interval of rotations takes most of them.
  rule.most_looks = one.looks;
  EXPECT_TRUE(search(pyramid, points, {2.0, 1.5, 0.0}, rule).is_complete);
}

TEST(SearchBoxes, AFewPlacesAreTheBestOfAll) {
  Points map = room(0.0F, 0.0F, true);
  add(map, room(10.0F, 3.0F, false));
  const Points points = seen_in_room();
  for (const BoxPyramid::Of of : {BoxPyramid::Of::all_poses, BoxPyramid::Of::pose_grid}) {
    const BoxPyramid pyramid(of, map, cell, epsilon, BoxPyramid::default_top_level(of));
    const auto best = [&](std::size_t most) {
      return search_boxes(pyramid, points, {}, {.least = points.size() / 2, .most_places = most},
                          Exclusion{Pose2{2.0, 1.5, 0.0}}, 1);
    };
    const BoxSearchResult all = best(100'000);
    const BoxSearchResult few = best(3);
    ASSERT_GT(all.poses.size(), 10U);
    ASSERT_EQ(few.poses.size(), 3U);
    EXPECT_EQ(few.at_most, all.at_most);
    for (std::size_t i = 0; i < few.poses.size(); ++i)
      EXPECT_EQ(few.poses[i].in_contact, all.poses[i].in_contact);
    EXPECT_LT(few.looks, all.looks);
  }
}

/// Two walls along x, 1.6 m apart.
Points corridor(float from_x, float to_x) {
  Points points;
  for (float x = from_x; x <= to_x; x += 0.05F) {
    points.push_back({x, -0.8F, 0.0F});
    points.push_back({x, 0.8F, 0.0F});
  }
  return points;
}

/// Along it all fits. Boxes at the edge of the neighbourhood have poses on both sides of it.
TEST(SearchBoxes, APoseNearTheDeclaredOneTakesNoRivalsPlace) {
  const BoxPyramid pyramid = pyramid_of(corridor(-10.0F, 10.0F));
  const Points points = corridor(-2.0F, 2.0F);
  const Pose2 declared{0.0, 0.0, 0.0};
  const auto found = search(pyramid, points, declared, {.least = points.size() * 9 / 10, .most_places = 200});
  ASSERT_TRUE(found.is_complete);
  ASSERT_GE(found.poses.size(), 20U);
  for (const auto& rival : found.poses)
    EXPECT_FALSE(PoseTolerance{}.are_near(rival.map_from_local, declared))
        << distance(rival.map_from_local, declared);
  EXPECT_EQ(found.at_most, points.size());
}

/// With cells as large as epsilon, walls 25 cm too far away are as good as in contact, for all that a box of
/// poses tells. Twelve such rooms have higher bounds than the right one, which is in want of some points.
TEST(SearchBoxes, RoomsThatOnlySeemToFitDoNotHideTheOneThatFits) {
  Points map;
  for (int i = 0; i < 12; ++i) {
    const int row = i / 4;
    const float x0 = 12.0F * static_cast<float>(i % 4);
    const float y0 = 12.0F * static_cast<float>(row);
    Points wide = room(0.0F, 0.0F, true);
    for (std::size_t k = 0; k < wide.size(); ++k)
      map.push_back({x0 + wide.x[k] * 1.11F, y0 + wide.y[k] * 1.15F, 0.0F});
  }
  const Points right = room(6.0F, 40.0F, true);
  for (std::size_t k = 0; k < right.size(); ++k) {
    if (right.x[k] < 9.0F || right.y[k] > 40.5F) map.push_back(right[k]);
  }
  const BoxPyramid pyramid(BoxPyramid::Of::all_poses, map, epsilon, epsilon, 2);
  const Points points = seen_in_room();
  const std::size_t at_right = brute_count(map, points, {8.0, 41.5, 0.0}, epsilon);
  ASSERT_LT(at_right, points.size() * 97 / 100);
  const auto found =
      search(pyramid, points, {-50.0, -50.0, 0.0}, {.least = points.size() * 8 / 10, .most_places = 10});
  ASSERT_TRUE(found.is_complete);
  EXPECT_GT(found.at_most, at_right);  // as the wide rooms have it
  ASSERT_FALSE(found.poses.empty());
  const Pose2 best = found.poses.front().map_from_local;
  EXPECT_NEAR(best.x, 8.0, 0.1);
  EXPECT_NEAR(best.y, 41.5, 0.1);
  EXPECT_NEAR(static_cast<double>(found.poses.front().in_contact), static_cast<double>(at_right),
              0.05 * static_cast<double>(points.size()));
}

/// At how many points a piece of so many looks looks.
std::size_t looks_of_piece(BoxSearch& search, std::size_t looks) {
  return search.advance(looks);
}

TEST(BoxSearch, InPiecesFindsTheSame) {
  Points map = room(0.0F, 0.0F, true);
  add(map, room(10.0F, 3.0F, false));
  const Points points = seen_in_room();
  for (const BoxPyramid::Of of : {BoxPyramid::Of::all_poses, BoxPyramid::Of::pose_grid}) {
    const BoxPyramid pyramid(of, map, cell, epsilon, BoxPyramid::default_top_level(of));
    for (const std::size_t most_looks : {std::size_t{1} << 60, std::size_t{20000}}) {
      const BoxSearchRule rule{.least = points.size() * 2 / 3, .most_looks = most_looks};
      const Exclusion declared{Pose2{2.0, 1.5, 0.0}};
      const BoxSearchResult whole = search_boxes(pyramid, points, {}, rule, declared, 1);
      std::size_t pieces_before = std::numeric_limits<std::size_t>::max();
      for (const std::size_t looks : {1U, 10U, 1000U, 1'000'000'000U}) {
        std::size_t taken = 0;
        std::size_t pieces = 0;
        BoxSearch search(pyramid, points, {}, rule, declared, pieces_before % 2 == 0 ? 1 : 3);
        for (; !search.is_over(); ++pieces) taken += looks_of_piece(search, looks);
        expect_same(search.result(), whole);
        EXPECT_GE(taken, whole.looks);
        EXPECT_EQ(looks_of_piece(search, looks), 0U);
        EXPECT_LE(pieces, pieces_before);
        pieces_before = pieces;
      }
      EXPECT_EQ(pieces_before, 1U);
    }
  }
}

TEST(BoxSearch, APieceTakesFewMoreLooksThanItIsAskedFor) {
  Points map = room(0.0F, 0.0F, true);
  add(map, room(10.0F, 3.0F, false));
  const BoxPyramid pyramid = pyramid_of(map);
  const Points points = seen_in_room();
  BoxSearch search(pyramid, points, {}, {.least = points.size() / 2}, Exclusion{Pose2{2.0, 1.5, 0.0}}, 1);
  constexpr std::size_t asked = 20000;
  constexpr std::size_t part = 25000;  // of all intervals of a batch
  std::size_t pieces = 0;
  for (; !search.is_over(); ++pieces) EXPECT_LT(looks_of_piece(search, asked), asked + part);
  EXPECT_GT(pieces, 10U);
}

TEST(BoxSearch, WhatAPieceTakesIsNotLeftForWhatFollows) {
  const BoxPyramid pyramid = pyramid_of(room(0.0F, 0.0F, true));
  const Points points = seen_in_room();
  const BoxSearchRule rule{.least = points.size() / 2};
  constexpr std::size_t enough = 1'000'000'000;
  BoxSearch whole(pyramid, points, {}, rule, {}, 1);
  std::size_t left = enough;
  const std::size_t looked = whole.advance(left);
  EXPECT_TRUE(whole.is_over());
  EXPECT_GT(enough - left, looked) << "points are laid into cells, too";
  const std::size_t taken = enough - left;
  BoxSearch half(pyramid, points, {}, rule, {}, 3);
  left = taken / 2;
  half.advance(left);
  EXPECT_FALSE(half.is_over());
  EXPECT_EQ(left, 0U);
  EXPECT_EQ(half.advance(left), 0U);
}

}  // namespace
}  // namespace glocal::search_boxes_test
