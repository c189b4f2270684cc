// What a robot is told of its place, as messages.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "glocal/global_map.hpp"
#include "glocal/message_link.hpp"
#include "glocal/step_result.hpp"
#include "sources/bags/messages.hpp"

namespace glocal::live {

/// Publishes each step's answer, under a namespace (`/robot1`, or empty):
/// - `/initialpose` (PoseWithCovarianceStamped): a pose once it is declared;
/// - `/glocal/pose` (PoseWithCovarianceStamped): the best pose of each step, declared or not;
/// - `/glocal/candidates` (PoseArray): poses among which nothing decides yet;
/// - `/diagnostics` (DiagnosticArray): verdict, confidence, margin and reason;
/// - `/tf`, if asked for: map to odom while a pose is declared, and between steps as odometry goes on.
/// Of several maps each pose, and its covariance, is in the frame of the one it is on, which is called as
/// that map; candidates, which may lie on several, are in the common frame.
class Answers {
 public:
  struct Frames {
    std::string map = "map";
    std::string odom = "odom";
    bool publishes_tf = false;  ///< Somebody else may own map to odom (REP 105).
  };

  /// `link` and `map` must outlive this. What is sent once is not to be missed: topics are advertised here.
  Answers(MessageLink& link, const GlobalMap& map, std::string name_space, Frames frames);

  /// A step made of the observation at this stamp, and how many observations were passed over so far.
  void tell(const StepResult& result, std::int64_t stamp_ns, const Pose3& odom_from_robot,
            std::size_t passed_over);
  /// Odometry has come to this stamp: map to odom holds until then. Sent ten times a second at most.
  void tell_again(std::int64_t odometry_ns);
  /// What was declared counts no longer: the next declaration is one of its own.
  void begin_anew() {
    is_declared_ = false;
    map_to_odom_.reset();
  }

 private:
  void publish(const LiveTopic& topic, const std::string& bytes);
  void publish_tf(std::int64_t stamp_ns);

  MessageLink& link_;
  const GlobalMap& map_;
  std::string name_space_;
  Frames frames_;
  bool is_declared_ = false;
  std::optional<bags::FrameTransform> map_to_odom_;  ///< While a pose is declared.
  std::int64_t tf_ns_ = 0;                           ///< The stamp that it was sent with last.
};

}  // namespace glocal::live
