// Drives in robots' own recordings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/bags/drive_contents.hpp"
#include "sources/bags/messages.hpp"
#include "sources/bags/recording.hpp"
#include "sources/bags/scan_placer.hpp"
#include "sources/clouds/cloud_drive.hpp"
#include "sources/driven_path.hpp"

namespace glocal::bags {

/// Reference poses of a recording: a topic's, or those of the robot in a frame of tf. Only the evaluation
/// sees them.
struct BagReference {
  std::string topic = {};
  std::string frame = {};
  double x = 0.0, y = 0.0, z = 0.0;  ///< m; of that frame in the map.
  double yaw_deg = 0.0;
  double time_shift = 0.0;  ///< s
};
void describe(ParamVisitor& v, BagReference& p);

/// A ROS bag (1 or 2) or an MCAP file. An observation is a scan of the first topic, with those of others that
/// were made next to it in time, as a robot with odometry at that time has them.
class BagDrive final : public ObservationSource {
 public:
  struct Params {
    FilePath path;
    bool strict = false;
    std::vector<std::string> scans;
    std::string odometry;
    std::string odom_frame;
    std::string base_frame;
    std::string sensor_from = "tf";
    clouds::SensorMount sensor;
    BagReference reference;
    PathSegments segments{{0.0, 1.0}};
    KeyframeRule keyframes;
    double max_range = 100.0;
    std::vector<double> heights;
    double voxel_size = 0.1;
    std::string deskew = "odometry";
  };

  /// Finds out where the robot was at each scan. Throws ConfigError where Recording and read_contents() do,
  /// and where no scan has odometry.
  BagDrive(const Params& params, const SourceSetup& setup);

  [[nodiscard]] std::optional<Sample> next() override;

 private:
  /// An observation to be.
  struct Frame {
    std::int64_t stamp_ns = 0;
    std::size_t number = 0;  ///< Of the first topic's message.
    Pose3 odom_from_robot;
    int segment = 0;
    std::size_t scans = 1;  ///< Messages that belong to it.
  };
  /// What has been read of one.
  struct Joined {
    Scan scan = {};
    std::size_t missing = 0;  ///< Messages that have not come yet.
    bool is_usable = true;
  };

  [[nodiscard]] std::vector<Frame> frames_of_first_topic();
  void pick(const std::vector<Frame>& frames);
  void join_other_topics();
  void warn_of_references() const;
  [[nodiscard]] std::optional<Pose3> reference_at(std::int64_t stamp_ns) const;
  void take(const RecordedMessage& message);
  [[nodiscard]] std::optional<SensorScan> rays_of(const RecordedMessage& message);
  /// Adds a message's rays to the scan of a frame; false if they cannot be placed.
  bool add(const SensorScan& rays, const Header& header, const Frame& frame, Scan& scan);
  void warn_once(const std::string& text);

  Params params_;
  bool is_planar_;
  Warn warn_;
  bool has_warned_ = false;
  Recording recording_;
  DriveContents contents_;
  ScanPlacer placer_;
  std::vector<Frame> frames_;
  /// Which frames want a message: by topic, and its number there.
  std::map<std::pair<std::size_t, std::size_t>, std::vector<std::size_t>> wanted_;
  std::vector<std::size_t> read_;          ///< Messages of each topic that have been read.
  std::map<std::size_t, Joined> pending_;  ///< By frame.
  std::size_t next_ = 0;                   ///< Frame.
};
void describe(ParamVisitor& v, BagDrive::Params& p);

}  // namespace glocal::bags
