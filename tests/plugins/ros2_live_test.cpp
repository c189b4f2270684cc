// glocal live beside a robot whose DDS is another one.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "app/room.hpp"
#include "carmen_messages.hpp"
#include "fast_dds_robot.hpp"

namespace glocal::test::ros2_live_test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;

/// A simulated room, and what a robot sends that drives through it.
class LiveRoom : public CommandLine {
 protected:
  LiveRoom() {
    // On this computer alone, which may know no multicast.
    setenv("CYCLONEDDS_URI",
           "<General><Interfaces><NetworkInterface name='lo'/></Interfaces><AllowMulticast>false"
           "</AllowMulticast></General><Discovery><ParticipantIndex>auto</ParticipantIndex><Peers>"
           "<Peer address='127.0.0.1'/></Peers></Discovery>",
           1);
    simulate_room();
    for (const carmen::CarmenScan& scan : carmen::read_carmen_log(file("room/drive.log"))) {
      sent_.push_back(
          {transform("odom", "base_link", stamp_ns(scan), scan.odom_from_robot), scan_message(scan)});
    }
  }

  void start(const std::string& options) {
    const std::string command = std::string(GLOCAL_PROGRAM) + " live " + file("room/map.yaml") +
                                " --domain " + std::to_string(domain_) + " --scans /scan --force --out " +
                                file("live") + " " + options + " >" + file("live.out") + " 2>" +
                                file("live.err") + " & echo $! >" + file("pid");
    ASSERT_EQ(std::system(command.c_str()), 0);
  }

  /// As Ctrl-C does; what it says at its end.
  std::string end() {
    kill(static_cast<pid_t>(std::stol(content(file("pid")))), SIGINT);
    for (int i = 0; i < 100 && content(file("live.out")).find("observations,") == std::string::npos; ++i)
      std::this_thread::sleep_for(milliseconds(50));
    return content(file("live.out"));
  }

  struct Sent {
    std::string transform, scan;
  };
  std::vector<Sent> sent_;
  int domain_ = 1 + static_cast<int>(getpid()) % 100;
};

TEST_F(LiveRoom, TheRobotIsToldWhatLocalizeFindsOnTheRecording) {
  Robot robot(domain_);
  const auto tf = robot.sender("rt/tf", dds_tf, reliable);
  const auto tf_static = robot.sender("rt/tf_static", dds_tf, latched);
  const auto scans = robot.sender("rt/scan", dds_scan, best_effort);
  const auto poses = robot.receiver("rt/initialpose", dds_pose, reliable);
  const auto diagnostics = robot.receiver("rt/diagnostics", dds_diagnostics, reliable);
  tf_static->send(transform("base_link", "laser", 0, {}));
  // Each step waits for its searches, and is told once.
  start("--set localizer.looks_per_step=0 --record " + file("live.mcap"));
  ASSERT_TRUE(tf->has_receivers(1) && scans->has_receivers(1)) << content(file("live.err"));
  std::size_t answered = 0;
  for (const Sent& sent : sent_) {
    tf->send(sent.transform);
    scans->send(sent.scan);
    // The first one may come before the laser's place or the answers' receiver is known.
    if (diagnostics->receive(milliseconds(answered == 0 ? 4000 : 2000))) ++answered;
  }
  const std::string told = end();
  EXPECT_GE(answered + 1, sent_.size()) << told << content(file("live.err"));
  EXPECT_THAT(told, HasSubstr("localized"));
  EXPECT_TRUE(poses->receive(milliseconds(1000)));

  good(run("localize " + file("room/map.yaml") + " " + file("live.mcap") + " --scans /scan --whole --out " +
           file("again")));
  const std::vector<Json> live = json_lines(file("live.steps.jsonl"));
  const std::vector<Json> again = json_lines(file("again/steps.jsonl"));
  ASSERT_EQ(live.size(), again.size());
  for (std::size_t i = 0; i < live.size(); ++i) {
    const Json expected = without_times(again[i]);
    for (const auto& [key, value] : expected.items())
      ASSERT_EQ(live[i].value(key, Json()), value) << i << " " << key;
  }
}

TEST_F(LiveRoom, TheMapMayBeTheMapServers) {
  Robot robot(domain_);
  const auto maps = robot.sender("rt/map", "nav_msgs::msg::dds_::OccupancyGrid_", latched);
  bags::Writer grid("cdr");
  grid.header("map").number<std::uint32_t>(0).number<std::uint32_t>(0).number(0.5F);
  grid.number<std::uint32_t>(3).number<std::uint32_t>(1).pose();
  maps->send(grid.raw(std::string("\x64\x00\x64", 3)).bytes());
  const Answer answer = run("live topic:/map --domain " + std::to_string(domain_) + " --out " + file("live") +
                            " --set observations.ros2.longest_wait=3");
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.out, HasSubstr("map         2 points"));
  EXPECT_THAT(answer.err, HasSubstr("there is no topic with scans; there are /map"));
}

TEST_F(LiveRoom, WithoutARobotItSaysWhatThereIs) {
  EXPECT_THAT(refusal(run("live " + file("room/map.yaml") + " --domain " + std::to_string(domain_) +
                          " --out " + file("live") + " --set observations.ros2.longest_wait=0.5")),
              HasSubstr("no observation within 0.5 s: there is no topic with scans; there are none at all"));
}

}  // namespace
}  // namespace glocal::test::ros2_live_test
