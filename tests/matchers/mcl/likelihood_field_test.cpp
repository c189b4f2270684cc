#include "matchers/mcl/likelihood_field.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "files.hpp"
#include "instruction_sets.hpp"
#include "test_world.hpp"

namespace glocal::mcl::likelihood_field_test {
namespace {

double itself(double likelihood) {
  return likelihood;
}

/// One point in the middle of a cell of the field.
GlobalMap map_of_one_point() {
  MapData data;
  data.points.push_back({0.0F, 0.0F, 0.0F});
  return GlobalMap(std::move(data));
}

TEST(LikelihoodField, WeighsAScanAsByHand) {
  // Ends 0, 0.2 and 5 m from the point, the robot 1 m below it and turned to the left.
  Points ends;
  for (const float way : {1.0F, 1.2F, 6.0F}) ends.push_back({way, 0.0F, 0.0F});
  const LikelihoodFieldRule rule{.z_hit = 0.8, .z_rand = 0.2, .max_range = 10.0, .distance_cell = 0.01};
  const LikelihoodField field(map_of_one_point(), rule, itself);
  MotionBatch poses;
  poses.cosine[0] = 0.0F;
  poses.sine[0] = 1.0F;
  poses.y[0] = -1.0F;
  LikelihoodField::Sums sums{};
  field.sum(ends, poses, 1, sums);
  // 0.8 + 0.02, 0.8 exp(-1/2) + 0.02, and 0.02 alone, as 2 m are ten deviations.
  EXPECT_NEAR(sums[0], 0.82 + 0.485225 + 0.02 + 0.02, 0.02);
}

TEST(LikelihoodField, RefusesAMapThatWouldTakeTooMuchMemory) {
  MapData data;
  data.points.push_back({0.0F, 0.0F, 0.0F});
  data.points.push_back({900.0F, 900.0F, 0.0F});
  EXPECT_THAT(
      test::error_of([&] { LikelihoodField(GlobalMap(std::move(data)), {.distance_cell = 0.05}, itself); }),
      testing::HasSubstr("it would need more than 1 GiB; cut the map"));
}

TEST(LikelihoodField, IsThatOfTheDistanceEverywhere) {
  const auto map = test::small_world();
  const LikelihoodFieldRule rule{.max_range = 20.0, .distance_cell = 0.02};
  const LikelihoodField field(*map, rule, [](double p) { return std::log(p); });
  Rng rng(5);
  for (int i = 0; i < 500; ++i) {
    const auto x = static_cast<float>(rng.uniform(-5.0, 13.0));
    const auto y = static_cast<float>(rng.uniform(-5.0, 14.0));
    double nearest = 2.0;
    for (std::size_t k = 0; k < map->points().size(); ++k) {
      const Point p = map->points()[k];
      nearest = std::min(nearest, std::hypot(double{x} - p.x, double{y} - p.y));
    }
    // The distance to the middle of a cell differs by half its diagonal at most.
    const double least = std::log(0.5 * std::exp(-12.5 * std::pow(nearest + 0.016, 2.0)) + 0.025);
    const double most =
        std::log(0.5 * std::exp(-12.5 * std::pow(std::max(0.0, nearest - 0.016), 2.0)) + 0.025);
    EXPECT_GE(field.at(x, y), least - 1e-4);
    EXPECT_LE(field.at(x, y), most + 1e-4);
  }
}

TEST(LikelihoodField, SumsAlikeWithEveryInstructionSetAndAsOneByOne) {
  const auto map = test::small_world();
  const LikelihoodField field(*map, {}, itself);
  Rng rng(8);
  MotionBatch poses;
  for (std::size_t i = 0; i < MotionBatch::capacity; ++i) {
    const Transform t(Pose2{rng.uniform(-3.0, 11.0), rng.uniform(-3.0, 12.0), rng.uniform(-3.0, 3.0)});
    poses.cosine[i] = t.cosine();
    poses.sine[i] = t.sine();
    poses.x[i] = t.x();
    poses.y[i] = t.y();
  }
  Points ends = test::seen_from(map->points(), {2.0, 2.0, 0.0}, 2.0);
  ends.push_back({1e30F, -1e30F, 0.0F});
  ends.push_back({NAN, 0.0F, 0.0F});
  std::vector<LikelihoodField::Sums> all;
  test::with_every_instruction_set([&] {
    LikelihoodField::Sums sums{};
    field.sum(ends, poses, MotionBatch::capacity, sums);
    all.push_back(sums);
  });
  for (const LikelihoodField::Sums& sums : all) EXPECT_EQ(sums, all.front());

  const Points near = test::seen_from(map->points(), {2.0, 2.0, 0.0}, 2.0);
  LikelihoodField::Sums sums{};
  field.sum(near, poses, 20, sums);
  for (std::size_t i = 0; i < 20; ++i) {
    double expected = 0.0;
    for (std::size_t k = 0; k < near.size(); ++k) {
      const Point p = poses[i](near[k]);
      expected += field.at(p.x, p.y);
    }
    // A point on the border of two cells may fall into either.
    EXPECT_NEAR(sums[i], expected, 0.1);
  }
}

}  // namespace
}  // namespace glocal::mcl::likelihood_field_test
