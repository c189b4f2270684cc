// A robot with ROS 2, as others hear it: by Fast DDS, which shares no code with the plugin's DDS.
#pragma once

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace glocal::test {

/// What a robot's senders and receivers offer and ask for.
struct RobotQos {
  bool reliable = false;
  bool transient_local = false;
  int depth = 5;
};

/// As ROS 2 has it for sensors, for tf and answers, and for maps and tf_static.
inline constexpr RobotQos best_effort{.reliable = false, .transient_local = false, .depth = 5};
inline constexpr RobotQos reliable{.reliable = true, .transient_local = false, .depth = 100};
inline constexpr RobotQos latched{.reliable = true, .transient_local = true, .depth = 1};

/// Types as DDS calls them.
inline constexpr const char* dds_tf = "tf2_msgs::msg::dds_::TFMessage_";
inline constexpr const char* dds_scan = "sensor_msgs::msg::dds_::LaserScan_";
inline constexpr const char* dds_pose = "geometry_msgs::msg::dds_::PoseWithCovarianceStamped_";
inline constexpr const char* dds_diagnostics = "diagnostic_msgs::msg::dds_::DiagnosticArray_";

/// Until both sides have found each other; more than enough for messages.
inline constexpr std::chrono::milliseconds long_enough{4000};

/// A node of a robot, on this computer alone. Messages are bytes, with CDR's header.
class Robot {
 public:
  explicit Robot(int domain);
  Robot(const Robot&) = delete;
  Robot& operator=(const Robot&) = delete;
  ~Robot();

  class Sender {
   public:
    virtual ~Sender() = default;
    virtual void send(std::string_view bytes) = 0;
    /// Waits until so many receivers have been found, or for long_enough.
    [[nodiscard]] virtual bool has_receivers(int count) = 0;
  };
  class Receiver {
   public:
    virtual ~Receiver() = default;
    /// None if there was none for so long.
    [[nodiscard]] virtual std::optional<std::string> receive(std::chrono::milliseconds longest) = 0;
  };
  /// Topics and types are called as in DDS: rt/scan, sensor_msgs::msg::dds_::LaserScan_. What is made goes
  /// before the robot does.
  [[nodiscard]] std::unique_ptr<Sender> sender(const std::string& topic, const std::string& type,
                                               const RobotQos& qos);
  [[nodiscard]] std::unique_ptr<Receiver> receiver(const std::string& topic, const std::string& type,
                                                   const RobotQos& qos);

 private:
  struct Participant;
  std::unique_ptr<Participant> participant_;
};

}  // namespace glocal::test
