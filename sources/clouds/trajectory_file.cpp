#include "sources/clouds/trajectory_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "glocal/words.hpp"
#include "sources/compressed_file.hpp"
#include "sources/text_lines.hpp"

namespace glocal::clouds {
namespace {

constexpr std::size_t tum_values = 8, kitti_values = 12;
/// How far a rotation may be from one: files have six digits or more.
constexpr double rounding = 1e-3;

/// The lines of a trajectory, with their values.
class PoseLines {
 public:
  PoseLines(std::string_view content, const std::string& file) : file_(file), lines_(content) {}

  /// Goes to the next pose; false at the end.
  bool next() {
    do {
      if (!lines_.next_with_fields()) return false;
    } while (lines_.fields().front().starts_with('#'));
    read_values();
    return true;
  }
  [[nodiscard]] const std::vector<double>& values() const { return values_; }

  [[nodiscard]] Vector3 place(double x, double y, double z) const {
    for (const double v : {x, y, z}) {
      if (std::abs(v) > farthest_m)
        refuse(fmt::format("has a coordinate of {:g} m, at most {:g} are allowed", v, farthest_m));
    }
    return {x, y, z};
  }

  [[nodiscard]] Pose3 tum_pose() const {
    const auto& v = values_;
    const Quaternion q{v[7], v[4], v[5], v[6]};
    const double length = q.norm();
    if (std::abs(length - 1.0) > rounding)
      refuse(fmt::format("the quaternion has a length of {:.4g} instead of 1; its order is qx qy qz qw",
                         length));
    return {place(v[1], v[2], v[3]), q.normalized()};
  }

  [[nodiscard]] Pose3 kitti_pose() const {
    const auto& v = values_;
    Eigen::Matrix3d matrix;
    matrix << v[0], v[1], v[2], v[4], v[5], v[6], v[8], v[9], v[10];
    if (!is_rotation(matrix)) refuse("the first three columns are no rotation matrix; get a fresh copy");
    return {place(v[3], v[7], v[11]), Quaternion(matrix).normalized()};
  }

  [[noreturn]] void refuse(std::string message) const {
    throw ConfigError({{file_, lines_.number(), 0, std::move(message)}});
  }

 private:
  void read_values() {
    const auto& fields = lines_.fields();
    if (fields.size() != tum_values && fields.size() != kitti_values)
      refuse(
          fmt::format("has {} values; TUM's poses have 8 (stamp tx ty tz qx qy qz qw), KITTI's 12 (three "
                      "rows of four)",
                      fields.size()));
    if (!values_.empty() && values_.size() != fields.size())
      refuse(fmt::format("has {} values, the poses before have {}; put the line right or delete it",
                         fields.size(), values_.size()));
    values_.clear();
    for (const std::string_view field : fields) {
      const auto number = number_in(field);
      if (!number || !std::isfinite(*number))
        refuse(fmt::format("'{}' is not a finite number", shown(field)));
      values_.push_back(*number);
    }
  }

  /// Whether columns have length 1, right angles between them, and no mirror.
  static bool is_rotation(const Eigen::Matrix3d& m) {
    const Eigen::Matrix3d off = m.transpose() * m - Eigen::Matrix3d::Identity();
    return (off.array().abs() <= rounding).all() && m.determinant() > 0.0;
  }

  const std::string& file_;
  TextLines lines_;
  std::vector<double> values_;
};

}  // namespace

Trajectory parse_trajectory(std::string_view content, const std::string& file) {
  Trajectory trajectory;
  for (PoseLines lines(content, file); lines.next();) {
    trajectory.has_stamps = lines.values().size() == tum_values;
    const auto index = static_cast<double>(trajectory.poses.size());
    const double stamp = trajectory.has_stamps ? lines.values().front() : index;
    if (const std::string fault = fault_of_stamp(stamp); !fault.empty()) lines.refuse(fault);
    if (!trajectory.poses.empty() && stamp < trajectory.poses.back().stamp)
      lines.refuse(fmt::format("the stamp {} is before {}, that of the pose before; sort the lines", stamp,
                               trajectory.poses.back().stamp));
    trajectory.poses.push_back({stamp, trajectory.has_stamps ? lines.tum_pose() : lines.kitti_pose()});
  }
  if (trajectory.poses.empty())
    throw ConfigError(file, "has no poses; TUM's or KITTI's are needed, one a line");
  return trajectory;
}

Trajectory read_trajectory(const std::filesystem::path& file) {
  return parse_trajectory(read_decompressed(file), file.string());
}

}  // namespace glocal::clouds
