// Recordings in place of robots, and of them.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <chrono>
#include <csignal>
#include <random>

#include "files.hpp"
#include "sources/bags/message_writer.hpp"
#include "sources/bags/recordings.hpp"
#include "sources/live/fake_link.hpp"
#include "sources/live/live_recorder.hpp"
#include "sources/live/recording_link.hpp"
#include "sources/live/tapped_link.hpp"

namespace glocal::test::live::links_test {
namespace {

using glocal::live::LiveRecorder;
using glocal::live::RecordingLink;
using glocal::live::TappedLink;
using std::chrono::milliseconds;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const Warn ignore = [](const std::string&) {};

constexpr std::int64_t ms = 1'000'000;

const LiveTopic tf{"/tf", "tf2_msgs/TFMessage"};
const LiveTopic scan{"/scan", "sensor_msgs/LaserScan"};

class Links : public testing::Test {
 protected:
  [[nodiscard]] std::string written() const {
    bags::RobotRecording recording;
    recording.transform("odom", "base_link", 0, Pose2{1.0, 0.0, 0.0});
    recording.scan("/scan", 20 * ms, {.ranges = {1.0F}});
    recording.transform("odom", "base_link", 40 * ms, Pose2{2.0, 0.0, 0.0});
    return folder_.write("drive.mcap", recording.bytes());
  }
  static std::vector<std::string> all_of(MessageLink& link) {
    std::vector<std::string> topics;
    while (const auto message = link.next(milliseconds(0))) topics.push_back(message->topic.name);
    return topics;
  }

  TemporaryFolder folder_;
};

TEST_F(Links, GiveTheTopicsThatAreAskedForInOrder) {
  RecordingLink link({file_path(written())}, {});
  EXPECT_THAT(link.topics(), ElementsAre(scan, tf));
  link.subscribe(tf, Delivery::reliable);
  EXPECT_FALSE(link.is_live());
  EXPECT_THAT(all_of(link), ElementsAre("/tf", "/tf"));
  EXPECT_TRUE(link.has_ended());
}

TEST_F(Links, MessagesOfRos1AreToldAsRos2NamesThem) {
  const std::string transforms = bags::Writer("ros1").number<std::uint32_t>(0).bytes();
  folder_.write("old.bag", bags::ros1_magic + bags::ros1_bag_header() +
                               bags::ros1_chunk(bags::ros1_connection(0, "/tf", "tf/tfMessage") +
                                                bags::ros1_message(0, 1, transforms) +
                                                bags::ros1_message(0, 2, transforms.substr(0, 2)) +
                                                bags::ros1_message(0, 3, transforms)));
  std::vector<std::string> warnings;
  RecordingLink link({file_path((folder_.path() / "old.bag").string())},
                     {.warn = [&](const std::string& text) { warnings.push_back(text); }});
  EXPECT_THAT(link.topics(), ElementsAre(tf));
  link.subscribe(tf, Delivery::reliable);
  EXPECT_THAT(all_of(link), ElementsAre("/tf", "/tf")) << "a damaged message does not end the drive";
  EXPECT_THAT(warnings, ElementsAre(HasSubstr("a message of /tf is left out")));
}

TEST_F(Links, InRealTimeMessagesComeWhenTheyCameToTheRecorder) {
  RecordingLink link({file_path(written()), true}, {});
  link.subscribe(tf, Delivery::reliable);
  EXPECT_TRUE(link.is_live());
  const auto begun = std::chrono::steady_clock::now();
  EXPECT_TRUE(link.next(milliseconds(0)));
  EXPECT_FALSE(link.next(milliseconds(0))) << "40 ms later";
  EXPECT_FALSE(link.has_ended());
  EXPECT_TRUE(link.next(milliseconds(10'000)));
  EXPECT_GE(std::chrono::steady_clock::now() - begun, milliseconds(40));
}

TEST_F(Links, WhatComesAndWhatIsToldIsWrittenDown) {
  const std::string file = (folder_.path() / "live.mcap").string();
  {
    const auto robot = std::make_shared<FakeLink>();
    robot->put(tf, 10 * ms, bags::Writer("cdr").number<std::uint32_t>(0).bytes());
    robot->put(scan, 5 * ms, "a scan that was received before");
    LiveRecorder recorder(file, ignore);
    TappedLink link(robot, [&](const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes) {
      recorder.write(topic, stamp_ns, bytes);
    });
    link.subscribe(tf, Delivery::reliable);
    link.subscribe(scan, Delivery::newest);
    EXPECT_THAT(all_of(link), ElementsAre("/tf", "/scan"));
    link.publish({"/initialpose", "geometry_msgs/PoseWithCovarianceStamped"}, Delivery::reliable, "a pose");
    EXPECT_EQ(robot->published.size(), 1U);
  }
  RecordingLink again({file_path(file)}, {});
  for (const LiveTopic& topic : again.topics()) again.subscribe(topic, Delivery::reliable);
  EXPECT_THAT(all_of(again), ElementsAre("/tf", "/scan", "/initialpose"))
      << "in the order in which they were taken";
  EXPECT_THAT(config_error(folder_.path(), [&] { LiveRecorder again_there(file, ignore); }),
              HasSubstr("live.mcap: error: is there already"));
  EXPECT_THAT(
      config_error(folder_.path(), [&] { LiveRecorder nowhere(folder_.path() / "no" / "f.mcap", ignore); }),
      HasSubstr("cannot be written"));
}

TEST_F(Links, ARecordingThatCannotBeWrittenAnyFurtherIsToldOnce) {
  // As on a full disk: a chunk is too long a file. SIGXFSZ would end the process.
  const auto handled = std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit little{.rlim_cur = 1000, .rlim_max = before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &little);
  std::vector<std::string> warnings;
  {
    LiveRecorder recorder(folder_.path() / "live.mcap",
                          [&](const std::string& text) { warnings.push_back(text); });
    std::mt19937 random(1);
    std::string noise(20'000, ' ');
    for (char& c : noise) c = static_cast<char>(random());
    for (int i = 0; i < 3; ++i) recorder.write(scan, i * ms, noise);
    EXPECT_THAT(warnings, IsEmpty()) << "what is written by chunks is missed at the end";
  }
  setrlimit(RLIMIT_FSIZE, &before);
  std::signal(SIGXFSZ, handled);
  EXPECT_THAT(warnings,
              ElementsAre(HasSubstr("live.mcap: cannot be written any further; the recording is not whole")));
}

TEST_F(Links, WhatIsKeptBackReachesTheTapAlone) {
  const auto robot = std::make_shared<FakeLink>();
  robot->put(scan, 5 * ms, "a scan");
  std::vector<std::string> tapped;
  TappedLink link(robot,
                  [&](const LiveTopic& topic, std::int64_t stamp_ns, std::string_view bytes) {
                    tapped.push_back(fmt::format("{} {} {}", topic.name, stamp_ns / ms, bytes));
                  },
                  {"/tf"});
  link.subscribe(scan, Delivery::newest);
  all_of(link);
  for (const LiveTopic& topic : {tf, scan}) link.advertise(topic, Delivery::reliable);
  EXPECT_THAT(robot->advertised, ElementsAre(scan.name));
  link.publish(tf, Delivery::reliable, "map to odom");
  link.publish(scan, Delivery::newest, "told");
  EXPECT_THAT(tapped, ElementsAre("/scan 5 a scan", "/tf 5 map to odom", "/scan 5 told"));
  ASSERT_EQ(robot->published.size(), 1U);
  EXPECT_EQ(robot->published[0].topic, scan);
}

}  // namespace
}  // namespace glocal::test::live::links_test
