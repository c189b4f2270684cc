#include "sources/live/answers.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "sources/bags/cdr_writer.hpp"

namespace glocal::live {
namespace {

using bags::CdrWriter;
using bags::Header;

const LiveTopic initial_pose{"/initialpose", "geometry_msgs/PoseWithCovarianceStamped"};
const LiveTopic best_pose{"/glocal/pose", "geometry_msgs/PoseWithCovarianceStamped"};
const LiveTopic candidates{"/glocal/candidates", "geometry_msgs/PoseArray"};
const LiveTopic diagnostics{"/diagnostics", "diagnostic_msgs/DiagnosticArray"};
const LiveTopic tf{"/tf", "tf2_msgs/TFMessage"};

/// From one transform to the next one while the robot stands; odometry of several senders need not agree.
constexpr std::int64_t between_tf_ns = 100'000'000;
constexpr std::int64_t longest_way_back_ns = 1'000'000'000;

/// In a frame where all headings are larger by an angle, rad.
PoseCovariance turned(const PoseCovariance& a, double angle) {
  const double c = std::cos(angle);
  const double s = std::sin(angle);
  return {.xx = c * c * a.xx - 2.0 * c * s * a.xy + s * s * a.yy,
          .xy = c * s * (a.xx - a.yy) + (c * c - s * s) * a.xy,
          .xt = c * a.xt - s * a.yt,
          .yy = s * s * a.xx + 2.0 * c * s * a.xy + c * c * a.yy,
          .yt = s * a.xt + c * a.yt,
          .tt = a.tt};
}

/// Of x, y, z and rotations about x, y and z, row by row; what is not known is 0.
std::array<double, 36> rows_of(const std::optional<PoseCovariance>& covariance) {
  std::array<double, 36> rows{};
  if (!covariance) return rows;
  const PoseCovariance& c = *covariance;
  constexpr std::size_t x = 0, y = 1, heading = 5;
  const auto set = [&](std::size_t row, std::size_t column, double value) {
    rows.at(row * 6 + column) = rows.at(column * 6 + row) = value;
  };
  set(x, x, c.xx);
  set(x, y, c.xy);
  set(y, y, c.yy);
  set(x, heading, c.xt);
  set(y, heading, c.yt);
  set(heading, heading, c.tt);
  return rows;
}

std::string pose_message(const Header& header, const Pose3& pose,
                         const std::optional<PoseCovariance>& covariance) {
  CdrWriter writer;
  writer.header(header).rigid_motion(pose);
  for (const double value : rows_of(covariance)) writer.number(value);
  return writer.message();
}

std::string poses_message(const Header& header, const std::vector<Pose3>& poses) {
  CdrWriter writer;
  writer.header(header).count(poses.size());
  for (const Pose3& pose : poses) writer.rigid_motion(pose);
  return writer.message();
}

/// 0 is ok, 1 a warning, 2 an error.
std::uint8_t level_of(const StepResult& result) {
  if (result.setup && result.setup->fault) return 2;
  return result.verdict.kind == VerdictKind::localized ? 0 : 1;
}

std::string diagnostics_message(const StepResult& result, const GlobalMap& map, const Header& header,
                                std::size_t passed_over) {
  std::vector<std::pair<std::string, std::string>> values = {{"verdict", to_string(result.verdict.kind)},
                                                             {"step", fmt::format("{}", result.step)},
                                                             {"passed_over", fmt::format("{}", passed_over)}};
  if (result.verdict.estimate)
    values.emplace_back("confidence", fmt::format("{:.4f}", result.verdict.estimate->confidence));
  if (!map.parts().empty()) {
    if (const auto best = result.estimate()) values.emplace_back("map", map.place_of(*best).map);
    std::vector<std::string> maps;
    for (const Pose3& pose : result.verdict.candidates) maps.push_back(map.place_of(pose).map);
    values.emplace_back("candidates_on", fmt::format("{}", fmt::join(maps, ", ")));
  }
  for (const Evidence& evidence : result.verdict.evidence)
    values.emplace_back(evidence.name, fmt::format("{:.4f}", evidence.value));
  CdrWriter writer;
  writer.header(header).count(1).number(level_of(result));
  writer.text("glocal: localization").text(result.verdict.why).text("glocal").count(values.size());
  for (const auto& [key, value] : values) writer.text(key).text(value);
  return writer.message();
}

}  // namespace

Answers::Answers(MessageLink& link, const GlobalMap& map, std::string name_space, Frames frames)
    : link_(link), map_(map), name_space_(std::move(name_space)), frames_(std::move(frames)) {
  std::vector<LiveTopic> topics = {initial_pose, best_pose, candidates, diagnostics};
  if (frames_.publishes_tf) topics.push_back(tf);
  for (const LiveTopic& topic : topics)
    link_.advertise({name_space_ + topic.name, topic.type}, Delivery::reliable);
}

void Answers::tell(const StepResult& result, std::int64_t stamp_ns, const Pose3& odom_from_robot,
                   std::size_t passed_over) {
  const auto header = [&](const MapPlace& place) {
    return Header{stamp_ns, place.map.empty() ? frames_.map : place.map};
  };
  const auto publish_pose = [&](const LiveTopic& topic, const Pose3& pose) {
    const MapPlace place = map_.place_of(pose);
    std::optional<PoseCovariance> covariance;
    if (const auto& estimate = result.verdict.estimate; estimate && estimate->covariance)
      covariance = turned(*estimate->covariance, place.map_from_robot.heading() - pose.heading());
    publish(topic, pose_message(header(place), place.map_from_robot, covariance));
  };
  const Header common{stamp_ns, frames_.map};
  const bool is_declared = result.verdict.kind == VerdictKind::localized;
  if (const auto best = result.estimate()) publish_pose(best_pose, *best);
  if (is_declared && !is_declared_) publish_pose(initial_pose, *result.verdict.map_from_robot);
  is_declared_ = is_declared;
  publish(candidates, poses_message(common, result.verdict.candidates));
  publish(diagnostics, diagnostics_message(result, map_, common, passed_over));
  map_to_odom_.reset();
  if (!frames_.publishes_tf || !is_declared) return;
  const MapPlace place = map_.place_of(*result.verdict.map_from_robot);
  map_to_odom_ = {header(place), frames_.odom, place.map_from_robot * inverse(odom_from_robot)};
  // tf listens to the newest stamp, and takes each one once.
  const bool is_behind = stamp_ns <= tf_ns_ && tf_ns_ - stamp_ns < longest_way_back_ns;
  publish_tf(is_behind ? tf_ns_ + 1 : stamp_ns);
}

void Answers::tell_again(std::int64_t odometry_ns) {
  const std::int64_t since = odometry_ns - tf_ns_;
  // After a stamp in the future it goes on.
  const bool is_due = since >= between_tf_ns || since <= -longest_way_back_ns;
  if (map_to_odom_ && is_due) publish_tf(odometry_ns);
}

void Answers::publish_tf(std::int64_t stamp_ns) {
  map_to_odom_->header.stamp_ns = tf_ns_ = stamp_ns;
  publish(tf, bags::serialized(std::vector{*map_to_odom_}));
}

void Answers::publish(const LiveTopic& topic, const std::string& bytes) {
  link_.publish({name_space_ + topic.name, topic.type}, Delivery::reliable, bytes);
}

}  // namespace glocal::live
