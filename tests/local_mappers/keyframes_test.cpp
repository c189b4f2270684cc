#include "local_mappers/keyframes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "local_mappers/drives.hpp"

namespace glocal::local_mappers::keyframes_test {
namespace {

using test::at;
using ::testing::ElementsAre;

// With so few hits odometry is kept.

TEST(Keyframes, RegistersWhenTheRobotHasMovedFarEnough) {
  Keyframes mapper({.distance = 0.5, .angle_deg = 60.0, .overlap = 0.0});
  // Each hit is new; keyframes are at 0, 0.6 and 1.1 m.
  for (const double x : {0.0, 0.3, 0.4, 0.6, 1.0, 1.1}) mapper.add(at(x, {{1.01F, 0.01F, 0}}));
  EXPECT_THAT(mapper.map().ends, ElementsAre(1U, 1U, 1U, 2U, 2U, 3U));
  EXPECT_NEAR(mapper.map().local_from_robot.x, 1.1, 1e-12);
  EXPECT_NEAR(mapper.map().points.x[1], 1.61F, 1e-5F);
}

TEST(Keyframes, RegistersWhenTheRobotHasTurnedEnough) {
  Keyframes mapper({.distance = 10.0, .angle_deg = 20.0, .overlap = 0.0});
  for (const double theta : {0.0, 0.2, 0.34, -0.34, -0.4, -0.1, 0.0}) {
    Observation observation = at(0.0, {{2.01F, 0.01F, 0}});
    observation.odom_from_robot = Pose2{0.0, 0.0, theta};
    mapper.add(observation);
  }
  EXPECT_THAT(mapper.map().ends, ElementsAre(1U, 1U, 1U, 1U, 2U, 2U, 2U));
}

TEST(Keyframes, RegistersWhatTheMapDoesNotShow) {
  Keyframes mapper({.distance = 10.0, .angle_deg = 170.0, .overlap = 0.5});
  mapper.add(at(0.0, {{1, 0, 0}, {1, 1, 0}, {1, 2, 0}, {1, 3, 0}}));
  // Two of four within 10 cm of a point, one 15 cm away, one far from all: just enough.
  mapper.add(at(0.0, {{1.08F, 0, 0}, {1, 1.08F, 0}, {1, 2.15F, 0}, {5, 5, 0}}));
  EXPECT_THAT(mapper.map().ends, ElementsAre(4U, 4U));
  mapper.add(at(0.0, {{1.08F, 0, 0}, {1, 1.12F, 0}, {1, 2.15F, 0}, {5, 5, 0}}));
  EXPECT_THAT(mapper.map().ends, ElementsAre(4U, 4U, 8U));
}

TEST(Keyframes, AnObservationWithoutHitsIsNone) {
  Keyframes mapper({});
  mapper.add(at(0.0, {}));
  mapper.add(at(0.1, {{1.01F, 0.01F, 0}}));  // so this is the first one
  mapper.add(at(2.0, {}));
  mapper.add(at(2.1, {{1.01F, 0.01F, 0}}));
  EXPECT_THAT(mapper.map().ends, ElementsAre(0U, 1U, 1U, 2U));
}

TEST(Keyframes, FollowsTheRobotWithAThirdOfTheScans) {
  const test::Drive noisy =
      test::drive(test::furnished_room(), test::circle(120), {.noise = 0.02}, test::bad_odometry);
  Keyframes mapper({.overlap = 0.0});
  double worst = 0.0;
  for (std::size_t k = 0; k < noisy.observations.size(); ++k) {
    mapper.add(noisy.observations[k]);
    const Pose2 truth = inverse(noisy.map_from_robot.front()) * noisy.map_from_robot[k];
    worst = std::max(worst, distance(truth, mapper.map().local_from_robot));
  }
  EXPECT_LT(worst, 0.08);
  // The circle turns by 0.1 rad every 0.2 m: keyframes every 3 to 4 steps, and after one round few of them
  // add points.
  const std::vector<std::size_t>& ends = mapper.map().ends;
  int adding = 1;
  for (std::size_t k = 1; k < 60; ++k) adding += ends[k] > ends[k - 1] ? 1 : 0;
  EXPECT_GE(adding, 60 / 5);
  EXPECT_LE(adding, 60 / 3 + 1);
}

TEST(Keyframes, TheFirstOneOfANewMapIsOne) {
  Keyframes mapper({.distance = 100.0, .angle_deg = 170.0, .overlap = 0.0});
  for (const Observation& observation : test::kidnapping().observations) mapper.add(observation);
  EXPECT_EQ(mapper.map().epoch, 1);
  ASSERT_EQ(mapper.map().ends.size(), 3U);
  EXPECT_GT(mapper.map().ends.front(), 50U);
  EXPECT_EQ(mapper.map().ends.back(), mapper.map().ends.front());
}

}  // namespace
}  // namespace glocal::local_mappers::keyframes_test
