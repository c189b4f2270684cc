#include "sources/bags/bag_drive.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/bags/sensor_scan.hpp"

namespace glocal::bags {
namespace {

constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

DriveTopics topics_of(const BagDrive::Params& params) {
  return {.scans = params.scans,
          .odometry = params.odometry,
          .odom_frame = params.odom_frame,
          .base_frame = params.base_frame,
          .reference = params.reference.topic,
          .reference_frame = params.reference.frame,
          .sensor_is_given = params.sensor_from == "given"};
}

PlacingRule placing_rule(const BagDrive::Params& params, bool is_planar) {
  return {.heights = params.heights,
          .is_deskewed = params.deskew == "odometry",
          .is_planar = is_planar,
          .robot_from_sensor = params.sensor_from == "given"
                                   ? std::optional(clouds::robot_from_sensor(params.sensor))
                                   : std::nullopt};
}

/// By number, the message of a topic that was made nearest to each of these times and at most so far from it;
/// `none` where there is none.
std::vector<std::size_t> nearest_messages(const std::vector<std::int64_t>& of_messages,
                                          const std::vector<std::int64_t>& times, std::int64_t farthest_ns) {
  std::vector<std::pair<std::int64_t, std::size_t>> by_stamp;
  for (std::size_t i = 0; i < of_messages.size(); ++i) by_stamp.emplace_back(of_messages[i], i);
  std::ranges::sort(by_stamp);
  std::vector<std::size_t> nearest;
  for (const std::int64_t time : times) {
    const auto after = std::lower_bound(by_stamp.begin(), by_stamp.end(), std::pair(time, std::size_t{0}));
    auto best = after;
    if (after != by_stamp.begin() &&
        (after == by_stamp.end() || time - (after - 1)->first < after->first - time))
      best = after - 1;
    const bool is_near = best != by_stamp.end() && std::abs(best->first - time) <= farthest_ns;
    nearest.push_back(is_near ? best->second : none);
  }
  return nearest;
}

}  // namespace

void describe(ParamVisitor& v, BagReference& p) {
  v.field("topic", p.topic,
          {.doc = "Topic with the robot's poses: geometry_msgs/PoseStamped, PoseWithCovarianceStamped or "
                  "nav_msgs/Odometry. Empty: none."});
  v.field("frame", p.frame, {.doc = "Frame of tf in which the robot's pose is the reference. Empty: none."});
  v.field("x", p.x, {.doc = "Of the poses' frame in the map.", .unit = "m"});
  v.field("y", p.y, {.doc = "Of the poses' frame in the map.", .unit = "m"});
  v.field("z", p.z, {.doc = "Of the poses' frame in the map.", .unit = "m"});
  v.field("yaw_deg", p.yaw_deg,
          {.doc = "Of the poses' frame in the map.", .unit = "deg", .min = -360.0, .max = 360.0});
  v.field("time_shift", p.time_shift,
          {.doc = "Added to the stamps of reference poses.", .unit = "s", .min = -1e6, .max = 1e6});
  v.require(p.topic.empty() || p.frame.empty(), "frame", "must be empty where topic is given");
}

void describe(ParamVisitor& v, BagDrive::Params& p) {
  v.field("path", p.path,
          {.doc = "ROS 1 bag, ROS 2 bag (.db3 or its folder) or MCAP file.",
           .required = true,
           .may_be_folder = true});
  v.field("strict", p.strict,
          {.doc = "Refuse a recording that is damaged behind something whole. Otherwise what is whole is "
                  "read, with a warning."});
  v.field("scans", p.scans,
          {.doc = "Topics with scans (LaserScan, PointCloud2). Those of the first one say when observations "
                  "are, and which; those of others are added. Empty: the only one there is."});
  v.field("odometry", p.odometry,
          {.doc = "Topic with odometry (nav_msgs/Odometry). Empty: tf, or else the only one there is."});
  describe_robot_frames(v, p.odom_frame, p.base_frame);
  v.field("sensor_from", p.sensor_from,
          {.doc = "Who says where the sensor is on the robot: tf, or `sensor` does.",
           .choices = {"tf", "given"}});
  v.field("sensor", p.sensor, {.doc = "Where the sensor is, if that is given."});
  v.field("reference", p.reference, {.doc = "Reference poses, for the evaluation."});
  describe_segments(v, p.segments);
  describe_keyframes(v, p.keyframes);
  describe_rays(v, p.max_range, p.heights, p.voxel_size);
  v.field("deskew", p.deskew,
          {.doc = "odometry: rays are moved to where the robot was at the scan's stamp. none: they are left "
                  "as measured, with their "
                  "times.",
           .choices = {"odometry", "none"}});
  require_rising(v, p.segments);
  v.require(p.sensor_from == "tf" || p.scans.size() < 2, "sensor_from",
            "must be tf where scans of several topics are joined");
}

BagDrive::BagDrive(const Params& params, const SourceSetup& setup)
    : params_(params),
      is_planar_(setup.motion == Motion::planar),
      warn_(setup.warn),
      recording_(params.path.resolved, damage_if(params.strict)),
      placer_(placing_rule(params, setup.motion == Motion::planar), contents_) {
  recording_.tell_progress(setup.progress);
  const std::string file = params.path.resolved.string();
  contents_ = read_contents(recording_, topics_of(params), file, warn_);
  for (const auto& input : recording_.inputs()) setup.note_input(input);
  const bool has_clouds =
      std::ranges::any_of(contents_.scans, [](const ScanTopic& scan) { return scan.are_clouds; });
  if (is_planar_ && has_clouds && params.heights.empty()) {
    throw ConfigError(file, clouds_need_heights);
  }
  pick(frames_of_first_topic());
  join_other_topics();
  warn_of_references();
  std::set<std::string> topics;
  for (const ScanTopic& scan : contents_.scans) topics.insert(scan.topic);
  recording_.rewind(topics);
  read_.assign(contents_.scans.size(), 0);
}

std::vector<BagDrive::Frame> BagDrive::frames_of_first_topic() {
  const ScanTopic& scans = contents_.scans.front();
  const std::string at = fmt::format("{}: {}", params_.path.resolved.string(), shown(scans.topic));
  std::vector<Frame> frames;
  std::size_t backwards = 0, lost = 0;
  int pauses = 0;
  std::int64_t last = std::numeric_limits<std::int64_t>::min();
  for (std::size_t i = 0; i < scans.stamps_ns.size(); ++i) {
    const std::int64_t stamp = scans.stamps_ns[i];
    if (stamp <= last) {
      ++backwards;
      continue;
    }
    const auto odometry = contents_.odometry_at(stamp, longest_gap_ns);
    if (!odometry || !placer_.robot_from_sensor(scans.frame, stamp)) {
      ++lost;
      continue;
    }
    if (!frames.empty() && seconds(stamp - last) > longest_pause) {
      warn_(fmt::format("{}: stamps jump by {:.0f} s; what follows is a drive of its own", at,
                        seconds(stamp - last)));
      ++pauses;
    }
    last = stamp;
    frames.push_back({stamp, i, is_planar_ ? Pose3(seen_from_above(*odometry)) : *odometry, pauses});
  }
  if (backwards > 0)
    warn_(fmt::format("{}: {} scans are left out, as their stamps stand still or run backwards", at,
                      backwards));
  if (frames.empty()) {
    throw ConfigError(params_.path.resolved,
                      fmt::format("{} has {} scans, and for none of them is it known where the robot and "
                                  "its sensor were within {} s; "
                                  "check the stamps, or set odometry, odom_frame or base_frame",
                                  shown(scans.topic), scans.stamps_ns.size(), seconds(longest_gap_ns)));
  }
  if (lost > 0)
    warn_(fmt::format("{}: {} of {} scans are left out, as {} is not known within {} s of their stamps", at,
                      lost, scans.stamps_ns.size(),
                      contents_.odometry.empty() ? "tf" : shown(contents_.odometry),
                      seconds(longest_gap_ns)));
  return frames;
}

void BagDrive::pick(const std::vector<Frame>& frames) {
  std::vector<double> lengths(frames.size(), 0.0);
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const bool goes_on = frames[i].segment == frames[i - 1].segment;
    lengths[i] =
        lengths[i - 1] + (goes_on ? distance(frames[i - 1].odom_from_robot, frames[i].odom_from_robot) : 0.0);
  }
  const auto places = places_on(params_.segments, lengths, params_.path.resolved.string(), "scan");
  int segment = -1;
  for (const std::vector<std::size_t>& part : places) {
    std::optional<int> pauses;
    for (const std::size_t i : part) {
      const bool begins = pauses != frames[i].segment;
      if (begins) ++segment;
      pauses = frames[i].segment;
      if (!begins &&
          !is_keyframe(frames_.back().odom_from_robot, frames[i].odom_from_robot, params_.keyframes))
        continue;
      wanted_[{0, frames[i].number}] = {frames_.size()};
      frames_.push_back(frames[i]);
      frames_.back().segment = segment;
    }
  }
}

void BagDrive::join_other_topics() {
  std::vector<std::int64_t> stamps;
  for (const Frame& frame : frames_) stamps.push_back(frame.stamp_ns);
  for (std::size_t topic = 1; topic < contents_.scans.size(); ++topic) {
    const auto nearest = nearest_messages(contents_.scans[topic].stamps_ns, stamps, longest_gap_ns);
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      if (nearest[i] == none) continue;
      wanted_[{topic, nearest[i]}].push_back(i);
      ++frames_[i].scans;
    }
    const auto alone = std::ranges::count(nearest, none);
    if (alone > 0)
      warn_(fmt::format("{}: {} of {} observations are without a scan of {}", params_.path.resolved.string(),
                        alone, frames_.size(), shown(contents_.scans[topic].topic)));
  }
}

void BagDrive::warn_of_references() const {
  if (params_.reference.topic.empty() && params_.reference.frame.empty()) return;
  const auto without =
      std::ranges::count_if(frames_, [&](const Frame& frame) { return !reference_at(frame.stamp_ns); });
  if (without == 0) return;
  warn_(fmt::format("{}: {} of {} observations are without reference pose", params_.path.resolved.string(),
                    without, frames_.size()));
}

std::optional<Pose3> BagDrive::reference_at(std::int64_t stamp_ns) const {
  const BagReference& r = params_.reference;
  const auto pose = contents_.reference_at(stamp_ns - nanoseconds(r.time_shift), longest_gap_ns);
  if (!pose) return std::nullopt;
  const Pose3 map_from_robot = Pose3({r.x, r.y, r.z}, turn_about_z(radians(r.yaw_deg))) * *pose;
  return is_planar_ ? Pose3(seen_from_above(map_from_robot)) : map_from_robot;
}

std::optional<Sample> BagDrive::next() {
  while (next_ < frames_.size()) {
    const auto pending = pending_.find(next_);
    if (pending != pending_.end() && pending->second.missing == 0) {
      const Joined joined = std::move(pending->second);
      pending_.erase(pending);
      const Frame& frame = frames_[next_++];
      if (!joined.is_usable) continue;
      return Sample{{seconds(frame.stamp_ns), joined.scan, frame.odom_from_robot},
                    reference_at(frame.stamp_ns),
                    frame.segment};
    }
    const auto message = recording_.next();
    if (!message) return std::nullopt;
    take(*message);
  }
  return std::nullopt;
}

void BagDrive::take(const RecordedMessage& message) {
  const auto& scans = contents_.scans;
  const auto topic = std::ranges::find_if(scans, [&](const ScanTopic& scan) {
    return scan.topic == message.connection->topic && has_scans(message.connection->type);
  });
  if (topic == scans.end()) return;
  const auto header = readable_header(message);
  if (!header) return;  // Nor was it counted when the contents were read.
  const auto t = static_cast<std::size_t>(topic - scans.begin());
  const auto frames = wanted_.find({t, read_[t]++});
  if (frames == wanted_.end()) return;
  const auto rays = rays_of(message);
  for (const std::size_t i : frames->second) {
    Joined& joined = pending_.try_emplace(i, Joined{.missing = frames_[i].scans}).first->second;
    --joined.missing;
    joined.is_usable = joined.is_usable && rays && add(*rays, *header, frames_[i], joined.scan);
  }
}

std::optional<SensorScan> BagDrive::rays_of(const RecordedMessage& message) {
  try {
    return read_rays(message, {.max_range = params_.max_range, .voxel_size = params_.voxel_size});
  } catch (const ConfigError& error) {
    warn_once(fmt::format("a scan of {} is left out: {}", shown(message.connection->topic), error.what()));
    return std::nullopt;
  }
}

bool BagDrive::add(const SensorScan& rays, const Header& header, const Frame& frame, Scan& scan) {
  if (placer_.add(rays, header, frame.stamp_ns, frame.scans, scan)) return true;
  warn_once(
      fmt::format("the scan at {:.3f} s is left out, as it is not known where the robot was until its end",
                  seconds(header.stamp_ns)));
  return false;
}

void BagDrive::warn_once(const std::string& text) {
  if (has_warned_) return;
  has_warned_ = true;
  warn_(params_.path.resolved.string() + ": " + text + "; others like it are not told");
}

}  // namespace glocal::bags
