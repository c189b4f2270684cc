#include "matchers/surfels/surfels.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "matchers/surfels/point_to_plane.hpp"
#include "matchers/surfels/prepared_cloud.hpp"
#include "matchers/surfels/scanned_hall.hpp"
#include "matchers/surfels/surfel_pairs.hpp"
#include "matchers/surfels/voxel_table.hpp"

namespace glocal::test::surfels_test {
namespace {

using namespace surfels;

constexpr float voxel = 0.2F;
const Pose3 place({5.0, 4.5, 1.2}, exponential({0.2, -0.1, 0.7}));

TEST(VoxelTable, KeepsNumbersWhereTheyWereSet) {
  Points points;
  for (const Point& p : {Point{-3.0F, 0.0F, 1.0F}, Point{5.0F, 2.0F, 9.0F}}) points.push_back(p);
  VoxelTable table(VoxelRegion(points, 0.5F, 1));
  EXPECT_EQ(table.at(points[0]), VoxelTable::none);
  table.slot(table.voxel_of(points[0])) = 7;
  table.slot(table.voxel_of(points[1])) = 8;
  EXPECT_EQ(table.at(points[0]), 7U);
  EXPECT_EQ(table.at(Point{-2.9F, 0.1F, 1.1F}), 7U);
  EXPECT_EQ(table.at(points[1]), 8U);
  EXPECT_EQ(table.at(Point{-2.4F, 0.0F, 1.0F}), VoxelTable::none);
  EXPECT_EQ(table.at(Point{1e9F, 0.0F, 0.0F}), VoxelTable::none);
  EXPECT_EQ(table.at(Point{std::nanf(""), 0.0F, 0.0F}), VoxelTable::none);
}

TEST(Surfels, NormalsOfAHallAreThoseOfItsSidesAndPointToTheSensor) {
  const Surfels surfels = surfels_of(scan_of(hall(), place), voxel, Point{});
  ASSERT_GT(surfels.size(), 500U);
  std::size_t along_an_axis = 0;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    const Point n = surfels.normals[i];
    EXPECT_NEAR(length(n), 1.0F, 1e-3F);
    EXPECT_LE(dot(n, surfels.points[i]), 0.0F);
    const Vector3 in_hall = place.rotation * Vector3{n.x, n.y, n.z};
    const double largest = std::max({std::abs(in_hall.x()), std::abs(in_hall.y()), std::abs(in_hall.z())});
    if (largest > std::cos(radians(10.0))) ++along_an_axis;
  }
  EXPECT_GT(along_an_axis, surfels.size() * 8 / 10);  // the others are at edges
  EXPECT_NEAR(std::accumulate(surfels.weights.begin(), surfels.weights.end(), 0.0F),
              static_cast<float>(surfels.size()), 1.0F);
}

TEST(Surfels, PointsInViewOfARobotFitIntoATableOfVoxels) {
  constexpr float robot_x = 7.0F;
  LocalMap local;
  local.local_from_robot = Pose3(Vector3{robot_x, 0.0, 0.0});
  for (const float away : {-199.0F, 199.0F}) {
    local.points.push_back({robot_x + away, 0.0F, 0.0F});
    local.points.push_back({robot_x, away, 0.0F});
    local.points.push_back({robot_x, 0.0F, away});
  }
  local.points.push_back({robot_x, 0.0F, 201.0F});
  local.points.push_back({robot_x, 0.0F, 501.0F});
  const Points in_view = points_in_view(local, 0.1F);
  EXPECT_EQ(in_view.size(), 6U);
  EXPECT_NO_THROW(VoxelRegion(in_view, 0.1F, 2));
  EXPECT_EQ(points_in_view(local, 1.0F).size(), 7U) << "no lidar sees farther than 500 m";
}

TEST(PreparedCloud, ACloudAgreesWithItselfAndNothingIsSeenThrough) {
  const Points scan = scan_of(hall(), place);
  const PreparedCloud cloud(scan, voxel, Point{});
  const Agreement itself = agreement_of(cloud.surfels, RigidMotion(), cloud);
  EXPECT_GT(itself.contact, 0.99);
  EXPECT_EQ(itself.seen_through, 0.0);
}

TEST(PreparedCloud, AWallInFrontOfWhatWasSeenIsSeenThrough) {
  const PreparedCloud cloud(scan_of(hall(), place), voxel, Point{});
  // A meter of wall, two meters before the sensor, where it saw five.
  Surfels wall;
  const Pose3 lidar_from_hall = inverse(place);
  for (int i = 0; i < 20; ++i) {
    const Vector3 p = lidar_from_hall * Vector3{5.0, 2.5, 0.5 + 0.05 * i};
    const Vector3 n = lidar_from_hall.rotation * Vector3{0.0, 1.0, 0.0};
    wall.points.push_back(as_point(p));
    wall.normals.push_back(as_point(n));
    wall.weights.push_back(1.0F);
  }
  const Agreement agreement = agreement_of(wall, RigidMotion(), cloud);
  EXPECT_EQ(agreement.contact, 0.0);
  EXPECT_GT(agreement.seen_through, 0.5);
}

TEST(SurfelPairs, RelationsStayWhenTheCloudIsMovedAndTheMotionIsFound) {
  const Surfels surfels = surfels_of(scan_of(hall(), place), voxel, Point{});
  const Pose3 pose({3.0, -2.0, 0.5}, exponential({1.0, -2.0, 0.4}));
  const RigidMotion motion(pose);
  Surfels moved = surfels;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    moved.points.set(i, motion(surfels.points[i]));
    moved.normals.set(i, motion.turned(surfels.normals[i]));
  }
  for (const bool both_sides : {false, true}) {
    const PairRule rule{.shortest = 1.0F, .longest = 8.0F, .length_cell = voxel, .both_sides = both_sides};
    const PairSampler sampler(surfels, rule);
    Rng rng(3);
    std::size_t drawn = 0;
    std::size_t same_relation = 0;
    for (int i = 0; i < 2000; ++i) {
      const auto pair = sampler.draw(rng);
      if (!pair) continue;
      ++drawn;
      SurfelPair same = pair->first;
      const auto relation = relation_of(moved, same, rule);
      // Rounding may bring a relation into the next cell, or turn the pair around.
      if (!relation || *relation != pair->second || same.first != pair->first.first) continue;
      ++same_relation;
      const RigidMotion found = motion_between(surfels, pair->first, moved, same, both_sides);
      EXPECT_GT(cosine_between(found, motion), 0.999F);
      EXPECT_LT(length(found.translation - motion.translation), 0.05F);
    }
    EXPECT_GT(drawn, 100U);
    EXPECT_GT(same_relation, drawn * 9 / 10);
  }
}

TEST(SurfelPairs, SmallWeightsCountHoweverManySurfelsThereAre) {
  Surfels surfels;
  const auto add = [&](const Point& point, const Point& normal, float weight) {
    surfels.points.push_back(point);
    surfels.normals.push_back(normal);
    surfels.weights.push_back(weight);
  };
  constexpr int million = 1 << 20;
  add({0.0F, 0.0F, 0.0F}, {0.0F, 1.0F, 0.0F}, million);
  for (int i = 0; i < million; ++i) add({2.0F, 0.0F, 0.0F}, {0.0F, 0.0F, 1.0F}, 0.05F);
  const PairSampler sampler(surfels,
                            {.shortest = 1.0F, .longest = 8.0F, .length_cell = voxel, .both_sides = false});
  Rng rng(5);
  int drawn = 0;
  for (int i = 0; i < 1000; ++i) drawn += sampler.draw(rng) ? 1 : 0;
  EXPECT_GT(drawn, 60) << "91 of 1000 draws are of a light surfel and the heavy one";
}

TEST(PointToPlane, RefinesAPoseThatIsALittleOff) {
  const PreparedCloud target(scan_of(hall(), place), voxel, Point{});
  const Pose3 other({5.4, 4.2, 1.3}, exponential({0.2, -0.1, 0.9}));
  const Pose3 truth = inverse(place) * other;
  const Pose3 guess = truth * Pose3({0.08, -0.06, 0.05}, exponential({0.02, -0.03, 0.03}));
  // Wherever the origin of the source is.
  for (const Pose3& origin_from_scan :
       {Pose3(), Pose3({500.0, -300.0, 20.0}, exponential({0.0, 0.1, 2.0}))}) {
    const PreparedCloud source(moved(scan_of(hall(), other), origin_from_scan), voxel,
                               as_point(origin_from_scan.translation()));
    Rng rng(1);
    const SurfelSample sample = sample_of(source.surfels, 500, rng);
    const RigidMotion start(guess * inverse(origin_from_scan));
    const Pose3 found =
        refined(start, sample, sample.size(), target.contact, 15, false).pose() * origin_from_scan;
    EXPECT_LT(distance(found, truth), 0.02) << origin_from_scan.x;
    EXPECT_LT(degrees(rotation_between(found, truth)), 0.3) << origin_from_scan.x;
  }
}

}  // namespace
}  // namespace glocal::test::surfels_test
