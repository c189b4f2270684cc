#include "sources/disturbed/drive_disturbances.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

#include "sources/disturbed/surroundings.hpp"

namespace glocal::disturbed::drive_disturbances_test {
namespace {

/// A robot that drives 1 m forwards and 0.1 rad to the left in each of `n` steps; the scan of step i has a
/// hit i m ahead and one 2 m to the left.
std::vector<Sample> drive(int n) {
  std::vector<Sample> samples;
  Pose2 odom_from_robot;
  for (int i = 0; i < n; ++i) {
    Sample sample;
    sample.observation.stamp = i;
    sample.observation.odom_from_robot = odom_from_robot;
    sample.observation.scan.hits.push_back({static_cast<float>(i), 0.0F, 0.0F});
    sample.observation.scan.hits.push_back({0.0F, 2.0F, 0.0F});
    samples.push_back(sample);
    odom_from_robot = odom_from_robot * Pose2{1.0, 0.0, 0.1};
  }
  return samples;
}

std::vector<Sample> disturbed(Disturbance&& by, const std::vector<Sample>& drive) {
  std::vector<Sample> left;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    if (auto sample = by.disturb(drive[i], Rng(1).stream({i}))) left.push_back(*std::move(sample));
  }
  return left;
}

/// The robot's motion before a sample, as odometry has it.
Pose2 motion_before(const std::vector<Sample>& samples, std::size_t i) {
  return inverse(seen_from_above(samples[i - 1].observation.odom_from_robot)) *
         seen_from_above(samples[i].observation.odom_from_robot);
}

TEST(DriveDisturbances, ScansAreDroppedByTheirShare) {
  const auto left = disturbed(DroppedScans(0.25, Rng(1)), drive(2000));
  EXPECT_NEAR(static_cast<double>(left.size()), 1500.0, 80.0);
}

TEST(DriveDisturbances, LateScansComeWithLaterOdometry) {
  std::vector<Sample> way = drive(8);
  for (std::size_t i = 5; i < 8; ++i) way[i].segment = 1;
  const auto left = disturbed(LateScans(2.0, Rng(1)), way);
  ASSERT_EQ(left.size(), 4U) << "two of each segment are lost";
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(left[i].observation.scan.hits.x[0], static_cast<float>(i));
    EXPECT_EQ(left[i].observation.odom_from_robot, way[i + 2].observation.odom_from_robot);
    EXPECT_EQ(left[i].observation.stamp, way[i + 2].observation.stamp);
  }
  EXPECT_EQ(left[3].observation.scan.hits.x[0], 5.0F);
}

TEST(DriveDisturbances, ADriverThatHangsRepeatsItself) {
  const auto left = disturbed(RepeatedScans(3.0, Rng(1)), drive(7));
  ASSERT_EQ(left.size(), 7U);
  for (std::size_t i = 0; i < 7; ++i)
    EXPECT_EQ(left[i].observation.scan.hits.x[0], static_cast<float>(i - i % 3));
}

TEST(DriveDisturbances, NothingGoesFromOneSegmentToTheNext) {
  std::vector<Sample> way = drive(6);
  for (std::size_t i = 4; i < 6; ++i) way[i].segment = 1;
  EXPECT_EQ(disturbed(RepeatedScans(3.0, Rng(1)), way)[4].observation.scan.hits.x[0], 4.0F);
  EXPECT_EQ(disturbed(Jitter(1.0, Rng(1)), way)[4].observation.odom_from_robot,
            way[4].observation.odom_from_robot);
}

TEST(DriveDisturbances, AMountThatLooksToTheLeftPutsThingsToTheRight) {
  const auto left = disturbed(MountAngle(90.0, Rng(1)), drive(3));
  const Points& hits = left[2].observation.scan.hits;
  EXPECT_NEAR(hits.x[0], 0.0, 1e-6);
  EXPECT_NEAR(hits.y[0], -2.0, 1e-6);
  EXPECT_NEAR(hits.x[1], 2.0, 1e-6);
}

TEST(DriveDisturbances, InAMirrorScanAndWayAreTheOtherWayRound) {
  const auto way = drive(3);
  const auto left = disturbed(Mirrored(1.0, Rng(1)), way);
  EXPECT_EQ(left[2].observation.scan.hits[1], (Point{0.0F, -2.0F, 0.0F}));
  const Pose2 motion = motion_before(way, 2), mirrored = motion_before(left, 2);
  EXPECT_NEAR(mirrored.x, motion.x, 1e-12);
  EXPECT_NEAR(mirrored.y, -motion.y, 1e-12);
  EXPECT_NEAR(mirrored.theta, -motion.theta, 1e-12);
}

TEST(DriveDisturbances, RangesThatAreStuckStayWhatTheyWereFirst) {
  // A round room of 1 m, 2 m, ...
  std::vector<Sample> way = drive(4);
  for (std::size_t i = 0; i < way.size(); ++i) {
    Points hits;
    for (int k = 0; k < 360; ++k) {
      const double angle = radians(k + 0.5), range = 1.0 + static_cast<double>(i);
      hits.push_back(
          {static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)), 0.0F});
    }
    way[i].observation.scan.hits = hits;
  }
  const auto left = disturbed(StuckRanges(0.4, Rng(1)), way);
  std::set<std::size_t> stuck;
  for (std::size_t i = 1; i < left.size(); ++i) {
    for (std::size_t k = 0; k < 360; ++k) {
      const Point hit = left[i].observation.scan.hits[k];
      const double range = std::hypot(hit.x, hit.y);
      if (range < 1.5) stuck.insert(k);
      EXPECT_NEAR(range, stuck.contains(k) ? 1.0 : 1.0 + static_cast<double>(i), 1e-5);
    }
  }
  EXPECT_NEAR(static_cast<double>(stuck.size()), 0.4 * 360.0, 28.0) << "three standard deviations";
}

TEST(DriveDisturbances, UpsideDownLeftIsRight) {
  const auto left = disturbed(UpsideDown(1.0, Rng(1)), drive(3));
  EXPECT_EQ(left[2].observation.scan.hits[0], (Point{2.0F, 0.0F, 0.0F}));
  EXPECT_EQ(left[2].observation.scan.hits[1], (Point{0.0F, -2.0F, 0.0F}));
  std::vector<Sample> in_space = drive(1);
  in_space[0].observation.scan.origin = {0.1F, 0.0F, 0.5F};
  in_space[0].observation.scan.hits.z[1] = 0.75F;
  const auto turned = disturbed(UpsideDown(1.0, Rng(1)), in_space);
  EXPECT_EQ(turned[0].observation.scan.hits[1].z, 0.25F) << "above is below, as nothing mirrors a sensor";
}

TEST(DriveDisturbances, WaysAreStretchedAndTurnsAreNot) {
  const auto left = disturbed(StretchedWays(0.2, Rng(1)), drive(4));
  for (std::size_t i = 1; i < 4; ++i) {
    const Pose2 motion = motion_before(left, i);
    EXPECT_NEAR(motion.x, 1.2, 1e-12);
    EXPECT_NEAR(motion.theta, 0.1, 1e-12);
  }
}

TEST(DriveDisturbances, ATurnThatWheelsDoNotNoticeIsMissing) {
  const auto left = disturbed(PulledAside(5.0, Rng(1)), drive(4));
  for (std::size_t i = 1; i < 4; ++i)
    EXPECT_NEAR(motion_before(left, i).theta, 0.1 - 5.0 * std::numbers::pi / 180.0, 1e-12);
}

TEST(DriveDisturbances, WheelsSpinOrStandStillByTheirShare) {
  const std::vector<Sample> way = drive(2001);
  int spun = 0, lost = 0;
  const auto spinning = disturbed(SpinningWheels(0.3, Rng(1)), way);
  const auto standing = disturbed(LostMotions(0.3, Rng(1)), way);
  for (std::size_t i = 1; i < way.size(); ++i) {
    const Pose2 motion = motion_before(spinning, i);
    EXPECT_NEAR(motion.theta / 0.1, motion.x, 1e-6) << "way and turn alike";
    EXPECT_LT(motion.x, 2.0);
    if (motion.x > 1.0 + 1e-6) ++spun;
    if (std::abs(motion_before(standing, i).x) < 1e-9) ++lost;
  }
  EXPECT_NEAR(spun, 600, 70);
  EXPECT_NEAR(lost, 600, 70);
}

TEST(Surroundings, GlassIsAlwaysAtTheSamePlace) {
  // A robot that stands, and one that has turned: they look at the same wall.
  std::vector<Sample> looks(2);
  for (std::size_t i = 0; i < 2; ++i) {
    looks[i].observation.odom_from_robot = Pose2{0.0, 0.0, i == 0 ? 0.0 : 0.5};
    const Transform robot_from_odom(inverse(Pose2{0.0, 0.0, i == 0 ? 0.0 : 0.5}));
    for (int k = 0; k < 1000; ++k)
      looks[i].observation.scan.hits.push_back(
          robot_from_odom({5.5F, -50.0F + 0.1F * static_cast<float>(k) + 0.05F, 0.0F}));
  }
  const auto left = disturbed(Glass(0.3, Rng(3)), looks);
  const std::size_t unchanged = 1000 - left[0].observation.scan.free_ends.size();
  EXPECT_LT(unchanged, 980U) << "some panes have nothing behind them";
  ASSERT_EQ(left[0].observation.scan.hits.size(), left[1].observation.scan.hits.size());
  std::set<int> panes;
  for (std::size_t k = 0; k < left[0].observation.scan.hits.size(); ++k) {
    const Points &one = left[0].observation.scan.hits, &other = left[1].observation.scan.hits;
    const double range = std::hypot(one.x[k], one.y[k]);
    EXPECT_NEAR(range, std::hypot(other.x[k], other.y[k]), 1e-3);
    if (one.x[k] < 5.5001F) continue;
    const double was = 5.5 * range / one.x[k];
    EXPECT_GT(range - was, 0.49);
    EXPECT_LT(range - was, 3.01);
    panes.insert(static_cast<int>(std::floor(one.y[k] * 5.5 / one.x[k])));
  }
  EXPECT_GT(panes.size(), 10U);
  EXPECT_LT(panes.size(), 32U) << "of a hundred panes, thirty less those with nothing behind";
}

TEST(Surroundings, MirrorsShowWhatStandsBeforeThem) {
  // In the middle of a room of 4 m x 4 m, a beam each degree.
  std::vector<Sample> looks(1);
  for (int k = 0; k < 360; ++k) {
    const double c = std::cos(radians(k)), s = std::sin(radians(k));
    const double range = 2.0 / std::max(std::abs(c), std::abs(s));
    looks[0].observation.scan.hits.push_back(
        {static_cast<float>(range * c), static_cast<float>(range * s), 0.0F});
  }
  const auto left = disturbed(Mirrors(1.0, Rng(3)), looks);
  const Points& hits = left[0].observation.scan.hits;
  const auto range_at = [&](double bearing_deg) {
    for (std::size_t k = 0; k < hits.size(); ++k) {
      if (std::abs(degrees(std::atan2(hits.y[k], hits.x[k])) - bearing_deg) < 0.1)
        return std::hypot(hits.x[k], hits.y[k]);
    }
    return 0.0F;
  };
  EXPECT_NEAR(range_at(0.0), 6.0, 0.01) << "back past the sensor, to the wall behind it";
  // At 20 degrees to (2, 0.728), then at 160 degrees to the wall at y = 2: 1.272 m up are 3.719 m of way. A
  // hit 0.1 m beside the ray is on it, and up to 0.1 / tan(20 degrees) nearer.
  const double expected = 2.0 / std::cos(radians(20.0)) + 1.272 / std::sin(radians(20.0));
  EXPECT_NEAR(range_at(20.0), expected - 0.14, 0.15);
  EXPECT_NEAR(range_at(-70.0), range_at(20.0), 0.01) << "the room is a square";
  const auto unchanged = disturbed(Mirrors(0.0, Rng(3)), looks);
  EXPECT_EQ(unchanged[0].observation.scan.hits, looks[0].observation.scan.hits);
}

TEST(Surroundings, PeopleStandBeforeTheWallAndWalk) {
  std::vector<Sample> looks(50);
  for (Sample& look : looks) {
    for (int k = 0; k < 360; ++k) {
      const double angle = k * std::numbers::pi / 180.0;
      look.observation.scan.hits.push_back(
          {static_cast<float>(9.0 * std::cos(angle)), static_cast<float>(9.0 * std::sin(angle)), 0.0F});
    }
  }
  const auto left = disturbed(People(10.0, Rng(1)), looks);
  std::set<std::vector<bool>> views;
  double covered = 0.0;
  for (const Sample& look : left) {
    ASSERT_EQ(look.observation.scan.hits.size(), 360U);
    std::vector<bool> view;
    for (std::size_t k = 0; k < 360; ++k) {
      const double range = std::hypot(look.observation.scan.hits.x[k], look.observation.scan.hits.y[k]);
      view.push_back(range < 8.99);
      if (range < 8.99) {
        EXPECT_GE(range, 0.49);
        covered += 1.0 / 360.0 / 50.0;
      }
    }
    views.insert(view);
  }
  EXPECT_EQ(views.size(), 50U) << "they walk";
  // Each covers 0.5 m of the circle that he stands on, at 5 m in the mean: about 6 degrees, and more nearby.
  EXPECT_GT(covered, 0.08);
  EXPECT_LT(covered, 0.35);
}

/// A lidar 1 m above the floor: rays up and down meet the same upright person, and none above his head.
TEST(Surroundings, PeopleStandUpright) {
  Sample look;
  look.observation.scan.origin = {0.0F, 0.0F, 1.0F};
  const std::vector<double> rises = {-5.0, 0.0, 5.0, 40.0};  // deg
  for (const double rise : rises) {
    for (int k = 0; k < 360; ++k) {
      const double angle = radians(k), flat = 20.0 * std::cos(radians(rise));
      look.observation.scan.hits.push_back({static_cast<float>(flat * std::cos(angle)),
                                            static_cast<float>(flat * std::sin(angle)),
                                            static_cast<float>(1.0 + 20.0 * std::sin(radians(rise)))});
    }
  }
  const Points hits = disturbed(People(1.0, Rng(1)), {look})[0].observation.scan.hits;
  const auto away = [&](std::size_t ring, std::size_t k) {
    return std::hypot(hits.x[360 * ring + k], hits.y[360 * ring + k]);
  };
  int met = 0;
  for (std::size_t k = 0; k < 360; ++k) {
    EXPECT_GT(away(3, k), 15.0F) << "he is not 5 m tall";
    if (away(1, k) > 19.0F) continue;
    ++met;
    EXPECT_NEAR(away(0, k), away(1, k), 1e-3F);
    EXPECT_NEAR(away(2, k), away(1, k), 1e-3F);
  }
  EXPECT_GT(met, 2);
}

TEST(DriveDisturbances, ReversedMotionsTakeTheWayBack) {
  const auto way = drive(1001);
  const auto left = disturbed(ReversedMotions(0.2, Rng(1)), way);
  int reversed = 0;
  for (std::size_t i = 1; i < left.size(); ++i) {
    const Pose2 told = motion_before(left, i), was = motion_before(way, i);
    if (told.theta > 0.0) continue;
    ++reversed;
    const Pose2 none = told * was;
    EXPECT_NEAR(std::hypot(none.x, none.y) + std::abs(none.theta), 0.0, 1e-9);
  }
  EXPECT_NEAR(reversed, 200, 40);
}

TEST(DriveDisturbances, JitterIsWithinTheLastMotionAndNeverAddsUp) {
  const auto way = drive(1001);
  const auto left = disturbed(Jitter(0.5, Rng(1)), way);
  EXPECT_EQ(left[0].observation.odom_from_robot, way[0].observation.odom_from_robot);
  double sum = 0.0;
  for (std::size_t i = 1; i < left.size(); ++i) {
    const Pose2 behind = inverse(seen_from_above(left[i].observation.odom_from_robot)) *
                         seen_from_above(way[i].observation.odom_from_robot);
    EXPECT_GE(behind.theta, -1e-9);
    EXPECT_LE(behind.theta, 0.05 + 1e-9);  // half of 0.1 rad
    sum += behind.theta;
  }
  EXPECT_NEAR(sum / 1000.0, 0.025, 0.002);
}

}  // namespace
}  // namespace glocal::disturbed::drive_disturbances_test
