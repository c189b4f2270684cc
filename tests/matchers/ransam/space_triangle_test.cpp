#include "matchers/ransam/space_triangle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "glocal/rng.hpp"
#include "points.hpp"

namespace glocal::ransam::space_triangle_test {
namespace {

constexpr TriangleRule rule{.cell = 0.1, .min_side = 0.3, .min_height = 0.2, .max_side = 20.0};

/// Sides of 3.04, 4.04 and 5.04 m; the longest is against point 2.
Points scalene() {
  // By the law of cosines: where the sides of 3.04 and 4.04 m meet.
  constexpr double a = 3.04;
  constexpr double b = 4.04;
  constexpr double c = 5.04;
  const double x = (a * a + c * c - b * b) / (2.0 * c);
  const double y = std::sqrt(a * a - x * x);
  return test::points_of({{0.0F, 0.0F, 0.0F},
                          {static_cast<float>(c), 0.0F, 0.0F},
                          {static_cast<float>(x), static_cast<float>(y), 0.0F}});
}

std::vector<Relation> relations(const Points& points, const Triple& triple, bool neighbours = false) {
  TripleBatch batch;
  batch.add(triple);
  RelationBatch found;
  find_relations_in_space(points, batch, rule, neighbours, found);
  return {found.relations.begin(), found.relations.begin() + static_cast<std::ptrdiff_t>(found.size)};
}

constexpr Relation relation_of(Relation a, Relation b, Relation c) {
  return a << 2 * relation_side_bits | b << relation_side_bits | c;
}

Pose3 somewhere(Rng& rng) {
  const auto number = [&](double most) { return rng.uniform(-most, most); };
  return {{number(9.0), number(9.0), number(9.0)}, exponential({number(1.8), number(1.8), number(1.8)})};
}

Vector3 random_vector(Rng& rng, double spread) {
  return {rng.normal(spread), rng.normal(spread), rng.normal(spread)};
}

TEST(SpaceTriangle, TheRelationIsThatOfTheSidesHoweverTheyAreDrawnAndTurned) {
  Rng rng(1);
  for (int i = 0; i < 20; ++i) {
    const Points there = moved(scalene(), somewhere(rng));
    Triple triple = {0, 1, 2};
    do {
      EXPECT_EQ(relations(there, triple), std::vector<Relation>{relation_of(50, 40, 30)});
      // 2 is against the longest side, 1 against the shortest.
      EXPECT_EQ(in_order_of_relation(there, triple), (Triple{2, 0, 1}));
    } while (std::next_permutation(triple.begin(), triple.end()));
  }
}

TEST(SpaceTriangle, MirrorImagesHaveTheSameRelation) {
  Points mirrored = scalene();
  for (float& y : mirrored.y) y = -y;
  EXPECT_EQ(relations(mirrored, {0, 1, 2}), relations(scalene(), {0, 1, 2}));
}

TEST(SpaceTriangle, NeighboursAreTheNearerCellsOfEachSide) {
  std::vector<Relation> expected;
  for (const Relation a : {50U, 49U}) {
    for (const Relation b : {40U, 39U}) {
      for (const Relation c : {30U, 29U}) expected.push_back(relation_of(a, b, c));
    }
  }
  EXPECT_EQ(relations(scalene(), {0, 1, 2}, true), expected);
}

TEST(SpaceTriangle, PoorTrianglesHaveNoRelation) {
  const Points points = test::points_of({{0.0F, 0.0F, 0.0F},
                                         {0.0F, 0.0F, 2.0F},
                                         {0.0F, 0.19F, 1.0F},
                                         {0.0F, 0.21F, 1.0F},
                                         {0.0F, 0.2F, 0.1F},
                                         {0.0F, 15.0F, 15.0F}});
  EXPECT_EQ(relations(points, {0, 1, 2}).size(), 0U);  // flat
  EXPECT_EQ(relations(points, {0, 1, 3}).size(), 1U);
  EXPECT_EQ(relations(points, {0, 1, 4}).size(), 0U);  // a short side
  EXPECT_EQ(relations(points, {0, 1, 5}).size(), 0U);  // a long one
  EXPECT_EQ(relations(points, {0, 1, 1}).size(), 0U);  // the same point twice
}

TEST(SpaceTriangle, TheMotionBetweenEqualTrianglesIsThatWhichMovedOne) {
  Rng rng(2);
  for (int i = 0; i < 200; ++i) {
    const Pose3 truth = somewhere(rng);
    const Triangle from = {random_vector(rng, 3.0), random_vector(rng, 3.0), random_vector(rng, 3.0)};
    const Pose3 found = least_squares_motion(from, {truth * from[0], truth * from[1], truth * from[2]});
    EXPECT_LT(distance(found, truth), 1e-8);
    EXPECT_LT(rotation_between(found, truth), 1e-8);
  }
}

TEST(SpaceTriangle, TheMotionBetweenOthersHasTheLeastSumOfSquares) {
  Rng rng(3);
  for (int i = 0; i < 200; ++i) {
    const Pose3 moved_by = somewhere(rng);
    // Sides of about 3 m: what noise does to the plane of a flat triangle is another matter.
    const Triangle from = {Vector3{3.0, 0.0, 0.0} + random_vector(rng, 0.3), random_vector(rng, 0.3),
                           Vector3{0.0, 3.0, 0.0} + random_vector(rng, 0.3)};
    Triangle to{};
    Eigen::Matrix3d source;
    Eigen::Matrix3d target;
    for (std::size_t k = 0; k < 3; ++k) {
      to[k] = moved_by * from[k] + random_vector(rng, 0.1);
      const auto column = static_cast<Eigen::Index>(k);
      source.col(column) = from[k];
      target.col(column) = to[k];
    }
    const Eigen::Matrix4d expected = Eigen::umeyama(source, target, false);
    const Pose3 found = least_squares_motion(from, to);
    EXPECT_LT((found.rotation.toRotationMatrix() - expected.topLeftCorner<3, 3>()).norm(), 1e-6);
    EXPECT_LT((found.translation() - expected.topRightCorner<3, 1>()).norm(), 1e-5);
  }
}

TEST(SpaceTriangle, NormalsTellMirrorImagesApart) {
  // Inclined to the triangle's plane, which is z = 0.
  const auto inclined = [](double x, double y, double z) { return as_point(Vector3{x, y, z}.normalized()); };
  const Normals normals = {inclined(1.0, 0.0, 1.0), inclined(0.0, 1.0, 1.2), inclined(1.0, 1.0, 1.0)};
  Normals mirrored = normals;
  Normals other_sides = normals;
  for (std::size_t i = 0; i < 3; ++i) {
    mirrored[i].z = -mirrored[i].z;
    other_sides[i] = -1.0F * other_sides[i];
  }
  Rng rng(4);
  const Pose3 pose = somewhere(rng);
  const RigidMotion motion(pose);
  const auto turned = [&](const Normals& n) {
    return Normals{motion.turned(n[0]), motion.turned(n[1]), motion.turned(n[2])};
  };
  EXPECT_TRUE(surfaces_agree(motion, normals, turned(normals)));
  EXPECT_TRUE(surfaces_agree(motion, normals, turned(other_sides)));
  EXPECT_FALSE(surfaces_agree(motion, normals, turned(mirrored)));
}

}  // namespace
}  // namespace glocal::ransam::space_triangle_test
