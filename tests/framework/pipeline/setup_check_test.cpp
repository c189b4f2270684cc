// Robots whose scans and odometry tell motions that are given: 0.3 m ahead, or a turn of 10 degrees.
#include "glocal/setup_check.hpp"

#include <gmock/gmock.h>

#include <array>
#include <cmath>
#include <vector>

namespace glocal::test::setup_check_test {
namespace {

constexpr Pose2 ahead{0.3, 0.0, 0.0};
constexpr Pose2 left{0.0, 0.0, radians(10.0)};
constexpr Pose2 right{0.0, 0.0, radians(-10.0)};
/// What the scans tell is never odometry's to the last bit.
constexpr Pose2 of_scans(const Pose2& motion) {
  return {motion.x + 0.001, motion.y, motion.theta};
}
/// Right turns, with ways of other lengths between them: it looks like itself at no other time.
constexpr std::array<int, 10> steps_to_turns = {1, 3, 1, 2, 4, 1, 1, 3, 2, 5};
std::vector<Pose2> drive_to_the_right() {
  std::vector<Pose2> motions;
  for (const int steps : steps_to_turns) {
    motions.insert(motions.end(), static_cast<std::size_t>(steps), ahead);
    motions.push_back(right);
  }
  return motions;
}

class Robot {
 public:
  explicit Robot(const SetupCheckParams& params = {}) : monitor_(params) { observe(); }

  /// Another scan after motions by odometry and by the scans.
  SetupCheck move(const Pose2& by_odometry, const Pose2& by_scans) {
    ++scan_;
    return move_without_scan(by_odometry, by_scans);
  }
  /// The last scan again.
  SetupCheck move_without_scan(const Pose2& by_odometry, const Pose2& by_scans) {
    odom_from_robot_ = odom_from_robot_ * by_odometry;
    local_.local_from_robot = seen_from_above(local_.local_from_robot) * by_scans;
    return observe();
  }

 private:
  SetupCheck observe() {
    Observation observation;
    observation.odom_from_robot = odom_from_robot_;
    for (int i = 0; i < 20; ++i)
      observation.scan.hits.push_back({static_cast<float>(i), static_cast<float>(scan_), 0.0F});
    return monitor_.update(observation, local_);
  }

  SetupMonitor monitor_;
  Pose2 odom_from_robot_;
  LocalMap local_;
  int scan_ = 0;
};

TEST(SetupCheck, AgreementOfGoodRobotsGrows) {
  Robot robot;
  EXPECT_DOUBLE_EQ(robot.move(ahead, of_scans(ahead)).agreement, 0.5);
  const SetupCheck check = robot.move(left, of_scans(left));
  EXPECT_DOUBLE_EQ(check.agreement, 2.0);
  EXPECT_DOUBLE_EQ(check.way_m, 0.3);
  EXPECT_FALSE(check.is_in_doubt);
  EXPECT_EQ(check.fault, std::nullopt);
  EXPECT_EQ(check.why(), "");
}

TEST(SetupCheck, WaitsForTheAgreementThatIsAskedFor) {
  Robot robot({.min_agreement = 1.0});
  EXPECT_TRUE(robot.move(ahead, of_scans(ahead)).is_in_doubt);
  EXPECT_FALSE(robot.move(ahead, of_scans(ahead)).is_in_doubt);
}

TEST(SetupCheck, WaitsForAWayButNotForEver) {
  Robot robot;
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(robot.move(left, of_scans(left)).is_in_doubt);
  EXPECT_FALSE(robot.move(left, of_scans(left)).is_in_doubt);
}

TEST(SetupCheck, SensorUpsideDownTurnsTheOtherWay) {
  Robot robot;
  static_cast<void>(robot.move(ahead, of_scans(ahead)));
  // Each turn differs by 20 degrees: one is a doubt, three are a fault.
  const SetupCheck doubt = robot.move(left, of_scans(right));
  EXPECT_TRUE(doubt.is_in_doubt);
  EXPECT_EQ(doubt.fault, std::nullopt);
  static_cast<void>(robot.move(left, of_scans(right)));
  const SetupCheck check = robot.move(right, of_scans(left));
  EXPECT_EQ(check.fault, SetupFault::upside_down);
  EXPECT_THAT(check.why(), testing::HasSubstr("upside down"));
}

TEST(SetupCheck, AboutHalfATurnLeftAndRightAreTheSame) {
  Robot robot;
  const SetupCheck check = robot.move({0.3, 0.0, radians(178.0)}, {0.3, 0.0, radians(-178.0)});
  EXPECT_EQ(check.fault, std::nullopt) << "they differ by 4 degrees";
  EXPECT_FALSE(check.is_in_doubt);
  EXPECT_DOUBLE_EQ(check.agreement, 1.5);
}

TEST(SetupCheck, SensorThatLooksTooFarToTheLeftMovesToTheRight) {
  Robot robot;
  const Pose2 aside{0.3 * std::cos(radians(15.0)), -0.3 * std::sin(radians(15.0)), 0.0};
  EXPECT_TRUE(robot.move(ahead, aside).is_in_doubt);
  static_cast<void>(robot.move(ahead, aside));
  static_cast<void>(robot.move(ahead, aside));
  const SetupCheck check = robot.move(ahead, aside);
  EXPECT_NEAR(check.mount_angle_deg.value_or(0.0), 15.0, 1e-9);
  EXPECT_NEAR(check.mount_angle_sd_deg, 1.25, 1e-9);  // 2.5 degrees by the root of 4.
  EXPECT_EQ(check.fault, SetupFault::mount_angle);
  EXPECT_THAT(check.why(), testing::HasSubstr("15 deg too far to the left"));
}

TEST(SetupCheck, ScanThatComesAgainIsAFaultOnceItCameThrice) {
  Robot robot;
  EXPECT_TRUE(robot.move_without_scan(ahead, {}).is_in_doubt);
  EXPECT_EQ(robot.move_without_scan(ahead, {}).fault, std::nullopt);
  EXPECT_EQ(robot.move_without_scan(ahead, {}).fault, SetupFault::repeated_scans);
}

TEST(SetupCheck, RobotThatHoldsStillSeesTheSame) {
  Robot robot;
  SetupCheck check;
  for (int i = 0; i < 10; ++i) check = robot.move_without_scan({0.01, 0.0, 0.0}, {});
  EXPECT_EQ(check.fault, std::nullopt);
  EXPECT_FALSE(check.is_in_doubt);
}

/// What a robot in a corridor 4 m wide sees, which turns by `turn_deg` and whose ranges are `bias` m too
/// long; the first beams always read 1.5 m.
Observation in_a_corridor(double x, double turn_deg, double bias, int stuck) {
  Observation observation;
  observation.odom_from_robot = Pose2{x, 0.0, radians(turn_deg)};
  for (int i = 0; i < 180; ++i) {
    const double angle = radians(2.0 * i + 0.9), along = angle + radians(turn_deg);
    const double range = i < stuck ? 1.5 : std::min(2.0 / std::abs(std::sin(along)), 15.0) + bias;
    observation.scan.hits.push_back(
        {static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)), 0.0F});
  }
  return observation;
}

/// After a drive through it with some turns.
SetupCheck after_a_corridor(double bias, int stuck) {
  SetupMonitor monitor({});
  SetupCheck check;
  LocalMap local;
  for (int i = 0; i < 6; ++i) {
    const Observation observation = in_a_corridor(0.3 * i, 10.0 * i, bias, stuck);
    local.local_from_robot = seen_from_above(observation.odom_from_robot) * of_scans({});
    check = monitor.update(observation, local);
  }
  return check;
}

TEST(SetupCheck, RangesThatAreAllTooLongBendWalls) {
  EXPECT_EQ(after_a_corridor(0.0, 0).fault, std::nullopt);
  const SetupCheck check = after_a_corridor(0.6, 0);
  EXPECT_NEAR(check.range_bias_m.value_or(0.0), 0.6, 0.02);
  EXPECT_GE(check.walls, 12U);
  EXPECT_EQ(check.fault, SetupFault::biased_ranges);
  EXPECT_THAT(check.why(), testing::HasSubstr("0.6 m too long"));
  EXPECT_THAT(after_a_corridor(-0.6, 0).why(), testing::HasSubstr("0.6 m too short"));
}

TEST(SetupCheck, ASmallerBiasIsADoubt) {
  const SetupCheck check = after_a_corridor(0.2, 0);
  EXPECT_EQ(check.fault, std::nullopt);
  EXPECT_TRUE(check.is_in_doubt);
  EXPECT_FALSE(after_a_corridor(0.1, 0).is_in_doubt) << "good sensors have as much";
}

TEST(SetupCheck, ADoubtOfFewWallsPasses) {
  SetupMonitor monitor({});
  LocalMap local;
  // One wall, 2 m ahead and seen under 70 degrees, whose ranges are 0.5 m too long; then nothing more.
  Observation observation;
  for (int i = -35; i <= 35; ++i) {
    const double angle = radians(i), range = 2.0 / std::cos(angle) + 0.5;
    observation.scan.hits.push_back(
        {static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)), 0.0F});
  }
  SetupCheck check = monitor.update(observation, local);
  ASSERT_GT(check.walls, 0U);
  ASSERT_LT(check.walls, 8U);
  observation.scan.hits = {};
  for (int i = 1; i <= 13; ++i) {
    observation.odom_from_robot = observation.odom_from_robot * Pose3(ahead);
    local.local_from_robot = seen_from_above(local.local_from_robot) * of_scans(ahead);
    check = monitor.update(observation, local);
    EXPECT_EQ(check.is_in_doubt, i <= 12) << i;
  }
}

TEST(SetupCheck, WallsCountOnceWhereTheRobotStands) {
  SetupMonitor monitor({});
  const std::size_t walls = monitor.update(in_a_corridor(0.0, 0.0, 0.0, 0), {}).walls;
  EXPECT_GT(walls, 0U);
  EXPECT_EQ(monitor.update(in_a_corridor(0.2, 0.0, 0.0, 0), {}).walls, walls);
  EXPECT_GT(monitor.update(in_a_corridor(0.3, 0.0, 0.0, 0), {}).walls, walls);
}

TEST(SetupCheck, RangesThatNeverChangeAreAFaultOnceTheyAreMany) {
  EXPECT_EQ(after_a_corridor(0.0, 30).fault, std::nullopt) << "a sixth: parts of the robot";
  const SetupCheck check = after_a_corridor(0.0, 60);
  EXPECT_NEAR(check.stuck_share, 1.0 / 3.0, 1e-9);
  EXPECT_EQ(check.fault, SetupFault::stuck_ranges);
  EXPECT_THAT(check.why(), testing::HasSubstr("33 % of the ranges"));
}

TEST(SetupCheck, LateScansTellWhatOdometryToldBefore) {
  Robot robot;
  SetupCheck check;
  constexpr std::size_t late_by = 3;
  const std::vector<Pose2> motions = drive_to_the_right();
  for (std::size_t i = 0; i + late_by < motions.size(); ++i)
    check = robot.move(motions[i + late_by], of_scans(motions[i]));
  EXPECT_EQ(check.fault, SetupFault::late_scans);
  EXPECT_EQ(check.late_by, late_by);
  EXPECT_THAT(check.why(), testing::HasSubstr("3 observations before"));
}

TEST(SetupCheck, WheelsThatSpinAndOdometryThatStandsAreNoMatterOfTheSetUp) {
  Robot robot;
  SetupCheck check = robot.move(ahead, of_scans(ahead));
  for (int i = 0; i < 20; ++i) check = robot.move({0.6, 0.0, radians(20.0)}, {0.3, 0.0, radians(10.0)});
  EXPECT_DOUBLE_EQ(check.agreement, 0.5);
  for (int i = 0; i < 20; ++i) check = robot.move({}, left);
  EXPECT_DOUBLE_EQ(check.agreement, 0.5);
  EXPECT_FALSE(check.is_in_doubt);
}

TEST(SetupCheck, ScansThatDoNotFitSayNothing) {
  // The local map moves the robot by odometry then.
  Robot robot;
  SetupCheck check;
  for (int i = 0; i < 5; ++i) check = robot.move(ahead, ahead);
  EXPECT_DOUBLE_EQ(check.agreement, 0.0);
  EXPECT_DOUBLE_EQ(check.way_m, 0.0);
  EXPECT_EQ(check.mount_angle_deg, std::nullopt);
}

}  // namespace
}  // namespace glocal::test::setup_check_test
