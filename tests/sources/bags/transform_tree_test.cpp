#include "sources/bags/transform_tree.hpp"

#include <gtest/gtest.h>

#include <numbers>
#include <optional>
#include <string>

namespace glocal::test::bags::transform_tree_test {
namespace {

using glocal::bags::FrameTransform;
using glocal::bags::TransformTree;

constexpr double quarter = std::numbers::pi / 2.0;

FrameTransform transform(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
                         const Pose2& pose) {
  return {{stamp_ns, parent}, child, pose};
}

/// odom: base (drives 1 m a second, from 0 s to 2 s): laser; map.
TransformTree robot() {
  TransformTree tree;
  for (const int second : {0, 1, 2})
    tree.add(transform("odom", "base", second * 1'000'000'000LL, {1.0 * second, 0.0, 0.0}), false);
  tree.add(transform("base", "laser", 0, {0.5, 0.0, quarter}), true);
  for (const int second : {0, 2})
    tree.add(transform("odom", "map", second * 1'000'000'000LL, {0.0, 3.0, quarter}), false);
  tree.settle();
  return tree;
}

std::optional<Pose3> pose(const TransformTree& tree, const std::string& in, const std::string& of,
                          std::int64_t stamp_ns, std::int64_t max_gap_ns) {
  const auto path = tree.path(in, of);
  return path ? path->pose(stamp_ns, max_gap_ns) : std::nullopt;
}

TEST(TransformTree, JoinsTransformsUpAndDown) {
  const TransformTree tree = robot();
  const auto laser = pose(tree, "odom", "laser", 1'500'000'000, 1'000'000'000);
  ASSERT_TRUE(laser);
  EXPECT_NEAR(laser->x, 2.0, 1e-12);
  EXPECT_NEAR(laser->heading(), quarter, 1e-12);
  // The map is 3 m to the left of odom's origin, and turned by a quarter to the left: base lies 3 m behind
  // its x axis … that is, to the map's right by what base has driven.
  const auto base = pose(tree, "map", "base", 1'000'000'000, 1'000'000'000);
  ASSERT_TRUE(base);
  EXPECT_NEAR(base->x, -3.0, 1e-12);
  EXPECT_NEAR(base->y, -1.0, 1e-12);
  EXPECT_NEAR(base->heading(), -quarter, 1e-12);
}

TEST(TransformTree, AFrameHasItselfForAWay) {
  const TransformTree tree = robot();
  EXPECT_TRUE(tree.path("base", "base"));
  EXPECT_EQ(pose(tree, "nowhere", "nowhere", 0, 1), Pose3());
}

TEST(TransformTree, KnowsWhatItDoesNotKnow) {
  const TransformTree tree = robot();
  EXPECT_EQ(tree.parents().at("base"), "odom");
  EXPECT_EQ(tree.parents().at("laser"), "base");
  EXPECT_FALSE(tree.parents().contains("camera"));
  EXPECT_FALSE(tree.path("odom", "camera"));
  EXPECT_FALSE(pose(tree, "odom", "base", 3'000'000'000, 1'000'000'000));
  EXPECT_FALSE(pose(tree, "odom", "base", 500'000'000, 999'999'999));
}

TEST(TransformTree, TellsWhatStandsStill) {
  const TransformTree tree = robot();
  EXPECT_TRUE(tree.path("base", "laser")->is_still());
  EXPECT_TRUE(tree.path("odom", "map")->is_still());
  EXPECT_FALSE(tree.path("odom", "laser")->is_still());
}

TEST(TransformTree, TakesTheParentThatIsNamedMostOften) {
  TransformTree tree;
  tree.add(transform("world", "base", 0, {9.0, 0.0, 0.0}), false);
  for (const int second : {0, 1}) tree.add(transform("odom", "base", second, {1.0, 0.0, 0.0}), false);
  tree.settle();
  EXPECT_EQ(tree.parents().at("base"), "odom");
  EXPECT_FALSE(tree.path("world", "base"));
}

TEST(TransformTree, ALaterStaticTransformTakesTheEarlierOnesPlace) {
  TransformTree tree;
  tree.add(transform("base", "laser", 0, {1.0, 0.0, 0.0}), true);
  tree.add(transform("base", "laser", 5, {2.0, 0.0, 0.0}), true);
  tree.settle();
  EXPECT_EQ(pose(tree, "base", "laser", 77, 1)->x, 2.0);
}

TEST(TransformTree, AWayOverThousandsOfFramesIsFoundOnce) {
  TransformTree tree;
  constexpr int frames = 9'800;
  const auto name = [](int i) { return "f" + std::to_string(i); };
  for (int i = 0; i < frames; ++i) {
    for (const std::int64_t second : {0, 1})
      tree.add(transform(name(i), name(i + 1), second * 1'000'000'000, {1e-3, 0.0, 0.0}), i == 0);
  }
  tree.settle();
  const auto path = tree.path(name(0), name(frames));
  ASSERT_TRUE(path);
  // Minutes if the way was looked up each time.
  for (std::int64_t i = 0; i < 1000; ++i) ASSERT_NEAR(path->pose(i, 1'000'000'000)->x, 9.8, 1e-9);
}

TEST(TransformTree, FramesThatAreTheirOwnAncestorsEnd) {
  TransformTree tree;
  tree.add(transform("a", "b", 0, {1.0, 0.0, 0.0}), true);
  tree.add(transform("b", "a", 0, {1.0, 0.0, 0.0}), true);
  tree.settle();
  EXPECT_TRUE(tree.path("a", "b"));
  EXPECT_FALSE(tree.path("a", "c"));
}

}  // namespace
}  // namespace glocal::test::bags::transform_tree_test
