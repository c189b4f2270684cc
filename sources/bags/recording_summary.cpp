#include "sources/bags/recording_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/bags/message_reader.hpp"

namespace glocal::bags {
namespace {

/// A robot has some dozens. More are not noted, whatever a damaged file says.
constexpr std::size_t most_frames = 10'000, deepest_frame = 50;

/// The way along poses that come one after the other.
struct DrivenWay {
  std::optional<Pose3> last;
  double length_m = 0.0;

  void go_to(const Pose3& pose) {
    if (last) length_m += distance(*last, pose);
    last = pose;
  }
};

class Summarizer {
 public:
  void take(const RecordedMessage& message) {
    RecordingSummary& s = summary_;
    if (s.messages++ == 0) s.first_ns = message.stamp_ns;
    s.last_ns = std::max(s.last_ns, message.stamp_ns);
    TopicSummary& topic = topics_[{message.connection->topic, message.connection->type}];
    if (topic.messages++ == 0) topic.first_ns = message.stamp_ns;
    topic.last_ns = message.stamp_ns;
    try {
      if (is_readable(*message.connection)) look_into(message, topic);
    } catch (const ConfigError& error) {
      if (topic.unreadable++ == 0) remarks_.emplace_back(error.what());
    }
  }

  void name(const Connection& connection) {
    TopicSummary& topic = topics_[{connection.topic, connection.type}];
    topic.topic = connection.topic;
    topic.type = connection.type;
    topic.encoding = connection.encoding;
  }

  RecordingSummary finish(std::vector<std::string>& remarks) {
    for (std::string& remark : first_of(std::move(remarks_))) remarks.push_back(std::move(remark));
    for (auto& [key, topic] : topics_) summary_.topics.push_back(std::move(topic));
    choose_odometry();
    return std::move(summary_);
  }

 private:
  void look_into(const RecordedMessage& message, TopicSummary& topic) {
    const std::string& type = message.connection->type;
    if (type == "sensor_msgs/LaserScan") {
      LaserScan scan = read_laser_scan(message);
      note_frame(scan.header.frame, topic);
      if (!topic.first_scan) topic.first_scan = std::move(scan);
    } else if (type == "sensor_msgs/PointCloud2") {
      note_frame(read_point_cloud(message).header.frame, topic);
    } else if (type == "nav_msgs/Odometry") {
      const Odometry odometry = read_odometry(message);
      note_frame(odometry.header.frame, topic);
      by_odometry_[topic.topic].go_to(odometry.frame_from_child);
    } else if (type == "nav_msgs/OccupancyGrid") {
      note_frame(read_occupancy_grid(message).header.frame, topic);
    } else if (is_pose(type)) {
      note_frame(read_pose(message).header.frame, topic);
    } else if (has_transforms(type)) {
      for (const FrameTransform& transform : read_transforms(message)) {
        note_frame(transform.header.frame, topic);
        note_transform(transform);
      }
    }
  }

  static void note_frame(const std::string& frame, TopicSummary& topic) {
    if (topic.frames.size() < most_frames) topic.frames.insert(frame);
  }

  void note_transform(const FrameTransform& transform) {
    auto& parents = summary_.parents;
    if (parents.size() >= most_frames && !parents.contains(transform.child_frame)) return;
    parents[transform.child_frame] = transform.header.frame;
    if (transform.header.frame == "odom")
      by_tf_["odom -> " + transform.child_frame].go_to(transform.parent_from_child);
  }

  void choose_odometry() {
    const auto& ways = by_odometry_.empty() ? by_tf_ : by_odometry_;
    if (ways.empty()) return;
    summary_.odometry = ways.begin()->first;
    summary_.path_m = ways.begin()->second.length_m;
  }

  RecordingSummary summary_;
  std::map<std::pair<std::string, std::string>, TopicSummary> topics_;
  std::map<std::string, DrivenWay> by_odometry_, by_tf_;
  std::vector<std::string> remarks_;
};

/// Writes the frames below a root, as deep as they go, until there are enough lines.
class TreeText {
 public:
  TreeText(const std::map<std::string, std::string>& parents, std::size_t most_lines)
      : parents_(parents), most_lines_(most_lines) {
    for (const auto& [child, parent] : parents) children_[parent].push_back(child);
  }

  std::string text() {
    for (const auto& [parent, own] : children_) {
      if (!parents_.contains(parent)) add(parent, 0);
    }
    if (lines_ <= most_lines_) return std::move(text_);
    return fmt::format("{}and {} more\n", text_, lines_ - most_lines_);
  }

 private:
  void add(const std::string& frame, std::size_t depth) {
    const bool is_too_deep = depth >= deepest_frame;
    if (++lines_ <= most_lines_)
      text_ += std::string(2 * depth, ' ') + (is_too_deep ? "…" : shown(frame)) + "\n";
    const auto own = children_.find(frame);
    if (is_too_deep || own == children_.end()) return;
    for (const std::string& child : own->second) add(child, depth + 1);
  }

  const std::map<std::string, std::string>& parents_;
  std::map<std::string, std::vector<std::string>> children_;
  std::size_t most_lines_, lines_ = 0;
  std::string text_;
};

}  // namespace

double TopicSummary::rate_hz() const {
  if (messages < 2 || last_ns <= first_ns) return 0.0;
  return static_cast<double>(messages - 1) / (static_cast<double>(last_ns - first_ns) * 1e-9);
}

RecordingSummary summarize_recording(Recording& recording, std::vector<std::string>& remarks) {
  Summarizer summarizer;
  std::set<std::string> foreign;
  for (const Connection& connection : recording.connections()) {
    summarizer.name(connection);
    if (!is_readable(connection)) foreign.insert(connection.encoding);
  }
  if (!foreign.empty())
    remarks.push_back(fmt::format("messages encoded as {} are counted, but not read", listed(foreign)));
  recording.rewind();
  while (const auto message = recording.next()) summarizer.take(*message);
  return summarizer.finish(remarks);
}

std::string text_of(const LaserScan& scan) {
  return fmt::format("{} beams over {:.1f} deg, range {:.2f} to {:.2f} m", scan.ranges.size(),
                     degrees(scan.angle_max - scan.angle_min), scan.range_min, scan.range_max);
}

std::string text_of(const TopicSummary& topic) {
  return fmt::format("{}: {:.1f} Hz, {}, frame {}", shown(topic.topic), topic.rate_hz(),
                     topic.first_scan ? text_of(*topic.first_scan) : shown(topic.type),
                     listed(topic.frames, " "));
}

std::string frame_tree(const std::map<std::string, std::string>& parents, std::size_t most_lines) {
  return TreeText(parents, most_lines).text();
}

}  // namespace glocal::bags
