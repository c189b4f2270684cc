#include "matchers/common/triangle.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "bench/plain.hpp"
#include "glocal/rng.hpp"
#include "instruction_sets.hpp"
#include "points.hpp"
#include "test_world.hpp"

namespace glocal::triangle_test {
namespace {

void add(TripleBatch& batch, const Triple& triple, std::uint32_t number = 0) {
  batch.add_number(number);
  batch.first[batch.size - 1] = triple[0];
  batch.second[batch.size - 1] = triple[1];
  batch.third[batch.size - 1] = triple[2];
}

std::vector<Relation> relations(const Points& points, const Triple& triple, const TriangleRule& rule,
                                bool neighbours = false) {
  TripleBatch batch;
  add(batch, triple);
  RelationBatch found;
  find_relations(points, batch, rule, neighbours, found);
  return {found.relations.begin(), found.relations.begin() + static_cast<std::ptrdiff_t>(found.size)};
}

Transform motion(const Points& from, const Triple& from_triple, const Points& to, const Triple& to_triple) {
  TripleBatch a;
  TripleBatch b;
  add(a, from_triple);
  add(b, to_triple);
  MotionBatch motions;
  least_squares_motions(from, a, to, b, motions);
  return motions[0];
}

constexpr Relation relation_of(Relation a, Relation b, Relation c) {
  return a << 20U | b << 10U | c;
}

/// Points and triples without pattern, some of them degenerate.
struct RandomTriples {
  Points points;
  TripleBatch batch;
};
RandomTriples random_triples(std::uint64_t seed, std::size_t size) {
  RandomTriples result;
  Rng rng(seed);
  for (int i = 0; i < 500; ++i) {
    result.points.push_back(
        {static_cast<float>(rng.uniform(-20.0, 20.0)), static_cast<float>(rng.uniform(-20.0, 20.0)), 0.0F});
  }
  for (std::uint32_t n = 0; n < size; ++n) {
    const Triple triple{rng.below(500), rng.below(500), n % 9 == 0 ? rng.below(2) : rng.below(500)};
    add(result.batch, triple, 1000 + n);
  }
  return result;
}

TEST(FindRelations, AllOrdersOfDrawingGiveTheSame) {
  // Sides 5 (0-1), 4 (1-2), 3 (2-0) of a right triangle; counter-clockwise from its longest side.
  const Points points = test::points_at({{0, 0}, {5, 0}, {1.8F, 2.4F}});
  Triple triple = {0, 1, 2};
  do {
    // 5 / 0.3 = 16.7, 4 / 0.3 = 13.3, 3 / 0.3 = 10.0
    EXPECT_EQ(relations(points, triple, {.cell = 0.3}), (std::vector<Relation>{relation_of(16, 13, 10)}));
  } while (std::next_permutation(triple.begin(), triple.end()));
}

TEST(FindRelations, MirroredTrianglesDiffer) {
  const Points points = test::points_at({{0, 0}, {5, 0}, {1.8F, -2.4F}});
  EXPECT_EQ(relations(points, {0, 1, 2}, {.cell = 0.3}), (std::vector<Relation>{relation_of(16, 10, 13)}));
}

TEST(FindRelations, DoNotDependOnThePose) {
  const Points points = test::points_at({{0, 0}, {4.05F, 0}, {1, 2.55F}});
  const auto expected = relations(points, {0, 1, 2}, {});
  ASSERT_EQ(expected.size(), 1U);
  for (double theta = -3.0; theta < 3.0; theta += 0.5) {
    EXPECT_EQ(relations(test::moved(points, {3.0, -7.0, theta}), {2, 0, 1}, {}), expected);
  }
}

TEST(FindRelations, SkipWhatGivesPoorPoses) {
  const TriangleRule rule{.cell = 0.1, .min_side = 0.3, .min_height = 0.1, .max_side = 10.0};
  const auto admitted = [&](const std::vector<std::pair<float, float>>& xy, const Triple& triple) {
    return !relations(test::points_at(xy), triple, rule).empty();
  };
  EXPECT_FALSE(admitted({{0, 0}, {4, 0}, {0.2F, 0.2F}}, {0, 1, 2})) << "side of 0.28 m";
  EXPECT_FALSE(admitted({{0, 0}, {4, 0}, {2, 0.09F}}, {0, 1, 2})) << "height of 0.09 m";
  EXPECT_TRUE(admitted({{0, 0}, {4, 0}, {2, 0.11F}}, {0, 1, 2}));
  EXPECT_FALSE(admitted({{0, 0}, {10.1F, 0}, {2, 2}}, {0, 1, 2})) << "side of 10.1 m";
  EXPECT_FALSE(admitted({{0, 0}, {4, 0}, {2, 2}}, {0, 1, 1})) << "a point twice";
  const TriangleRule anything{.min_side = 0.0, .min_height = 0.0};
  EXPECT_TRUE(relations(test::points_at({{0, 0}, {4, 0}}), {0, 1, 1}, anything).empty()) << "a point twice";
}

TEST(FindRelations, NeighboursAreOwnAndNearerCells) {
  const Points points = test::points_at({{0, 0}, {5, 0}, {1.8F, 2.4F}});
  std::vector<Relation> found = relations(points, {0, 1, 2}, {.cell = 0.31}, true);
  // 5 / 0.31 = 16.13, 4 / 0.31 = 12.90, 3 / 0.31 = 9.68
  std::vector<Relation> expected;
  for (const Relation a : {16U, 15U}) {
    for (const Relation b : {12U, 13U}) {
      for (const Relation c : {9U, 10U}) expected.push_back(relation_of(a, b, c));
    }
  }
  std::sort(found.begin(), found.end());
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(found, expected);
}

TEST(FindRelations, AgreeWithPlainCodeForEveryInstructionSet) {
  for (const std::size_t size : {1U, 15U, 100U, 256U}) {
    const auto [points, batch] = random_triples(size, size);
    const TriangleRule rule{.cell = 0.15, .min_side = 2.0, .min_height = 1.0, .max_side = 30.0};
    std::vector<std::pair<std::uint32_t, Relation>> expected;
    for (std::size_t i = 0; i < size; ++i) {
      const auto triangle =
          plain::canonical_triangle(points, {batch.first[i], batch.second[i], batch.third[i]}, rule);
      if (triangle) expected.emplace_back(batch.numbers[i], triangle->relation);
    }
    test::with_every_instruction_set([&, &points = points, &batch = batch] {
      RelationBatch found;
      find_relations(points, batch, rule, false, found);
      ASSERT_EQ(found.size, expected.size());
      for (std::size_t i = 0; i < found.size; ++i) {
        EXPECT_EQ(found.numbers[i], expected[i].first);
        EXPECT_EQ(found.relations[i], expected[i].second);
      }
    });
  }
}

TEST(LeastSquaresMotions, FindAKnownMotion) {
  const Points from = test::points_at({{1, 1}, {4, 1.5F}, {2, 3}});
  const Pose2 truth{-3.0, 0.5, 2.2};
  const Pose2 found = motion(from, {0, 1, 2}, test::moved(from, truth), {1, 2, 0}).pose();
  EXPECT_NEAR(found.x, truth.x, 1e-5);
  EXPECT_NEAR(found.y, truth.y, 1e-5);
  EXPECT_NEAR(found.theta, truth.theta, 1e-6);
}

TEST(LeastSquaresMotions, NoNearbyMotionFitsBetter) {
  const Points from = test::points_at({{1, 1}, {4, 1.5F}, {2, 3}});
  const Points to = test::points_at({{-1.1F, 0.9F}, {-1.4F, 4.0F}, {-3.1F, 2.1F}});
  const auto squares = [&](const Pose2& pose) {
    const Points there = test::moved(from, pose);
    double sum = 0.0;
    for (std::size_t i = 0; i < 3; ++i) {
      sum += std::pow(there.x[i] - to.x[i], 2) + std::pow(there.y[i] - to.y[i], 2);
    }
    return sum;
  };
  const Pose2 best = motion(from, {0, 1, 2}, to, {0, 1, 2}).pose();
  for (const double d : {-0.01, 0.01}) {
    EXPECT_GT(squares({best.x + d, best.y, best.theta}), squares(best));
    EXPECT_GT(squares({best.x, best.y + d, best.theta}), squares(best));
    EXPECT_GT(squares({best.x, best.y, best.theta + d}), squares(best));
  }
}

TEST(LeastSquaresMotions, AgreeWithPlainCodeForEveryInstructionSet) {
  const auto [from_points, from] = random_triples(3, 200);
  const auto [to_points, to] = random_triples(4, 200);
  const TriangleRule rule{.min_side = 1.0, .min_height = 0.5};
  std::vector<std::optional<Transform>> expected;
  for (std::size_t i = 0; i < from.size; ++i) {
    const auto a =
        plain::canonical_triangle(from_points, {from.first[i], from.second[i], from.third[i]}, rule);
    const auto b = plain::canonical_triangle(to_points, {to.first[i], to.second[i], to.third[i]}, rule);
    expected.emplace_back();
    if (a && b) expected.back() = plain::least_squares_motion(from_points, a->triple, to_points, b->triple);
  }
  std::optional<MotionBatch> first;
  test::with_every_instruction_set(
      [&, &from_points = from_points, &from = from, &to_points = to_points, &to = to] {
        MotionBatch motions;
        least_squares_motions(from_points, from, to_points, to, motions);
        if (!first) first = motions;
        for (std::size_t i = 0; i < from.size; ++i) {
          EXPECT_EQ(motions.cosine[i], first->cosine[i]) << "bit for bit";
          EXPECT_EQ(motions.x[i], first->x[i]);
          EXPECT_EQ(motions.y[i], first->y[i]);
          if (!expected[i]) continue;
          const Pose2 plain_pose = expected[i]->pose();
          const Pose2 pose = motions[i].pose();
          EXPECT_LT(distance(pose, plain_pose), 1e-3);
          EXPECT_LT(rotation_between(pose, plain_pose), 1e-4);
        }
      });
}

}  // namespace
}  // namespace glocal::triangle_test
