#include "matchers/indexed_ransam/proposals.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "test_world.hpp"

namespace glocal::indexed_ransam::proposals_test {
namespace {

const Pose2 truth{5.5, 2.5, 0.7};

std::vector<Pose2> proposed(const RelationRule& rule, const LocalMap& local, std::size_t draws,
                            std::uint64_t seed = 1) {
  const auto index = relation_index(*test::small_world(), rule, 1);
  std::vector<Pose2> poses;
  Rng rng(seed);
  propose(*index, rule, local, draws, rng, [&](const MotionBatch& batch, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i) poses.push_back(batch[i].pose());
  });
  return poses;
}

class Proposals : public testing::TestWithParam<std::string> {};

TEST_P(Proposals, LayTheLocalMapWhereItIsNowAndThen) {
  const LocalMap local = test::local_map_at(truth, 3.0);
  const std::vector<Pose2> poses = proposed({.relation = GetParam()}, local, 3000);
  EXPECT_GT(poses.size(), 1000U);
  EXPECT_LE(poses.size(), 3000U);
  std::size_t right = 0;
  for (const Pose2& pose : poses)
    right += distance(pose, truth) < 0.3 && rotation_between(pose, truth) < radians(5.0) ? 1 : 0;
  // By chance it would be one in some ten thousand.
  EXPECT_GT(right, 3U);
}

TEST_P(Proposals, AreTheSameForTheSameRandomNumbersOnly) {
  const LocalMap local = test::local_map_at(truth, 3.0);
  const RelationRule rule{.relation = GetParam()};
  EXPECT_EQ(proposed(rule, local, 500), proposed(rule, local, 500));
  EXPECT_NE(proposed(rule, local, 500), proposed(rule, local, 500, 2));
}

TEST_P(Proposals, AreNoneWithoutDrawsOrPoints) {
  const RelationRule rule{.relation = GetParam()};
  EXPECT_TRUE(proposed(rule, test::local_map_at(truth, 3.0), 0).empty());
  LocalMap one;
  one.points.push_back({1.0F, 0.0F, 0.0F});
  one.ends = {1};
  EXPECT_TRUE(proposed(rule, one, 100).empty());
}

TEST(OrientedPairProposals, APairIsLaidOnUpToEightDifferentOnes) {
  const LocalMap local = test::local_map_at(truth, 3.0);
  const RelationRule rule{.relation = "oriented_pair"};
  std::size_t most = 0;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const std::vector<Pose2> poses = proposed(rule, local, 1, seed);
    for (std::size_t i = 0; i < poses.size(); ++i) {
      for (std::size_t k = 0; k < i; ++k) EXPECT_NE(poses[i], poses[k]);
    }
    most = std::max(most, poses.size());
  }
  EXPECT_EQ(most, 8U);
}

INSTANTIATE_TEST_SUITE_P(Relations, Proposals, testing::Values("oriented_pair", "triangle"));

}  // namespace
}  // namespace glocal::indexed_ransam::proposals_test
