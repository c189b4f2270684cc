// The drive of a robot while it drives.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/message_link.hpp"
#include "glocal/strategies.hpp"
#include "sources/bags/drive_contents.hpp"
#include "sources/bags/scan_placer.hpp"
#include "sources/driven_path.hpp"

namespace glocal::live {

/// What of a robot's messages makes observations.
struct LiveTopics {
  std::string scans = {};            ///< LaserScan or PointCloud2; empty: the only such topic.
  std::string odometry = {};         ///< nav_msgs/Odometry; empty: tf, or the only such topic.
  std::string odom_frame = {};       ///< For tf; empty: odom.
  std::string base_frame = {};       ///< Empty: base_footprint or base_link, or that of the odometry.
  std::string name_space = {};       ///< Of the robot's topics, tf among them: `/robot1`; empty: none.
  std::vector<double> heights = {};  ///< m; see PlacingRule.
  double max_range = 100.0;          ///< m
  double voxel_size = 0.1;           ///< m; of clouds.
  KeyframeRule keyframes = {};
  double longest_wait = 10.0;  ///< s; for the first observation.
};
/// The fields of an observation source and of `glocal live`.
void describe(ParamVisitor& v, LiveTopics& p);

/// What a robot's messages tell, as soon as they tell it: an observation is a scan of one topic, once it is
/// known where the robot was until its end. Those of a recording are the same ones as BagDrive delivers of
/// that topic.
class LiveDrive final : public ObservationSource {
 public:
  struct Params {
    /// Of the link; outlives all that is made of it.
    const Registry<MessageLink, SourceSetup>* links = nullptr;
    StrategyChoice link = {};
    LiveTopics topics = {};
  };
  /// Takes messages of topics that it has not asked for.
  using TakeOther = std::function<void(const LiveMessage&)>;
  /// Does some work while there is no message, and says whether there is more to do.
  using Meanwhile = std::function<bool()>;

  LiveDrive(const Params& params, const SourceSetup& setup);
  /// On a link that others use, too. `other` and `meanwhile` are called in next().
  LiveDrive(LiveTopics topics, const SourceSetup& setup, std::shared_ptr<MessageLink> link, TakeOther other,
            Meanwhile meanwhile);

  /// Waits for an observation; none once the link has ended, or the setup says to stop. Of several that have
  /// come since the last one, the newest. Throws ConfigError if there is none within `longest_wait` of the
  /// first call, with what there is.
  [[nodiscard]] std::optional<Sample> next() override;

  /// The next scan that comes is an observation, though the robot has not moved on. May be called in next().
  void look_anew();

  /// The stamp of the last message of odometry; none where no scans come.
  [[nodiscard]] std::optional<std::int64_t> odometry_ns() const;

  /// How many observations were not delivered, since a newer one was there: of the scans that the link had,
  /// which may keep the newest ones only.
  [[nodiscard]] std::size_t passed_over() const { return passed_over_; }

 private:
  using Clock = std::chrono::steady_clock;

  /// A scan of which it is not yet known where it was made.
  struct Pending {
    bags::Header header;
    std::int64_t received_ns;
    bags::SensorScan rays;
  };

  void ask_for_topics();
  void choose_scans(const std::vector<LiveTopic>& there);
  void subscribe(const LiveTopic& topic, Delivery delivery);
  void take(const LiveMessage& message);
  void note_mounts(const bags::RecordedMessage& message);
  void take_scan(const bags::RecordedMessage& message);
  /// Whether the clock has gone back to this stamp, and what was known of later ones is forgotten.
  [[nodiscard]] bool is_back_at(std::int64_t stamp_ns);
  void begin_anew();
  /// The newest observation that can be made, and none of those before it.
  [[nodiscard]] std::optional<Sample> newest();
  /// The robot in the odometry's frame at this time, as the motion has it.
  [[nodiscard]] std::optional<Pose3> robot_at(std::int64_t stamp_ns,
                                              const bags::DriveContents& contents) const;
  [[nodiscard]] std::size_t decided(const bags::ScanPlacer& placer,
                                    const bags::DriveContents& contents) const;
  void note_place(const Pending& scan);
  [[nodiscard]] std::optional<Sample> observed(const Pending& scan, const bags::ScanPlacer& placer,
                                               const bags::DriveContents& contents);
  [[nodiscard]] std::int64_t now_ns() const;
  [[nodiscard]] bool is_time_to_forget() const;
  void forget();
  [[nodiscard]] bool are_scans_chosen() const { return connections_.contains(topics_.scans); }
  void check_first_wait() const;
  /// Why no observation has come yet.
  [[nodiscard]] std::string why_nothing() const;
  void warn_once(const std::string& text) { warn_once(text, text); }
  /// Of each kind the first.
  void warn_once(const std::string& text, const std::string& kind);

  LiveTopics topics_;
  bool is_planar_;
  Warn warn_;
  std::function<bool()> is_stopped_;
  std::shared_ptr<MessageLink> link_;
  TakeOther take_other_;
  Meanwhile meanwhile_;

  std::map<std::string, bags::Connection> connections_;  ///< By topic that is asked for.
  std::optional<Clock::time_point> first_call_, first_scans_seen_;
  bags::ContentsReader contents_;
  /// Of tf_static, by parent and child: they hold when the clock jumps, too.
  std::map<std::pair<std::string, std::string>, bags::FrameTransform> mounts_;
  std::string why_no_frames_;  ///< What is missing to know where the robot is.
  bool is_news_ = false;       ///< Since newest() was asked last.
  std::deque<Pending> pending_;
  std::optional<std::int64_t> last_stamp_ns_;  ///< Of the last scan.
  bool is_behind_ = false;  ///< A scan that came after it was left out, as it lay far back.
  /// Of the last scan of which it is known where the robot was.
  std::optional<std::int64_t> placed_ns_;
  std::int64_t received_ns_ = 0, placed_received_ns_ = 0;  ///< The last message, and that scan.
  std::optional<std::int64_t> forgotten_until_ns_;
  std::optional<Pose3> last_keyframe_;  ///< The robot in the odometry's frame.
  int segment_ = 0, segment_of_keyframe_ = 0;
  bool has_delivered_ = false;
  std::size_t passed_over_ = 0;
  std::set<std::string> told_;  ///< Kinds of warnings.
};
void describe(ParamVisitor& v, LiveDrive::Params& p);

}  // namespace glocal::live
