// fast_dds_player LOG DOMAIN HERTZ SCANS: sends the first SCANS scans of a CARMEN log as a robot would, by
// Fast DDS, HERTZ of them a second (0: at their own times). It prints "ready", waits for who listens, and
// then prints one line for each pose of glocal that comes back: its topic, the scan's stamp (ns), and how
// long after that scan was sent it came (ms).
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <map>
#include <memory>
#include <thread>
#include <vector>

#include "carmen_messages.hpp"
#include "fast_dds_robot.hpp"

namespace glocal::test {
namespace {

using Clock = std::chrono::steady_clock;

/// Of a message that begins with a header, after CDR's own four bytes.
std::int64_t stamp_of(const std::string& bytes) {
  std::int32_t seconds = 0;
  std::uint32_t nanoseconds = 0;
  std::memcpy(&seconds, bytes.data() + 4, sizeof seconds);
  std::memcpy(&nanoseconds, bytes.data() + 8, sizeof nanoseconds);
  return std::int64_t{seconds} * 1'000'000'000 + nanoseconds;
}

class Player {
 public:
  Player(int domain, const Pose3& robot_from_laser) : robot_(domain) {
    tf_static_->send(transform("base_link", "laser", 0, robot_from_laser));
    fmt::print("ready\n");
    std::fflush(stdout);
    while (!tf_->has_receivers(1) || !scans_->has_receivers(1)) {
    }
    std::this_thread::sleep_for(long_enough);  // Until answers are heard, too.
  }

  void play(const std::vector<carmen::CarmenScan>& log, double hertz, std::size_t most) {
    const auto begin = Clock::now();
    for (std::size_t i = 0; i < std::min(log.size(), most); ++i) {
      const double after_s = hertz > 0.0 ? static_cast<double>(i) / hertz : log[i].stamp - log.front().stamp;
      listen_until(begin +
                   std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(after_s)));
      tf_->send(transform("odom", "base_link", stamp_ns(log[i]), log[i].odom_from_robot));
      scans_->send(scan_message(log[i]));
      sent_[stamp_ns(log[i])] = Clock::now();
    }
    listen_until(Clock::now() + std::chrono::seconds(3));
  }

 private:
  void listen_until(Clock::time_point time) {
    do {
      hear(*declared_, "/initialpose");
      hear(*poses_, "/glocal/pose");
    } while (Clock::now() < time);
  }

  void hear(Robot::Receiver& receiver, const char* topic) {
    const auto bytes = receiver.receive(std::chrono::milliseconds(1));
    if (!bytes) return;
    const auto sent = sent_.find(stamp_of(*bytes));
    if (sent == sent_.end()) return;
    const std::chrono::duration<double, std::milli> late = Clock::now() - sent->second;
    fmt::print("{} {} {:.1f}\n", topic, sent->first, late.count());
    std::fflush(stdout);
  }

  Robot robot_;
  std::unique_ptr<Robot::Sender> tf_ = robot_.sender("rt/tf", dds_tf, reliable);
  std::unique_ptr<Robot::Sender> tf_static_ = robot_.sender("rt/tf_static", dds_tf, latched);
  std::unique_ptr<Robot::Sender> scans_ = robot_.sender("rt/scan", dds_scan, best_effort);
  std::unique_ptr<Robot::Receiver> declared_ = robot_.receiver("rt/initialpose", dds_pose, reliable);
  std::unique_ptr<Robot::Receiver> poses_ = robot_.receiver("rt/glocal/pose", dds_pose, reliable);
  std::map<std::int64_t, Clock::time_point> sent_;
};

}  // namespace
}  // namespace glocal::test

int main(int argc, char** argv) {
  if (argc != 5) {
    fmt::print(stderr, "usage: fast_dds_player LOG DOMAIN HERTZ SCANS\n");
    return 2;
  }
  const auto log = glocal::carmen::read_carmen_log(argv[1]);
  glocal::test::Player(std::atoi(argv[2]), log.front().robot_from_laser)
      .play(log, std::atof(argv[3]), std::strtoul(argv[4], nullptr, 10));
  return 0;
}
