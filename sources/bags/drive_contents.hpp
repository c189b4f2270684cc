// What of a recording a drive is made of: its scans, and where the robot and its sensors are.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/catalog.hpp"
#include "sources/bags/pose_track.hpp"
#include "sources/bags/recording.hpp"
#include "sources/bags/transform_tree.hpp"

namespace glocal::bags {

/// What is asked for by name. What is empty is found out.
struct DriveTopics {
  std::vector<std::string> scans =
      {};                            ///< LaserScan or PointCloud2; the first one says when observations are.
  std::string odometry = {};         ///< nav_msgs/Odometry; empty: tf, or else the only such topic.
  std::string odom_frame = {};       ///< For tf; empty: odom.
  std::string base_frame = {};       ///< Empty: base_footprint, base_link, or whose pose odometry says.
  std::string reference = {};        ///< PoseStamped, PoseWithCovarianceStamped or Odometry; perhaps empty.
  std::string reference_frame = {};  ///< Of tf, in which the robot's pose is the reference; perhaps empty.
  bool sensor_is_given = false;      ///< Then tf need not say where the sensor is.
  bool are_options = false;          ///< Errors then name --odom-frame, not odom_frame.
};

/// The scans of a topic.
struct ScanTopic {
  std::string topic;
  bool are_clouds = false;
  std::string frame;                    ///< Of the first one.
  std::vector<std::int64_t> stamps_ns;  ///< In order of receipt: of measurement, as the header has it.
};

/// Everything but the scans themselves.
struct DriveContents {
  std::vector<ScanTopic> scans;  ///< In the order asked for.
  TransformTree tree;
  std::string base_frame;
  std::string odom_frame;
  std::string odometry;       ///< Topic; empty where tf has the odometry.
  PoseTrack odom_from_child;  ///< Of that topic.
  Pose3 child_from_base;
  PoseTrack reference;          ///< Of the topic; empty if there is none.
  std::string reference_frame;  ///< Of tf; empty if there is none.

  std::optional<FramePath> tf_odometry, tf_reference;           ///< Of the robot, where these are tf's.
  std::map<std::string, std::optional<FramePath>> mounts = {};  ///< Of frames in base_frame, once asked for.

  /// The robot in odom_frame; none where it is not known at this time.
  [[nodiscard]] std::optional<Pose3> odometry_at(std::int64_t stamp_ns, std::int64_t max_gap_ns) const;
  /// The robot in the reference's frame; none where it is not known at this time.
  [[nodiscard]] std::optional<Pose3> reference_at(std::int64_t stamp_ns, std::int64_t max_gap_ns) const;
  /// The way from base_frame to a sensor's frame; none if there is none.
  [[nodiscard]] const std::optional<FramePath>& mount(const std::string& frame);
  /// A sensor's frame on the robot; none where it is not known at this time.
  [[nodiscard]] std::optional<Pose3> robot_from_sensor(const std::string& frame, std::int64_t stamp_ns,
                                                       std::int64_t max_gap_ns);
};

/// Finds out what a drive is made of, message by message.
class ContentsReader {
 public:
  /// `wanted` names the topics of scans, but those that are added; `source` is what errors name.
  ContentsReader(const DriveTopics& wanted, std::string source);

  void add_scans(const std::string& topic) { contents_.scans.emplace_back().topic = topic; }

  /// Takes in a message of tf, scans, odometry or the reference. Throws ConfigError if it cannot be read.
  void take(const RecordedMessage& message);
  /// What is known by now, or, where no more comes, all there is. Throws ConfigError, with what there is, for
  /// several topics where one is needed, and frames that tf does not connect. What was once chosen stays.
  DriveContents& settle(bool more_may_come);
  /// The stamp of the last message of odometry, by a topic or as tf from the frame that it counts from.
  [[nodiscard]] std::optional<std::int64_t> odometry_ns() const { return odometry_ns_; }
  /// Forgets how the robot and its sensors moved before a time.
  void forget_before(std::int64_t stamp_ns);

 private:
  struct OdometryTopic {
    PoseTrack poses;
    std::string frame, child;
  };

  [[noreturn]] void fail(const std::string& message) const;
  [[nodiscard]] std::string odom_frame() const;
  [[nodiscard]] std::string name_of(std::string_view key) const;
  void take_scan(const RecordedMessage& message);
  void choose_frames();
  [[nodiscard]] const std::string& robot_of(const std::vector<std::string>& bases) const;
  void choose_odometry_topic(const std::vector<std::string>& bases);
  void check_sensors();
  [[nodiscard]] std::string tree_text() const;

  DriveTopics wanted_;
  std::string source_;
  DriveContents contents_;
  std::map<std::string, OdometryTopic> odometry_;
  std::optional<std::int64_t> odometry_ns_;
};

/// Reads all but the scans' content, and finds out what is not asked for by name. Throws ConfigError where
/// ContentsReader does, and for topics that are missing. Warns of what the recording warns of, and of
/// messages that cannot be read.
[[nodiscard]] DriveContents read_contents(Recording& recording, const DriveTopics& wanted,
                                          const std::string& file, const Warn& warn);

/// Topics with scans.
[[nodiscard]] bool has_scans(std::string_view type);
/// Of nav_msgs/Odometry.
[[nodiscard]] bool has_odometry(std::string_view type);

}  // namespace glocal::bags
