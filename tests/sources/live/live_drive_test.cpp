#include "sources/live/live_drive.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>

#include "files.hpp"
#include "sources/bags/bag_drive.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/live/fake_link.hpp"
#include "sources/live/recording_link.hpp"

namespace glocal::test::live::live_drive_test {
namespace {

using glocal::bags::BagDrive;
using glocal::live::LiveDrive;
using glocal::live::LiveTopics;
using glocal::live::RecordingLink;
using testing::ElementsAre;
using testing::HasSubstr;

constexpr std::int64_t ms = 1'000'000;
constexpr std::int64_t second = 1000 * ms;

/// 20 rays, 10 ms from one to the next.
bags::ScanFields scan_fields(float range) {
  return {.angle_min = -0.5F,
          .angle_increment = 0.05F,
          .time_increment = 0.01F,
          .ranges = std::vector<float>(20, range)};
}

bool are_equal(const Points& a, const Points& b) {
  return a.x == b.x && a.y == b.y && a.z == b.z;
}

TEST(LiveDrive, DeliversWhatARecordingOfTheSameMessagesDoes) {
  bags::RobotRecording recording;
  recording.transform("base_link", "laser", 0, Pose2{0.2, 0.1, 0.3}, "/tf_static");
  for (int i = 0; i <= 200; ++i) {
    const double t = 0.05 * i;
    // It stands still for 2 s, then drives and turns; odometry is silent for 1 s.
    const double way = std::max(0.0, t - 2.0);
    if (t < 5.0 || t > 6.0)
      recording.transform("odom", "base_link", 50 * ms * i, Pose2{0.7 * way, 0.1 * way, 0.2 * way});
    if (i % 3 == 0)
      recording.scan("/scan", 50 * ms * i + 7 * ms, scan_fields(2.0F + 0.01F * static_cast<float>(i)));
    // Stamps that are off.
    if (i == 90) recording.scan("/scan", 30 * ms, scan_fields(9.0F), 50 * ms * i + 8 * ms);
    if (i == 150) recording.scan("/scan", 1000 * second, scan_fields(9.0F), 50 * ms * i + 8 * ms);
  }
  TemporaryFolder folder;
  const FilePath path = file_path(folder.write("drive.mcap", recording.bytes()));
  BagDrive::Params params;
  params.path = path;
  BagDrive bag(params, {});
  LiveDrive live(
      LiveTopics{}, {}, std::make_shared<RecordingLink>(RecordingLink::Params{path}, SourceSetup{}),
      [](const LiveMessage&) {}, [] { return false; });
  std::size_t n = 0;
  while (const auto expected = bag.next()) {
    const auto got = live.next();
    ASSERT_TRUE(got) << n;
    EXPECT_EQ(got->observation.stamp, expected->observation.stamp) << n;
    EXPECT_EQ(got->observation.odom_from_robot, expected->observation.odom_from_robot) << n;
    EXPECT_EQ(got->segment, expected->segment) << n;
    EXPECT_TRUE(are_equal(got->observation.scan.hits, expected->observation.scan.hits)) << n;
    EXPECT_EQ(got->observation.scan.origin.x, expected->observation.scan.origin.x) << n;
    ++n;
  }
  EXPECT_GT(n, 10U);
  EXPECT_FALSE(live.next());
  EXPECT_FALSE(live.next());
  EXPECT_EQ(live.passed_over(), 0U);
}

class Live : public testing::Test {
 protected:
  using Writer = bags::Writer;

  static std::string transform(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
                               const Pose3& pose) {
    return Writer("cdr").number<std::uint32_t>(1).header(parent, stamp_ns).text(child).pose(pose).bytes();
  }
  static std::string scan_bytes(std::int64_t stamp_ns, const std::string& frame = "base_link") {
    Writer w("cdr");
    w.header(frame, stamp_ns);
    for (const float v : {0.0F, 0.1F, 0.1F, 0.0F, 0.1F, 0.0F, 30.0F}) w.number(v);
    return w.number<std::uint32_t>(2).number(1.0F).number(2.0F).number<std::uint32_t>(0).bytes();
  }
  void scan(std::int64_t stamp_ns, const std::string& frame = "base_link") {
    link_->put(scan_, stamp_ns, scan_bytes(stamp_ns, frame));
  }
  /// As far along x as its stamp says, 1 m/s.
  void odometry(std::int64_t stamp_ns) {
    const double x = static_cast<double>(stamp_ns) / static_cast<double>(second);
    link_->put(tf_, stamp_ns, transform("odom", "base_link", stamp_ns, Pose2{x, 0.0, 0.0}));
  }
  LiveDrive& drive() {
    if (!drive_)
      drive_.emplace(
          topics_, SourceSetup{.warn = [&](const std::string& text) { warnings_.push_back(text); }}, link_,
          [&](const LiveMessage& other) { others_.push_back(other.topic.name); },
          [&] { return meanwhile_(); });
    return *drive_;
  }
  std::string fault() {
    return config_error("no folder", [&] { static_cast<void>(drive().next()); });
  }

  LiveTopic scan_{"/scan", "sensor_msgs/LaserScan"}, tf_{"/tf", "tf2_msgs/TFMessage"};
  std::shared_ptr<FakeLink> link_ = std::make_shared<FakeLink>();
  LiveTopics topics_{.scans = "/scan", .longest_wait = 0.05};
  std::vector<std::string> warnings_, others_;
  LiveDrive::Meanwhile meanwhile_ = [] { return false; };
  std::optional<LiveDrive> drive_;
};

TEST_F(Live, WaitsUntilItIsKnownWhereTheRobotWas) {
  odometry(0);
  scan(100 * ms);
  link_->end();
  EXPECT_FALSE(drive().next());
  odometry(200 * ms);
  const auto sample = drive().next();
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->observation.odom_from_robot.x, 0.1, 1e-9);
  EXPECT_EQ(sample->observation.scan.hits.size(), 2U);
}

TEST_F(Live, WorksWhileNoMessageComesAndNoLonger) {
  link_->announce(scan_);
  odometry(0);
  int pieces = 0;
  meanwhile_ = [&] {
    if (++pieces == 3) {
      odometry(200 * ms);
      scan(100 * ms);
    }
    if (pieces == 1000) link_->end();
    return true;
  };
  EXPECT_TRUE(drive().next());
  EXPECT_EQ(pieces, 3);
  for (const std::int64_t stamp : {300 * ms, 400 * ms, 500 * ms, 600 * ms}) odometry(stamp);
  scan(500 * ms);
  EXPECT_TRUE(drive().next());
  EXPECT_EQ(pieces, 3) << "though there was a message";
}

TEST_F(Live, OfSeveralObservationsTheNewestWins) {
  for (int i = 0; i <= 20; ++i) odometry(100 * ms * i);
  for (const std::int64_t stamp : {100 * ms, 600 * ms, 650 * ms, 1100 * ms}) scan(stamp);
  const auto sample = drive().next();
  ASSERT_TRUE(sample);
  EXPECT_DOUBLE_EQ(sample->observation.stamp, 1.1);
  EXPECT_EQ(drive().passed_over(), 2U) << "the robot had not moved on at 0.65 s";
}

TEST_F(Live, ARobotThatStandsStillIsLookedAtOnce) {
  for (int i = 0; i < 10; ++i)
    link_->put(tf_, 100 * ms * i, transform("odom", "base_link", 100 * ms * i, Pose2{1.0, 2.0, 0.0}));
  scan(50 * ms);
  EXPECT_TRUE(drive().next());
  scan(150 * ms);
  scan(250 * ms);
  link_->end();
  EXPECT_FALSE(drive().next());
  EXPECT_EQ(drive().passed_over(), 0U);
}

TEST_F(Live, LooksAnewAtARobotThatStandsStill) {
  for (int i = 0; i < 10; ++i)
    link_->put(tf_, 100 * ms * i, transform("odom", "base_link", 100 * ms * i, Pose2{1.0, 2.0, 0.0}));
  scan(50 * ms);
  EXPECT_TRUE(drive().next());
  drive().look_anew();
  scan(150 * ms);
  EXPECT_TRUE(drive().next());
  scan(250 * ms);
  link_->end();
  EXPECT_FALSE(drive().next());
}

TEST_F(Live, TellsHowFarOdometryHasCome) {
  EXPECT_FALSE(drive().odometry_ns());
  odometry(0);
  scan(50 * ms);
  odometry(100 * ms);
  link_->put(tf_, 300 * ms, transform("base_link", "arm", 300 * ms, {}));
  EXPECT_TRUE(drive().next());
  EXPECT_EQ(drive().odometry_ns(), 100 * ms);
  link_->end();
  odometry(200 * ms);
  EXPECT_FALSE(drive().next());
  EXPECT_EQ(drive().odometry_ns(), 200 * ms);
  odometry(5 * second);
  EXPECT_FALSE(drive().next());
  EXPECT_FALSE(drive().odometry_ns()) << "no scan comes any more";
}

TEST_F(Live, ForgetsWhereTheRobotWasThoughNoScanComes) {
  for (const std::int64_t stamp : {0 * ms, 200 * ms}) odometry(stamp);
  scan(100 * ms);
  EXPECT_TRUE(drive().next());
  for (int i = 1; i <= 500; ++i) odometry(400 * ms * i);
  link_->end();
  EXPECT_FALSE(drive().next());
  scan(50 * second);
  EXPECT_FALSE(drive().next()) << "150 s ago";
  scan(190 * second);
  EXPECT_TRUE(drive().next());
}

TEST_F(Live, AClockThatJumpsBackBeginsADriveOfItsOwnOnTheSameRobot) {
  const Pose3 mount = Pose2{0.5, 0.0, 0.0};
  const LiveTopic tf_static{"/tf_static", "tf2_msgs/TFMessage"};
  link_->put(tf_static, 0, transform("base_link", "laser", 0, mount));
  for (int i = 0; i < 200; ++i)
    link_->put(tf_static, 0, transform("base_link", "camera", i * 10 * ms, Pose2{0.1, 0.0, 0.0}));
  for (int i = 50; i <= 52; ++i) odometry(i * second / 10);
  scan(5 * second + 100 * ms, "laser");
  const auto before = drive().next();
  ASSERT_TRUE(before);
  for (const std::int64_t stamp : {50 * ms, 100 * ms}) scan(stamp, "laser");
  for (int i = 0; i <= 2; ++i) odometry(i * second / 10);
  link_->end();
  const auto after = drive().next();
  ASSERT_TRUE(after);
  EXPECT_NE(after->segment, before->segment);
  EXPECT_NEAR(after->observation.odom_from_robot.x, 0.1, 1e-9);
  EXPECT_NEAR(after->observation.scan.origin.x, 0.5, 1e-6);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("runs backwards"), HasSubstr("jump back by 5.0 s")));
}

TEST_F(Live, AStampThatIsOffCostsItsScanAlone) {
  for (int i = 50; i <= 70; ++i) odometry(i * second / 10);
  scan(5 * second);
  ASSERT_TRUE(drive().next());
  const std::map<std::int64_t, double> right_by_wrong = {
      {0 * second, 5.5}, {30 * second, 5.9}, {1000 * second, 6.3}};
  for (const auto& [wrong, right] : right_by_wrong) {
    scan(wrong);
    scan(static_cast<std::int64_t>(right * 1e9));
    link_->end();
    const auto sample = drive().next();
    ASSERT_TRUE(sample) << wrong;
    EXPECT_DOUBLE_EQ(sample->observation.stamp, right);
    EXPECT_EQ(sample->segment, 0);
  }
}

TEST_F(Live, AfterAPauseADriveOfItsOwnBegins) {
  for (const std::int64_t stamp : {5 * second, 66 * second}) {
    odometry(stamp);
    scan(stamp);
    link_->end();
    const auto sample = drive().next();
    ASSERT_TRUE(sample) << stamp;
    EXPECT_EQ(sample->segment, stamp == 5 * second ? 0 : 1);
  }
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("jump by 61 s")));
}

TEST_F(Live, OdometryMayBeATopic) {
  topics_.odometry = "/wheels";
  const LiveTopic wheels{"/wheels", "nav_msgs/Odometry"};
  for (int i = 0; i < 3; ++i)
    link_->put(
        wheels, 100 * ms * i,
        Writer("cdr").header("start", 100 * ms * i).text("base_link").pose(Pose2{2.0, 0.0, 0.0}).bytes());
  scan(100 * ms);
  const auto sample = drive().next();
  ASSERT_TRUE(sample);
  EXPECT_NEAR(sample->observation.odom_from_robot.x, 2.0, 1e-9);
}

TEST_F(Live, ANamespaceChoosesTheRobot) {
  topics_.scans = "";
  topics_.name_space = "/b";
  for (const char* robot : {"/a", "/b"}) {
    const double x = std::string(robot) == "/a" ? 1.0 : 2.0;
    for (int i = 0; i < 3; ++i)
      link_->put({std::string(robot) + "/tf", tf_.type}, 100 * ms * i,
                 transform("odom", "base_link", 100 * ms * i, Pose2{x, 0.0, 0.0}));
    link_->put({std::string(robot) + "/scan", scan_.type}, 100 * ms, scan_bytes(100 * ms));
  }
  topics_.longest_wait = 10.0;
  const auto sample = drive().next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->observation.odom_from_robot.x, 2.0);
}

TEST_F(Live, MessagesOfOthersAreHandedOn) {
  link_->put({"/glocal/begin", "std_msgs/Empty"}, 0, "");
  link_->subscribe({"/glocal/begin", "std_msgs/Empty"}, Delivery::reliable);
  link_->end();
  EXPECT_FALSE(drive().next());
  EXPECT_THAT(others_, ElementsAre("/glocal/begin"));
}

TEST_F(Live, DamagedMessagesAreToldOnceAndPassedOver) {
  for (int i = 0; i < 3; ++i) odometry(100 * ms * i);
  // What they lack differs.
  for (const int size : {50, 51, 60})
    link_->put(scan_, 0, scan_bytes((50 + size) * ms).substr(0, static_cast<std::size_t>(size)));
  link_->put(tf_, 0, "rubbish");
  scan(150 * ms);
  const auto sample = drive().next();
  ASSERT_TRUE(sample);
  EXPECT_DOUBLE_EQ(sample->observation.stamp, 0.15);
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("of /scan is left out"), HasSubstr("of /tf is left out")));
}

TEST_F(Live, TellsThatThereIsNoTopic) {
  link_->announce({"/front", scan_.type});
  link_->announce({"/map", "nav_msgs/OccupancyGrid"});
  EXPECT_THAT(fault(),
              HasSubstr("no observation within 0.05 s: there is no topic /scan; there are /front, /map"));
}

TEST_F(Live, TellsThatThereAreSeveralTopics) {
  topics_ = {.longest_wait = 5.0};
  link_->announce({"/front", scan_.type});
  link_->announce({"/rear", scan_.type});
  EXPECT_THAT(fault(), HasSubstr("set scans to one of /front, /rear"));
}

TEST_F(Live, TellsThatNothingCame) {
  link_->announce(scan_);
  EXPECT_THAT(fault(), HasSubstr("no message came on /scan"));
}

TEST_F(Live, TellsThatNobodySaysWhereTheRobotIs) {
  scan(100 * ms);
  EXPECT_THAT(fault(),
              HasSubstr("has no odometry: tf does not connect odom with base_footprint or base_link"));
}

TEST_F(Live, TellsThatNobodySaysWhereTheSensorIs) {
  for (int i = 0; i < 3; ++i) odometry(100 * ms * i);
  scan(100 * ms, "laser");
  EXPECT_THAT(fault(), HasSubstr("tf does not connect laser, the frame of /scan, with base_link"));
}

TEST_F(Live, TellsThatClocksDisagree) {
  for (int i = 0; i < 3; ++i) odometry(100 * ms * i);
  scan(70 * second);
  EXPECT_THAT(fault(), HasSubstr("do both clocks agree?"));
}

TEST_F(Live, CloudsInThePlaneNeedHeights) {
  link_->announce({"/scan", "sensor_msgs/PointCloud2"});
  EXPECT_THAT(fault(), HasSubstr("set heights"));
}

TEST_F(Live, StopsWhenItIsToldTo) {
  LiveDrive drive(
      topics_, {.is_stopped = [] { return true; }}, link_, [](const LiveMessage&) {}, [] { return false; });
  EXPECT_FALSE(drive.next());
}

TEST_F(Live, StopsThoughMessagesAlwaysWait) {
  const LiveTopic begin{"/glocal/begin", "std_msgs/Empty"};
  int taken = 0;
  LiveDrive drive(
      topics_, {.is_stopped = [&] { return taken >= 10; }}, link_,
      [&](const LiveMessage&) {
        if (++taken < 1000) link_->put(begin, 0, "");
      },
      [] { return false; });
  link_->subscribe(begin, Delivery::reliable);
  link_->put(begin, 0, "");
  EXPECT_FALSE(drive.next());
  EXPECT_EQ(taken, 10);
}

TEST_F(Live, StopsThoughThereIsAlwaysAnObservation) {
  bool is_stopped = false;
  LiveDrive drive(
      topics_, {.is_stopped = [&] { return is_stopped; }}, link_, [](const LiveMessage&) {},
      [] { return false; });
  for (const std::int64_t stamp : {1 * second, 2 * second}) {
    odometry(stamp);
    scan(stamp);
    EXPECT_EQ(drive.next().has_value(), !is_stopped);
    is_stopped = true;
  }
}

}  // namespace
}  // namespace glocal::test::live::live_drive_test
