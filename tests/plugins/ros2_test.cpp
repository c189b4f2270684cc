// plugins/ros2 against a robot whose DDS is another one.
#include <gmock/gmock.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "fast_dds_robot.hpp"
#include "files.hpp"
#include "glocal/yaml.hpp"
#include "loading/plugin_loader.hpp"
#include "sources/bags/message_writer.hpp"

namespace glocal::test::ros2_test {
namespace {

using bags::Writer;
using std::chrono::milliseconds;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const LiveTopic scan{"/scan", "sensor_msgs/LaserScan"};
const LiveTopic map{"/map", "nav_msgs/OccupancyGrid"};
const LiveTopic tf{"/tf", "tf2_msgs/TFMessage"};
const LiveTopic odom{"/odom", "nav_msgs/Odometry"};
constexpr const char* dds_map = "nav_msgs::msg::dds_::OccupancyGrid_";

/// With a range of its own.
std::string scan_message(float range, std::endian order = std::endian::little) {
  Writer w("cdr", order);
  w.header("laser");
  for (const float v : {-1.0F, 1.0F, 0.5F, 0.0F, 0.1F, 0.1F, 30.0F}) w.number(v);
  w.number<std::uint32_t>(3).number(range).number(2.0F).number(3.0F);
  return w.number<std::uint32_t>(0).bytes();
}

std::string map_message(std::size_t cells) {
  Writer w("cdr");
  w.header("map").number<std::uint32_t>(1).number<std::uint32_t>(2).number(0.05F);
  w.number(static_cast<std::uint32_t>(cells)).number<std::uint32_t>(1).pose();
  return w.raw(std::string(cells, '\x64')).bytes();
}

std::string tf_message(const std::string& child) {
  return Writer("cdr").number<std::uint32_t>(1).header("odom").text(child).pose().bytes();
}

/// Of the process, so that tests that run at the same time do not hear each other.
int own_domain() {
  return 1 + static_cast<int>(getpid()) % 100;
}

class Ros2 : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    // On this computer alone, which may know no multicast.
    setenv("CYCLONEDDS_URI",
           "<General><Interfaces><NetworkInterface name='lo'/></Interfaces><AllowMulticast>false"
           "</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex><Peers>"
           "<Peer address='127.0.0.1'/></Peers></Discovery>",
           1);
    unsetenv("ROS_DOMAIN_ID");
  }

  Ros2() { PluginLoader(catalog_).load(GLOCAL_ROS2_PLUGIN); }

  std::unique_ptr<MessageLink> link(const std::string& params) {
    StrategyChoice choice = catalog_.message_links.choose("ros2");
    read_yaml(folder_.write("params.yaml", params), *choice.params);
    SourceSetup setup;
    setup.warn = [this](const std::string& sentence) { warnings_.push_back(sentence); };
    return catalog_.message_links.make(choice, setup);
  }
  std::unique_ptr<MessageLink> link() { return link("domain: " + std::to_string(own_domain())); }

  /// Waits until both sides have found each other: they do at different times.
  static void meet(MessageLink& link, const LiveTopic& topic, Robot::Sender& sender, int receivers = 1) {
    ASSERT_TRUE(sender.has_receivers(receivers));
    const auto until = std::chrono::steady_clock::now() + long_enough;
    const auto is_known = [&] { return std::ranges::count(link.topics(), topic) > 0; };
    while (!is_known() && std::chrono::steady_clock::now() < until)
      std::this_thread::sleep_for(milliseconds(5));
    std::this_thread::sleep_for(milliseconds(20));
  }

  /// The next messages of a link, so many at most.
  static std::vector<std::string> next(MessageLink& link, std::size_t count, milliseconds longest) {
    std::vector<std::string> found;
    const auto until = std::chrono::steady_clock::now() + longest;
    while (found.size() < count && std::chrono::steady_clock::now() < until) {
      if (auto message = link.next(milliseconds(20))) found.push_back(std::move(message->bytes));
    }
    return found;
  }

  /// Listens until something has been told.
  void listen_until_told(MessageLink& link) {
    const auto until = std::chrono::steady_clock::now() + long_enough;
    while (warnings_.empty() && std::chrono::steady_clock::now() < until) {
      EXPECT_FALSE(link.next(milliseconds(20)));
    }
  }

  TemporaryFolder folder_;
  Catalog catalog_;
  std::vector<std::string> warnings_;
};

TEST_F(Ros2, AScanArrivesByteForByte) {
  const auto link = this->link();
  link->subscribe(scan, Delivery::newest);
  Robot robot(own_domain());
  for (const RobotQos& qos : {best_effort, reliable}) {
    const auto sender = robot.sender("rt/scan", dds_scan, qos);
    meet(*link, scan, *sender);
    sender->send(scan_message(1.5F));
    const std::optional<LiveMessage> message = link->next(long_enough);
    ASSERT_TRUE(message);
    EXPECT_EQ(message->topic, scan);
    EXPECT_EQ(message->bytes, scan_message(1.5F));
    const auto now = std::chrono::system_clock::now().time_since_epoch();
    const double age =
        std::chrono::duration<double>(now - std::chrono::nanoseconds(message->stamp_ns)).count();
    EXPECT_GE(age, 0.0);
    EXPECT_LT(age, 1.0);
  }
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(Ros2, ReliableMessagesOfSeveralTopicsComeAllAndInOrder) {
  const auto link = this->link();
  link->subscribe(tf, Delivery::reliable);
  link->subscribe(odom, Delivery::reliable);
  Robot robot(own_domain());
  const auto tfs = robot.sender("rt/tf", dds_tf, reliable);
  const auto odometry = robot.sender("rt/odom", "nav_msgs::msg::dds_::Odometry_", reliable);
  meet(*link, tf, *tfs);
  meet(*link, odom, *odometry);
  Writer pose("cdr");
  pose.header("odom").text("base_link").pose();
  for (int i = 0; i < 36 + 6 + 36; ++i) pose.number(0.5);
  std::vector<std::string> sent;
  for (int i = 0; i < 300; ++i) {
    sent.push_back(tf_message("wheel_" + std::to_string(i)));
    tfs->send(sent.back());
    if (i == 150) odometry->send(pose.bytes());
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  std::vector<std::string> received = next(*link, 301, long_enough);
  const auto odometry_at = std::find(received.begin(), received.end(), pose.bytes());
  ASSERT_NE(odometry_at, received.end());
  EXPECT_NEAR(static_cast<double>(odometry_at - received.begin()), 151.0, 100.0);
  received.erase(odometry_at);
  EXPECT_TRUE(received == sent) << received.size() << " came, of " << sent.size();
}

TEST_F(Ros2, OfScansTheNewestWait) {
  const auto link = this->link();
  link->subscribe(scan, Delivery::newest);
  Robot robot(own_domain());
  const auto sender = robot.sender("rt/scan", dds_scan, reliable);
  meet(*link, scan, *sender);
  for (int i = 0; i < 20; ++i) sender->send(scan_message(static_cast<float>(i)));
  std::this_thread::sleep_for(milliseconds(300));
  std::vector<std::string> expected;
  for (int i = 15; i < 20; ++i) expected.push_back(scan_message(static_cast<float>(i)));
  EXPECT_EQ(next(*link, 20, milliseconds(300)), expected);
}

TEST_F(Ros2, WhoComesLateHearsWhatIsKept) {
  Robot robot(own_domain());
  Robot camera(own_domain());
  const auto one = robot.sender("rt/tf_static", dds_tf, latched);
  const auto other = camera.sender("rt/tf_static", dds_tf, latched);
  const auto maps = robot.sender("rt/map", dds_map, latched);
  one->send(tf_message("laser"));
  other->send(tf_message("camera"));
  const std::string large = map_message(200'000);
  maps->send(map_message(3));
  maps->send(large);
  const auto link = this->link();
  link->subscribe({"/tf_static", "tf2_msgs/TFMessage"}, Delivery::kept);
  link->subscribe(map, Delivery::kept);
  const std::vector<std::string> received = next(*link, 3, long_enough);
  EXPECT_THAT(received, testing::UnorderedElementsAre(tf_message("laser"), tf_message("camera"), large));
}

TEST_F(Ros2, TheRobotHearsWhatIsPublished) {
  Robot robot(own_domain());
  const LiveTopic pose{"/initialpose", "geometry_msgs/PoseWithCovarianceStamped"};
  Writer w("cdr");
  w.header("map").pose();
  for (int i = 0; i < 36; ++i) w.number(0.25 * i);
  const auto poses = robot.receiver("rt/initialpose", dds_pose, reliable);
  const auto link = this->link();
  // The first ones go out before the robot has been found.
  std::optional<std::string> received;
  for (int i = 0; i < 40 && !received; ++i) {
    link->publish(pose, Delivery::reliable, w.bytes());
    received = poses->receive(milliseconds(100));
  }
  EXPECT_EQ(received, w.bytes());
  // What is kept need be sent once.
  const LiveTopic status{"/glocal/status", "std_msgs/String"};
  const std::string text = Writer("cdr").text("localized").bytes();
  link->publish(status, Delivery::kept, text);
  const auto late = robot.receiver("rt/glocal/status", "std_msgs::msg::dds_::String_", latched);
  // Messages travel in words of four bytes.
  EXPECT_EQ(late->receive(long_enough).value_or("").substr(0, text.size()), text);
}

TEST_F(Ros2, WhatIsAdvertisedIsFoundBeforeItsFirstMessage) {
  const auto one = this->link(), other = this->link();
  one->advertise(odom, Delivery::reliable);
  const auto until = std::chrono::steady_clock::now() + long_enough;
  while (other->topics().empty() && std::chrono::steady_clock::now() < until)
    std::this_thread::sleep_for(milliseconds(10));
  EXPECT_THAT(other->topics(), ElementsAre(odom));
}

TEST_F(Ros2, APublisherThatBeginsAnewIsHeardAgain) {
  const auto link = this->link();
  link->subscribe(scan, Delivery::newest);
  for (const float range : {1.0F, 2.0F}) {
    Robot robot(own_domain());
    const auto sender = robot.sender("rt/scan", dds_scan, best_effort);
    meet(*link, scan, *sender);
    sender->send(scan_message(range));
    EXPECT_THAT(next(*link, 1, long_enough), ElementsAre(scan_message(range)));
  }
}

TEST_F(Ros2, ASenderThatIsNotReliableIsTold) {
  const auto link = this->link();
  link->subscribe(scan, Delivery::reliable);
  link->subscribe(map, Delivery::kept);
  Robot robot(own_domain());
  Robot second(own_domain());
  const auto scans = robot.sender("rt/scan", dds_scan, best_effort);
  const auto again = second.sender("rt/scan", dds_scan, best_effort);
  listen_until_told(*link);
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("/scan"), HasSubstr("reliability"))));
  warnings_.clear();
  const auto maps = robot.sender("rt/map", dds_map, reliable);
  listen_until_told(*link);
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("/map"), HasSubstr("durability"))));
}

TEST_F(Ros2, AReceiverThatAsksForMoreIsTold) {
  Robot robot(own_domain());
  const auto receiver = robot.receiver("rt/scan", dds_scan, reliable);
  const auto link = this->link();
  link->publish(scan, Delivery::newest, scan_message(1.0F));
  listen_until_told(*link);
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("a receiver of /scan"), HasSubstr("reliability"))));
}

TEST_F(Ros2, ASenderOfAnotherTypeIsTold) {
  const auto link = this->link();
  link->subscribe(scan, Delivery::newest);
  Robot robot(own_domain());
  const auto sender = robot.sender("rt/scan", "sensor_msgs::msg::dds_::MultiEchoLaserScan_", best_effort);
  listen_until_told(*link);
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("/scan"), HasSubstr("sensor_msgs/MultiEchoLaserScan"),
                                           HasSubstr("sensor_msgs/LaserScan is asked for"))));
}

TEST_F(Ros2, MessagesThatAreCutShortAreDropped) {
  const auto link = this->link();
  link->subscribe(scan, Delivery::newest);
  Robot robot(own_domain());
  const auto sender = robot.sender("rt/scan", dds_scan, reliable);
  meet(*link, scan, *sender);
  const std::string whole = scan_message(1.0F);
  for (std::size_t n = 4; n < whole.size(); n += 4) {
    sender->send(whole.substr(0, n));
    std::this_thread::sleep_for(milliseconds(2));
  }
  // A sequence that says it is far longer than the message.
  std::string lying = whole;
  lying[whole.size() - 20] = '\x7f';
  sender->send(lying);
  sender->send(whole);
  EXPECT_THAT(next(*link, 1, long_enough), ElementsAre(whole));
  EXPECT_THAT(next(*link, 1, milliseconds(100)), IsEmpty());
  // Told once, and not printed.
  EXPECT_THAT(warnings_, ElementsAre(AllOf(HasSubstr("rt/scan"), HasSubstr("failed"))));
}

TEST_F(Ros2, MessagesOfTheOtherByteOrderAreRead) {
  const auto link = this->link();
  link->subscribe(scan, Delivery::newest);
  Robot robot(own_domain());
  const auto sender = robot.sender("rt/scan", dds_scan, reliable);
  meet(*link, scan, *sender);
  sender->send(scan_message(1.5F, std::endian::big));
  EXPECT_THAT(next(*link, 1, long_enough), ElementsAre(scan_message(1.5F)));
}

TEST_F(Ros2, WhatOthersSendIsListed) {
  const auto link = this->link();
  link->publish(map, Delivery::kept, map_message(3));  // not another's
  Robot robot(own_domain());
  Robot second(own_domain());
  const auto scans = robot.sender("rt/scan", dds_scan, best_effort);
  const auto again = second.sender("rt/scan", dds_scan, reliable);
  const auto request = robot.sender("rq/add/Request", "examples::srv::dds_::Add_Request_", reliable);
  auto tfs = robot.sender("rt/tf", dds_tf, reliable);
  const std::vector<LiveTopic> both = {scan, tf};
  const auto listed = [&](const std::vector<LiveTopic>& expected) {
    const auto until = std::chrono::steady_clock::now() + long_enough;
    std::vector<LiveTopic> topics;
    while ((topics = link->topics()) != expected && std::chrono::steady_clock::now() < until)
      std::this_thread::sleep_for(milliseconds(10));
    return topics;
  };
  EXPECT_EQ(listed(both), both);
  tfs.reset();
  EXPECT_EQ(listed({scan}), std::vector{scan});
}

TEST_F(Ros2, DomainsDoNotHearEachOther) {
  const auto here = this->link();
  setenv("ROS_DOMAIN_ID", std::to_string(own_domain() + 100).c_str(), 1);
  const auto there = this->link("domain: auto");
  unsetenv("ROS_DOMAIN_ID");
  here->subscribe(scan, Delivery::newest);
  there->subscribe(scan, Delivery::newest);
  Robot robot(own_domain() + 100);
  const auto sender = robot.sender("rt/scan", dds_scan, best_effort);
  meet(*there, scan, *sender);
  sender->send(scan_message(1.0F));
  EXPECT_THAT(next(*there, 1, long_enough), ElementsAre(scan_message(1.0F)));
  EXPECT_FALSE(here->next(milliseconds(200)));
}

TEST_F(Ros2, LinksOfOneProgramHearEachOtherAndNotThemselves) {
  const auto one = this->link();
  const auto other = this->link();
  one->subscribe(scan, Delivery::newest);
  other->subscribe(scan, Delivery::newest);
  std::vector<std::string> received;
  for (int i = 0; i < 40 && received.empty(); ++i) {
    one->publish(scan, Delivery::newest, scan_message(1.0F));
    received = next(*other, 1, milliseconds(100));
  }
  EXPECT_THAT(received, ElementsAre(scan_message(1.0F)));
  EXPECT_FALSE(one->next(milliseconds(50)));
}

TEST_F(Ros2, NothingWaitsLongerThanItIsToldTo) {
  const auto link = this->link();
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_FALSE(link->next(milliseconds(0)));
  EXPECT_FALSE(link->next(milliseconds(100)));
  link->subscribe(scan, Delivery::newest);
  EXPECT_FALSE(link->next(milliseconds(100)));
  const auto took = std::chrono::steady_clock::now() - begin;
  EXPECT_GE(took, milliseconds(200));
  EXPECT_LT(took, milliseconds(1000));
  EXPECT_FALSE(link->has_ended());
}

TEST_F(Ros2, WhatCannotBeIsRefused) {
  const auto fault = [&](auto call) { return config_error(folder_ / "", call); };
  EXPECT_THAT(fault([&] { (void)link("domain: 233"); }), HasSubstr("domain"));
  EXPECT_THAT(fault([&] { (void)link("domain: -1"); }), HasSubstr("domain"));
  EXPECT_THAT(fault([&] { (void)link("domain: 1.5"); }), HasSubstr("must be a whole number"));
  for (const char* bad : {"233", "-1", "seven", "7b"}) {
    setenv("ROS_DOMAIN_ID", bad, 1);
    EXPECT_THAT(fault([&] { (void)link("domain: auto"); }),
                AllOf(HasSubstr("ROS_DOMAIN_ID is '" + std::string(bad)), HasSubstr("from 0 to 232")));
  }
  unsetenv("ROS_DOMAIN_ID");

  const std::string usual = std::getenv("CYCLONEDDS_URI");
  setenv("CYCLONEDDS_URI", "<General><Interfaces><NetworkInterface name='no_such'/></Interfaces></General>",
         1);
  EXPECT_THAT(fault([&] { (void)this->link(); }), AllOf(HasSubstr("DDS cannot begin"), HasSubstr("no_such")));
  setenv("CYCLONEDDS_URI", usual.c_str(), 1);

  const auto link = this->link();
  for (const char* type : {"sensor_msgs/Image", "sensor_msgs/msg/LaserScan", ""}) {
    const auto names_known = AllOf(HasSubstr("cannot be exchanged"), HasSubstr("sensor_msgs/LaserScan"));
    EXPECT_THAT(fault([&] { link->subscribe({"/scan", type}, Delivery::newest); }), names_known);
    EXPECT_THAT(fault([&] { link->publish({"/scan", type}, Delivery::newest, ""); }), names_known);
  }
  for (const char* name : {"scan", "", "/", "/a//b", "/scan/", "/1st", "/a b"}) {
    EXPECT_THAT(fault([&] { link->subscribe({name, scan.type}, Delivery::newest); }), HasSubstr("letters"));
  }
  link->subscribe(scan, Delivery::newest);
  EXPECT_NO_THROW(link->subscribe(scan, Delivery::reliable));
  EXPECT_THAT(fault([&] {
                link->subscribe({"/scan", map.type}, Delivery::newest);
              }),
              HasSubstr("is of the type sensor_msgs/LaserScan already"));

  const std::string whole = scan_message(1.0F);
  for (std::size_t n = 0; n < whole.size(); n += 3)
    EXPECT_THROW(link->publish(scan, Delivery::newest, whole.substr(0, n)), RunError) << n;
  EXPECT_NO_THROW(link->publish(scan, Delivery::newest, whole));
}

}  // namespace
}  // namespace glocal::test::ros2_test
