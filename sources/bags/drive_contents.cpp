#include "sources/bags/drive_contents.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/bags/message_reader.hpp"
#include "sources/bags/messages.hpp"
#include "sources/bags/recording_summary.hpp"

namespace glocal::bags {
namespace {

constexpr const char* odometry_type = "nav_msgs/Odometry";

bool is_reference_type(std::string_view type) {
  return is_pose(type) || has_odometry(type);
}

std::vector<std::string> topics_of(const Recording& recording, bool (*is_wanted)(std::string_view)) {
  std::set<std::string> topics;
  for (const Connection& connection : recording.connections()) {
    if (is_readable(connection) && is_wanted(connection.type)) topics.insert(connection.topic);
  }
  return {topics.begin(), topics.end()};
}

/// A key as it is set: `odom_frame` is --odom-frame on the command line.
std::string key_or_option(std::string_view key, const DriveTopics& wanted) {
  if (!wanted.are_options) return std::string(key);
  std::string option = "--" + std::string(key.substr(0, key.find('.')));
  std::ranges::replace(option, '_', '-');
  return option;
}

/// What is asked for by name is there, and scans are named.
class TopicChecker {
 public:
  TopicChecker(Recording& recording, const DriveTopics& wanted, const std::string& file)
      : recording_(recording), wanted_(wanted), file_(file) {}

  [[nodiscard]] DriveTopics checked() const {
    DriveTopics checked = wanted_;
    checked.scans = scans();
    check_topic(wanted_.odometry, topics_of(recording_, has_odometry), odometry_type, "odometry");
    check_topic(wanted_.reference, topics_of(recording_, is_reference_type), "poses", "reference.topic");
    return checked;
  }

 private:
  [[noreturn]] void fail(const std::string& message) const { throw ConfigError(file_, message); }

  void check_topic(const std::string& topic, const std::vector<std::string>& there, const std::string& what,
                   const std::string& key) const {
    if (topic.empty() || std::ranges::find(there, topic) != there.end()) return;
    const std::string name = key_or_option(key, wanted_);
    fail(fmt::format("has no topic {} with {}; {}", shown(topic), what,
                     there.empty() ? fmt::format("it has none at all: leave out {}", name)
                                   : fmt::format("set {} to one of {}", name, listed(there))));
  }

  [[nodiscard]] std::vector<std::string> scans() const {
    std::vector<std::string> there = topics_of(recording_, has_scans);
    if (there.empty())
      fail(
          "has no scans (sensor_msgs/LaserScan, sensor_msgs/PointCloud2); glocal bag info shows what it has");
    for (const std::string& topic : wanted_.scans) check_topic(topic, there, "scans", "scans");
    if (!wanted_.scans.empty()) return wanted_.scans;
    if (there.size() == 1) return there;
    std::string list;
    std::vector<std::string> topics, ignored;
    for (const TopicSummary& topic : summarize_recording(recording_, ignored).topics) {
      if (has_scans(topic.type)) topics.push_back(text_of(topic));
    }
    for (const std::string& topic : first_of(std::move(topics))) list += "\n  " + topic;
    fail(fmt::format("has several topics with scans; set {} to those of one sensor, or of several alike:{}",
                     key_or_option("scans", wanted_), list));
  }

  Recording& recording_;
  const DriveTopics& wanted_;
  const std::string& file_;
};

}  // namespace

ContentsReader::ContentsReader(const DriveTopics& wanted, std::string source)
    : wanted_(wanted), source_(std::move(source)) {
  for (const std::string& topic : wanted_.scans) add_scans(topic);
  contents_.reference_frame = wanted_.reference_frame;
}

void ContentsReader::take(const RecordedMessage& message) {
  const std::string& type = message.connection->type;
  const std::string& topic = message.connection->topic;
  if (has_transforms(type)) {
    const bool is_still = topic.ends_with("tf_static");
    for (const FrameTransform& transform : read_transforms(message)) {
      contents_.tree.add(transform, is_still);
      if (!is_still && transform.header.frame == odom_frame()) odometry_ns_ = transform.header.stamp_ns;
    }
  } else if (has_scans(type)) {
    take_scan(message);
  } else if (has_odometry(type)) {
    const Odometry odometry = read_odometry(message);
    auto& [poses, frame, child] = odometry_[topic];
    poses.add(odometry.header.stamp_ns, odometry.frame_from_child);
    odometry_ns_ = odometry.header.stamp_ns;
    frame = odometry.header.frame;
    child = odometry.child_frame;
    if (topic == wanted_.reference)
      contents_.reference.add(odometry.header.stamp_ns, odometry.frame_from_child);
  } else if (is_pose(type)) {
    const StampedFramePose pose = read_pose(message);
    contents_.reference.add(pose.header.stamp_ns, pose.pose);
  }
}

DriveContents& ContentsReader::settle(bool more_may_come) {
  contents_.tree.settle(more_may_come);
  for (auto& [topic, odometry] : odometry_) odometry.poses.settle();
  contents_.reference.settle();
  contents_.mounts.clear();
  choose_frames();
  contents_.tf_reference = contents_.tree.path(wanted_.reference_frame, contents_.base_frame);
  if (!wanted_.reference_frame.empty() && !contents_.tf_reference)
    fail(fmt::format("tf does not connect {} with {}; set {} to a topic or a frame of the tree, which is\n{}",
                     shown(wanted_.reference_frame), shown(contents_.base_frame),
                     wanted_.are_options ? "--reference" : "reference", tree_text()));
  check_sensors();
  wanted_.odometry = contents_.odometry;
  wanted_.odom_frame = contents_.odom_frame;
  wanted_.base_frame = contents_.base_frame;
  return contents_;
}

void ContentsReader::forget_before(std::int64_t stamp_ns) {
  contents_.tree.forget_before(stamp_ns);
  for (auto& [topic, odometry] : odometry_) odometry.poses.forget_before(stamp_ns);
  contents_.reference.forget_before(stamp_ns);
  for (ScanTopic& scan : contents_.scans) {
    if (!scan.stamps_ns.empty()) scan.stamps_ns = {scan.stamps_ns.back()};
  }
}

void ContentsReader::fail(const std::string& message) const {
  throw ConfigError(source_, message);
}

std::string ContentsReader::odom_frame() const {
  return wanted_.odom_frame.empty() ? "odom" : wanted_.odom_frame;
}

std::string ContentsReader::name_of(std::string_view key) const {
  return key_or_option(key, wanted_);
}

void ContentsReader::take_scan(const RecordedMessage& message) {
  const auto scans = std::ranges::find(contents_.scans, message.connection->topic, &ScanTopic::topic);
  if (scans == contents_.scans.end()) return;
  const auto header = readable_header(message);
  if (!header) return;
  if (scans->stamps_ns.empty()) scans->frame = header->frame;
  scans->are_clouds = message.connection->type == "sensor_msgs/PointCloud2";
  scans->stamps_ns.push_back(header->stamp_ns);
}

/// tf's odometry before that of a topic, as it is that of which all else in the tree knows.
void ContentsReader::choose_frames() {
  DriveContents& c = contents_;
  const TransformTree& tree = c.tree;
  c.odom_frame = odom_frame();
  std::vector<std::string> bases = {wanted_.base_frame};
  if (wanted_.base_frame.empty()) bases = {"base_footprint", "base_link"};
  const auto base = std::ranges::find_if(bases, [&](const std::string& frame) {
    return frame != c.odom_frame && tree.path(c.odom_frame, frame);
  });
  if (wanted_.odometry.empty() && base != bases.end()) {
    c.base_frame = *base;
    c.tf_odometry = tree.path(c.odom_frame, c.base_frame, true);
    return;
  }
  choose_odometry_topic(bases);
}

/// Of frames that may be the robot's, the first one that tf connects with scans.
const std::string& ContentsReader::robot_of(const std::vector<std::string>& bases) const {
  const auto has_scans = [&](const std::string& base) {
    return std::ranges::any_of(contents_.scans, [&](const ScanTopic& scan) {
      return contents_.tree.path(base, scan.frame).has_value();
    });
  };
  const auto robot = std::ranges::find_if(bases, has_scans);
  return robot == bases.end() ? bases.back() : *robot;
}

void ContentsReader::choose_odometry_topic(const std::vector<std::string>& bases) {
  DriveContents& c = contents_;
  std::vector<std::string> topics;
  for (const auto& [topic, odometry] : odometry_) topics.push_back(topic);
  if (!wanted_.odometry.empty()) topics = {wanted_.odometry};
  if (topics.empty() || !odometry_.contains(topics.front()))
    fail(fmt::format(
        "has no odometry: tf does not connect {} with {}, and there is no topic of {}; set {} and "
        "{} to frames of the tree, which is\n{}",
        shown(c.odom_frame), listed(bases, " or "), odometry_type, name_of("odom_frame"),
        name_of("base_frame"), tree_text()));
  if (topics.size() > 1)
    fail(fmt::format("has several topics with odometry; set {} to one of {}", name_of("odometry"),
                     listed(topics)));
  const auto& [poses, frame, named_child] = odometry_.at(topics.front());
  // Drivers that name none mean the robot.
  const std::string& child = named_child.empty() ? robot_of(bases) : named_child;
  c.odometry = topics.front();
  c.odom_frame = frame;
  c.base_frame = wanted_.base_frame.empty() ? child : wanted_.base_frame;
  c.odom_from_child = poses;
  if (c.base_frame == child) return;
  const auto mount = c.tree.path(child, c.base_frame);
  if (!mount || !mount->is_still())
    fail(fmt::format("odometry of {} says where {} is, and tf does not say where {} is on it; set {} to {}",
                     shown(c.odometry), shown(child), shown(c.base_frame), name_of("base_frame"),
                     shown(child)));
  c.child_from_base = *mount->pose(0, 0);
}

void ContentsReader::check_sensors() {
  if (wanted_.sensor_is_given) return;
  for (const ScanTopic& scan : contents_.scans) {
    if (scan.stamps_ns.empty() || contents_.mount(scan.frame)) continue;
    fail(fmt::format(
        "tf does not connect {}, the frame of {}, with {}; set {} to another one{}; the tree is\n{}",
        shown(scan.frame), shown(scan.topic), shown(contents_.base_frame), name_of("base_frame"),
        wanted_.are_options ? "" : ", or sensor_from to given and sensor to where it is on the robot",
        tree_text()));
  }
}

std::string ContentsReader::tree_text() const {
  const std::string text = frame_tree(contents_.tree.parents(), most_listed);
  return text.empty() ? "empty" : text;
}

bool has_scans(std::string_view type) {
  return type == "sensor_msgs/LaserScan" || type == "sensor_msgs/PointCloud2";
}

bool has_odometry(std::string_view type) {
  return type == odometry_type;
}

std::optional<Pose3> DriveContents::odometry_at(std::int64_t stamp_ns, std::int64_t max_gap_ns) const {
  if (tf_odometry) return tf_odometry->pose(stamp_ns, max_gap_ns);
  const auto odom_from = odom_from_child.at(stamp_ns, max_gap_ns);
  return odom_from ? std::optional(*odom_from * child_from_base) : std::nullopt;
}

std::optional<Pose3> DriveContents::reference_at(std::int64_t stamp_ns, std::int64_t max_gap_ns) const {
  if (reference_frame.empty()) return reference.at(stamp_ns, max_gap_ns);
  return tf_reference ? tf_reference->pose(stamp_ns, max_gap_ns) : std::nullopt;
}

const std::optional<FramePath>& DriveContents::mount(const std::string& frame) {
  const auto [mount, is_new] = mounts.try_emplace(frame);
  if (is_new) mount->second = tree.path(base_frame, frame);
  return mount->second;
}

std::optional<Pose3> DriveContents::robot_from_sensor(const std::string& frame, std::int64_t stamp_ns,
                                                      std::int64_t max_gap_ns) {
  const auto& path = mount(frame);
  return path ? path->pose(stamp_ns, max_gap_ns) : std::nullopt;
}

DriveContents read_contents(Recording& recording, const DriveTopics& wanted, const std::string& file,
                            const Warn& warn) {
  const DriveTopics topics = TopicChecker(recording, wanted, file).checked();
  std::set<std::string> wanted_topics(topics.scans.begin(), topics.scans.end());
  for (const Connection& connection : recording.connections()) {
    if (has_transforms(connection.type) || has_odometry(connection.type) ||
        connection.topic == topics.reference)
      wanted_topics.insert(connection.topic);
  }
  ContentsReader reader(topics, file);
  std::map<std::string, std::pair<std::size_t, std::string>> unreadable;
  recording.rewind(wanted_topics);
  while (const auto message = recording.next()) {
    if (!is_readable(*message->connection)) continue;
    try {
      reader.take(*message);
    } catch (const ConfigError& error) {
      auto& [count, first] = unreadable[message->connection->topic];
      if (count++ == 0) first = error.what();
    }
  }
  DriveContents contents = std::move(reader.settle(false));
  for (const std::string& warning : recording.warnings()) warn(warning);
  std::vector<std::string> told;
  for (const auto& [topic, text] : unreadable)
    told.push_back(
        fmt::format("{} messages of {} are left out; the first: {}", text.first, shown(topic), text.second));
  for (const std::string& text : first_of(std::move(told))) warn(fmt::format("{}: {}", file, text));
  return contents;
}

}  // namespace glocal::bags
