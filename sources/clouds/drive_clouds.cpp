#include "sources/clouds/drive_clouds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <system_error>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "sources/clouds/cloud_file.hpp"
#include "sources/clouds/trajectory_file.hpp"
#include "sources/text_lines.hpp"

namespace glocal::clouds {
namespace {

namespace fs = std::filesystem;

std::vector<DriveCloud> clouds_in(const fs::path& folder) {
  std::error_code error;
  std::vector<DriveCloud> clouds;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
    if (has_name_of_cloud(entry.path())) clouds.push_back({entry.path(), 0.0, {}, {}});
  }
  if (error) throw ConfigError(folder, "cannot be read as a folder: " + error.message());
  if (clouds.empty()) throw ConfigError(folder, "has no clouds (*.pcd, *.ply, *.bin); give another folder");
  return clouds;
}

/// Sets stamps from names, if all have one; false if not.
bool set_stamps(std::vector<DriveCloud>& clouds) {
  for (DriveCloud& cloud : clouds) {
    const auto stamp = stamp_in_name(cloud.file);
    if (!stamp) return false;
    if (const std::string fault = fault_of_stamp(*stamp); !fault.empty())
      throw ConfigError(cloud.file, fault);
    cloud.stamp = *stamp;
  }
  return true;
}

void sort_clouds(std::vector<DriveCloud>& clouds, bool have_stamps) {
  std::ranges::sort(clouds, [&](const DriveCloud& a, const DriveCloud& b) {
    return have_stamps && a.stamp != b.stamp ? a.stamp < b.stamp : a.file < b.file;
  });
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    if (!have_stamps) {
      clouds[i].stamp = static_cast<double>(i);
    } else if (i > 0 && clouds[i].stamp == clouds[i - 1].stamp) {
      throw ConfigError(clouds[i].file, fmt::format("has the same number as '{}'; remove one of the two",
                                                    clouds[i - 1].file.filename().string()));
    }
  }
}

/// A cloud has the pose of the nearest stamp, which is at most this far from its own, s.
constexpr double max_stamp_difference = 0.02;

/// The pose of the stamp nearest to this one; null if it is not that near.
const StampedPose* nearest_pose(const std::vector<StampedPose>& poses, double stamp) {
  const auto after = std::lower_bound(poses.begin(), poses.end(), stamp,
                                      [](const StampedPose& p, double s) { return p.stamp < s; });
  const StampedPose* nearest = nullptr;
  double least = max_stamp_difference;
  for (auto it = after == poses.begin() ? after : after - 1; it != poses.end() && it <= after; ++it) {
    const double difference = std::abs(it->stamp - stamp);
    if (difference > least) continue;
    least = difference;
    nearest = &*it;
  }
  return nearest;
}

/// Whether numbers of clouds and stamps of poses, as many of both, are on different scales, as 0, 1, 2 … and
/// 0.0, 0.1, 0.2 … are.
bool differ_in_scale(const std::vector<DriveCloud>& clouds, const std::vector<StampedPose>& poses) {
  constexpr double alike = 1.1;
  const auto [shorter, longer] =
      std::minmax({clouds.back().stamp - clouds.front().stamp, poses.back().stamp - poses.front().stamp});
  return longer > alike * shorter;
}

/// Whether the numbers may count the clouds, but the stamps are times.
bool are_counts_and_times(const std::vector<DriveCloud>& clouds, const std::vector<StampedPose>& poses) {
  const auto is_whole = [](const auto& stamped) {
    return std::abs(stamped.stamp - std::round(stamped.stamp)) <= max_stamp_difference;
  };
  return std::ranges::all_of(clouds, is_whole) && !std::ranges::all_of(poses, is_whole);
}

/// Whether the `near` clouds that have a stamp near their number have it by chance.
bool are_near_by_chance(std::size_t near, const std::vector<DriveCloud>& clouds,
                        const std::vector<StampedPose>& poses) {
  if (near == clouds.size()) return false;
  if (poses.size() == clouds.size()) return differ_in_scale(clouds, poses);
  return 2 * near < clouds.size() && are_counts_and_times(clouds, poses);
}

/// Gives each cloud its pose of the trajectory in `file`, if it has one; answers how many have.
std::size_t give_poses(std::vector<DriveCloud>& clouds, bool have_stamps, const fs::path& file,
                       const DriveFiles& files, std::optional<Pose3> DriveCloud::*pose) {
  const Trajectory trajectory = read_trajectory(file);
  std::size_t given = 0;
  for (DriveCloud& cloud : clouds) {
    if (!have_stamps || !trajectory.has_stamps) break;
    const StampedPose* nearest = nearest_pose(trajectory.poses, cloud.stamp);
    if (nearest == nullptr) continue;
    cloud.*pose = nearest->pose;
    ++given;
  }
  if (given > 0 && !are_near_by_chance(given, clouds, trajectory.poses)) return given;
  if (trajectory.poses.size() != clouds.size()) {
    const char* const why =
        given == 0 ? "no stamp is the number of a cloud; give the trajectory of these clouds"
                   : "its stamps are times, where the numbers of the clouds count them; give one pose for "
                     "each cloud, or stamps that are the clouds' numbers";
    throw ConfigError(file, fmt::format("has {} poses for {} clouds in {}, and {}", trajectory.poses.size(),
                                        clouds.size(), files.folder.string(), why));
  }
  for (std::size_t i = 0; i < clouds.size(); ++i) clouds[i].*pose = trajectory.poses[i].pose;
  return clouds.size();
}

/// "1305031102" of "cloud_1305031102_175304000", the time in seconds and nanoseconds, whose last separator is
/// there.
std::optional<double> seconds_before(const std::string& name, std::size_t separator) {
  constexpr std::size_t digits_of_seconds = 10;  // since 2001
  if (separator == std::string::npos || separator < digits_of_seconds) return std::nullopt;
  if (name[separator] != '_' && name[separator] != '-') return std::nullopt;
  const std::size_t before = name.find_last_not_of("0123456789", separator - 1);
  const std::size_t begin = before == std::string::npos ? 0 : before + 1;
  return separator - begin == digits_of_seconds ? number_in(name.substr(begin, digits_of_seconds))
                                                : std::nullopt;
}

}  // namespace

std::optional<double> stamp_in_name(const fs::path& file) {
  // All endings: "7.pcd.gz" is number 7, but 1305031102.175304.pcd has its decimals.
  std::string name = file.filename().string();
  for (const char* ending : {".gz", ".bz2", ".xz", ".pcd", ".ply", ".bin"}) {
    if (name.ends_with(ending)) name.erase(name.rfind('.'));
  }
  const std::size_t before = name.find_last_not_of("0123456789.");
  std::string digits = before == std::string::npos ? name : name.substr(before + 1);
  // In "frame.000123" the dot parts the number from the name, and is none of its decimals.
  if (before != std::string::npos) digits.erase(0, digits.find_first_not_of('.'));
  const auto number = number_in(digits);
  if (!number) return std::nullopt;
  // Counts have fewer digits, and so have seconds.
  constexpr double first_of_microseconds = 1e15, microseconds = 1e6;
  constexpr double first_of_nanoseconds = 1e16, nanoseconds = 1e9;
  if (const auto seconds = seconds_before(name, before); seconds && digits.size() == 9)
    return *seconds + *number / nanoseconds;
  if (*number >= first_of_nanoseconds) return *number / nanoseconds;
  return *number >= first_of_microseconds ? *number / microseconds : *number;
}

std::vector<DriveCloud> drive_clouds(const DriveFiles& files, const Warn& warn) {
  std::vector<DriveCloud> clouds = clouds_in(files.folder);
  const bool have_stamps = set_stamps(clouds);
  sort_clouds(clouds, have_stamps);
  if (!files.odometry.empty()) {
    const std::size_t given = give_poses(clouds, have_stamps, files.odometry, files, &DriveCloud::odometry);
    if (given < clouds.size()) {
      const auto without = std::ranges::find_if(clouds, [](const DriveCloud& c) { return !c.odometry; });
      throw ConfigError(
          files.odometry,
          fmt::format("has a pose for {} of {} clouds; there is none within {} s of '{}'; move the "
                      "clouds without odometry away",
                      given, clouds.size(), max_stamp_difference, without->file.filename().string()));
    }
  }
  if (!files.reference.empty()) {
    const std::size_t given = give_poses(clouds, have_stamps, files.reference, files, &DriveCloud::reference);
    if (given < clouds.size())
      warn(fmt::format("{}: has a pose for {} of {} clouds; the others have no reference",
                       files.reference.string(), given, clouds.size()));
  }
  return clouds;
}

}  // namespace glocal::clouds
