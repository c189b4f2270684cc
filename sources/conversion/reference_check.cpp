#include "sources/conversion/reference_check.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/evenly.hpp"
#include "sources/bags/pose_track.hpp"
#include "sources/compressed_file.hpp"
#include "sources/text_lines.hpp"

namespace glocal::conversion {
namespace {

/// Two scans in a row, and how fast the robot was between them by odometry.
struct Stretch {
  const TrackedScan* from = nullptr;
  const TrackedScan* to = nullptr;
  double speed = 0.0;      ///< m/s, without direction.
  double turn_rate = 0.0;  ///< rad/s
};

std::pair<double, double> rates_between(const Pose3& from, const Pose3& to, std::int64_t time_ns) {
  const double s = static_cast<double>(time_ns) * 1e-9;
  return {distance(from, to) / s, wrap_angle(to.heading() - from.heading()) / s};
}

/// At most so many that trying all shifts takes less than a second.
std::vector<Stretch> stretches_of(const std::vector<TrackedScan>& scans) {
  constexpr std::int64_t longest_ns = 1'000'000'000;
  constexpr std::size_t most = 4000;
  std::vector<Stretch> all;
  for (std::size_t i = 1; i < scans.size(); ++i) {
    const std::int64_t time_ns = scans[i].stamp_ns - scans[i - 1].stamp_ns;
    if (time_ns > longest_ns) continue;
    const auto [speed, turn_rate] =
        rates_between(scans[i - 1].odom_from_robot, scans[i].odom_from_robot, time_ns);
    all.push_back({&scans[i - 1], &scans[i], speed, turn_rate});
  }
  std::vector<Stretch> picked;
  for (const std::size_t i : evenly_chosen(all.size(), most)) picked.push_back(all[i]);
  return picked;
}

/// Pearson's correlation of pairs that are added one by one.
class Correlation {
 public:
  void add(double a, double b) {
    ++n_;
    a_ += a;
    b_ += b;
    aa_ += a * a;
    bb_ += b * b;
    ab_ += a * b;
  }
  /// None where a or b is always the same, but for `least` of a standard deviation.
  [[nodiscard]] std::optional<double> value(double least) const {
    const double var_a = aa_ / n_ - a_ * a_ / (n_ * n_), var_b = bb_ / n_ - b_ * b_ / (n_ * n_);
    if (!(var_a > least * least && var_b > least * least)) return std::nullopt;
    return (ab_ / n_ - a_ * b_ / (n_ * n_)) / std::sqrt(var_a * var_b);
  }

 private:
  double n_ = 0.0, a_ = 0.0, b_ = 0.0, aa_ = 0.0, bb_ = 0.0, ab_ = 0.0;
};

constexpr std::size_t least_stretches = 20;

/// The mean of the correlations of speeds and turn rates, as far as these vary.
std::optional<double> correlation_at(const std::vector<Stretch>& stretches, const ReferencePoses& references,
                                     std::int64_t shift_ns) {
  constexpr double least_speed = 0.02, least_turn_rate = 0.02;  // m/s, rad/s
  Correlation speeds, turn_rates;
  std::size_t known = 0;
  for (const Stretch& stretch : stretches) {
    const auto pose_of = [&](const TrackedScan& scan) {
      return references.map_from_robot(scan.stamp_ns - shift_ns, scan.robot_from_sensor);
    };
    const auto from = pose_of(*stretch.from), to = pose_of(*stretch.to);
    if (!from || !to) continue;
    const auto [speed, turn_rate] = rates_between(*from, *to, stretch.to->stamp_ns - stretch.from->stamp_ns);
    speeds.add(stretch.speed, speed);
    turn_rates.add(stretch.turn_rate, turn_rate);
    ++known;
  }
  if (known < least_stretches) return std::nullopt;
  const auto by_speed = speeds.value(least_speed), by_turn = turn_rates.value(least_turn_rate);
  if (by_speed && by_turn) return (*by_speed + *by_turn) / 2.0;
  return by_speed ? by_speed : by_turn;
}

/// Of three values at -1, 0 and 1, the middle one being the largest, where the parabola through them peaks.
double peak_of_parabola(double before, double middle, double after) {
  const double curvature = before - 2.0 * middle + after;
  return curvature < 0.0 ? 0.5 * (before - after) / curvature : 0.0;
}

Pose3 pose_of(const std::array<double, 6>& v) {
  const Quaternion roll = exponential({v[3], 0.0, 0.0}), pitch = exponential({0.0, v[4], 0.0});
  return {{v[0], v[1], v[2]}, composed(composed(turn_about_z(v[5]), pitch), roll)};
}

}  // namespace

std::vector<ReferenceJump> reference_jumps(const std::vector<TrackedScan>& scans) {
  constexpr double least_m = 0.3, least_rad = 0.1745, share = 0.1;
  std::vector<ReferenceJump> jumps;
  const TrackedScan* last = nullptr;
  for (const TrackedScan& scan : scans) {
    if (!scan.map_from_robot) continue;
    const TrackedScan* const before = std::exchange(last, &scan);
    if (before == nullptr) continue;
    const Pose3 by_odometry = inverse(before->odom_from_robot) * scan.odom_from_robot;
    const Pose3 by_reference = inverse(*before->map_from_robot) * *scan.map_from_robot;
    const double way = distance(by_odometry, by_reference);
    const double turn = rotation_between(by_odometry, by_reference);
    if (way > least_m + share * by_odometry.translation().norm() ||
        turn > least_rad + share * angle_of(by_odometry.rotation))
      jumps.push_back({scan.stamp_ns, way, turn});
  }
  return jumps;
}

std::optional<TimeShift> time_shift_of(const DriveTrack& drive, const ReferencePoses& references) {
  constexpr std::int64_t step_ns = 20'000'000;
  constexpr int steps = 100;
  constexpr double least_correlation = 0.5;
  const std::vector<Stretch> stretches = stretches_of(drive.scans);
  const auto unshifted = correlation_at(stretches, references, 0);
  std::vector<double> correlations;
  for (int i = -steps; i <= steps; ++i)
    correlations.push_back(correlation_at(stretches, references, i * step_ns).value_or(-1.0));
  const auto best = std::ranges::max_element(correlations);
  const bool is_inside = best != correlations.begin() && best + 1 != correlations.end();
  if (!unshifted || !is_inside || *best < least_correlation) return std::nullopt;
  const double index = static_cast<double>(best - correlations.begin()) - steps +
                       peak_of_parabola(*(best - 1), *best, *(best + 1));
  return TimeShift{index * static_cast<double>(step_ns) * 1e-9, *best, *unshifted};
}

std::vector<Relation> read_relations(const std::filesystem::path& file) {
  const std::string content = read_decompressed(file);
  std::vector<Relation> relations;
  TextLines lines(content);
  while (lines.next_with_fields()) {
    if (lines.fields().front().starts_with('#')) continue;
    std::vector<double> values;
    for (const std::string_view field : lines.fields()) {
      const auto number = number_in(field);
      if (number && std::isfinite(*number)) values.push_back(*number);
    }
    if (lines.fields().size() != 8 || values.size() != 8)
      throw ConfigError({{file.string(), lines.number(), 0,
                          "is no relation: eight numbers are needed, t1 t2 x y z roll pitch yaw"}});
    for (const double stamp : {values[0], values[1]}) check_stamp(stamp, file.string(), lines.number());
    relations.push_back({nanoseconds_of(values[0]), nanoseconds_of(values[1]),
                         pose_of({values[2], values[3], values[4], values[5], values[6], values[7]})});
  }
  if (relations.empty()) throw ConfigError(file, "has no relations");
  return relations;
}

std::optional<RelationErrors> relation_errors(const std::vector<Relation>& relations,
                                              const std::vector<TrackedScan>& scans,
                                              std::int64_t max_gap_ns) {
  const bags::PoseTrack track = own_references(scans);
  std::vector<double> ways, turns;
  for (const Relation& relation : relations) {
    const auto from = track.at(relation.from_ns, max_gap_ns), to = track.at(relation.to_ns, max_gap_ns);
    if (!from || !to) continue;
    const Pose3 by_reference = inverse(*from) * *to;
    ways.push_back(distance(by_reference, relation.from_robot_to_robot));
    turns.push_back(rotation_between(by_reference, relation.from_robot_to_robot));
  }
  if (ways.empty()) return std::nullopt;
  const auto mean = [](const std::vector<double>& values) {
    return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  };
  std::ranges::sort(ways);
  return RelationErrors{ways.size(), mean(ways), ways[(ways.size() - 1) * 95 / 100], mean(turns)};
}

}  // namespace glocal::conversion
