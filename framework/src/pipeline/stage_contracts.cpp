#include "pipeline/stage_contracts.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string>

namespace glocal {
namespace {

bool is_share(double value) {
  return value >= 0.0 && value <= 1.0;
}

bool is_near(const Vector3& place) {
  return (place.array().abs() <= farthest_m).all();
}

bool is_rotation(const Quaternion& q) {
  constexpr double rounding = 1e-6;
  return std::abs(q.norm() - 1.0) <= rounding;
}

std::string text_of(const Pose3& pose) {
  if (pose.is_planar()) return fmt::format("({}, {}, {})", pose.x, pose.y, pose.heading());
  const Quaternion& q = pose.rotation;
  return fmt::format("({}, {}, {}; {}, {}, {}, {})", pose.x, pose.y, pose.z, q.x(), q.y(), q.z(), q.w());
}

/// What is wrong with a pose; empty if nothing is.
std::string fault_of(const Pose3& pose, Motion motion) {
  if (!is_near(pose.translation()))
    return fmt::format("poses are finite, and at most {} m from the origin along x, y and z", farthest_m);
  if (!is_rotation(pose.rotation)) return "rotations are finite, as quaternions of length 1";
  if (motion == Motion::planar && !pose.is_planar())
    return "where the motion is planar, z is 0 and nothing tilts";
  return "";
}

/// `name` and `values` say what has the pose, with its number if there are several: "hypothesis 3".
template <class... Values>
void check_pose(const Pose3& pose, Motion motion, fmt::format_string<const Values&...> name,
                const Values&... values) {
  const std::string fault = fault_of(pose, motion);
  if (!fault.empty())
    throw BrokenContract(
        fmt::format("{} has the pose {}; {}", fmt::format(name, values...), text_of(pose), fault));
}

/// All |v| <= farthest_m; false for NaN. By their bits, which order as they do, many at a time.
bool are_near(const std::vector<float>& values) {
  constexpr std::uint32_t sign = 0x80000000;
  constexpr auto most = std::bit_cast<std::uint32_t>(static_cast<float>(farthest_m));
  std::uint32_t largest = 0;
  for (const float value : values) largest = std::max(largest, std::bit_cast<std::uint32_t>(value) & ~sign);
  return largest <= most;
}

void check_points(const Points& points, const char* what) {
  require(points.y.size() == points.size() && points.z.size() == points.size(),
          "the {} have {} x, {} y and {} z; give equally many", what, points.x.size(), points.y.size(),
          points.z.size());
  require(are_near(points.x) && are_near(points.y) && are_near(points.z),
          "a value of the {} is not finite, or farther than {} m from the origin", what, farthest_m);
}

void check_normals(const Points& normals, const Points& points) {
  check_points(normals, "normals");
  require(normals.empty() || normals.size() == points.size(),
          "there are {} normals for {} points; give one for each, or none", normals.size(), points.size());
}

}  // namespace

void check_map(const MapData& map, Motion motion) {
  require(!map.points.empty(), "the map has no points");
  require(is_near(map.origin), "the origin is not finite, or farther than {} m from that of the map's frame",
          farthest_m);
  require(motion != Motion::planar || map.origin.z() == 0.0,
          "the origin has the height {} m; where the motion is planar, it is 0", map.origin.z());
  check_points(map.points, "points");
  check_normals(map.normals, map.points);
  const OccupancyGrid& grid = map.grid;
  require(
      grid.width >= 0 && grid.height >= 0 &&
          grid.cells.size() == static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height),
      "the grid has {} cells for {} columns and {} rows", grid.cells.size(), grid.width, grid.height);
  require(grid.cells.empty() || (grid.resolution > 0.0 && grid.resolution <= farthest_m),
          "the grid's resolution is {} m", grid.resolution);
  require(map.resolution >= 0.0 && std::isfinite(map.resolution),
          "the resolution is {} m; it is finite, and 0 where it is not known", map.resolution);
  check_pose(grid.map_from_grid, motion, "the grid");
  for (std::size_t i = 0; i < map.path.size(); ++i) check_pose(map.path[i], motion, "pose {} of the path", i);
}

void check_sample(const Sample& sample, Motion motion) {
  check_observation(sample.observation, motion);
  if (sample.map_from_robot) check_pose(*sample.map_from_robot, motion, "the reference");
}

void check_observation(const Observation& observation, Motion motion) {
  require(std::isfinite(observation.stamp), "the stamp is not finite");
  check_points(observation.scan.hits, "hits");
  check_points(observation.scan.free_ends, "free ends");
  const std::vector<float>& times = observation.scan.times;
  require(times.empty() || times.size() == observation.scan.hits.size(), "there are {} times for {} hits",
          times.size(), observation.scan.hits.size());
  require(std::ranges::all_of(times, [](float time) { return std::isfinite(time); }),
          "a hit's time is not finite");
  const Point& origin = observation.scan.origin;
  require(is_near({origin.x, origin.y, origin.z}),
          "the sensor's origin is not finite, or farther than {} m from the robot's", farthest_m);
  check_pose(observation.odom_from_robot, motion, "the odometry");
}

void check_local_map(const LocalMap& local, Motion motion) {
  check_points(local.points, "points");
  check_normals(local.normals, local.points);
  check_pose(local.local_from_robot, motion, "the robot in local map {}", local.epoch);
  require(
      std::ranges::is_sorted(local.ends) && (local.ends.empty() || local.ends.back() <= local.points.size()),
      "`ends` falls, or reaches beyond the {} points", local.points.size());
}

void check_threshold(double omega_max) {
  require(is_share(omega_max), "omega_max() is {}, not in [0, 1]", omega_max);
}

void check_hypotheses(const std::vector<Hypothesis>& hypotheses, double omega_max, Motion motion) {
  double before = 1.0;
  for (std::size_t i = 0; i < hypotheses.size(); ++i) {
    const Hypothesis& hypothesis = hypotheses[i];
    check_pose(hypothesis.map_from_local, motion, "hypothesis {}", i);
    require(is_share(hypothesis.quality), "hypothesis {} has the quality {}, not in [0, 1]", i,
            hypothesis.quality);
    require(hypothesis.score >= omega_max, "hypothesis {} has the score {}, below omega_max = {}", i,
            hypothesis.score, omega_max);
    require(hypothesis.score <= before,
            "hypothesis {} has the score {}, above {}; scores fall, from 1 at most", i, hypothesis.score,
            before);
    require(hypothesis.support > 0, "hypothesis {} has no support; it stands for itself at least", i);
    before = hypothesis.score;
  }
}

void check_clusters(const std::vector<Cluster>& clusters, std::size_t hypotheses, Motion motion) {
  std::vector<char> in_cluster(hypotheses, 0);
  std::size_t members = 0;
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    require(!clusters[i].members.empty(), "cluster {} is empty; none may be", i);
    check_pose(clusters[i].map_from_robot, motion, "cluster {}", i);
    for (const std::size_t member : clusters[i].members) {
      require(member < hypotheses, "cluster {} has hypothesis {}, but there are {}", i, member, hypotheses);
      require(in_cluster[member] == 0, "hypothesis {} is in two clusters, or twice in one", member);
      in_cluster[member] = 1;
      ++members;
    }
  }
  require(members == hypotheses, "{} of {} hypotheses are in no cluster; each belongs to one",
          hypotheses - members, hypotheses);
}

void check_ratings(const std::vector<Rating>& ratings, std::size_t clusters) {
  require(ratings.size() == clusters, "there are {} ratings for {} clusters", ratings.size(), clusters);
  if (ratings.empty()) return;
  constexpr double rounding = 1e-6;
  double sum = 0.0;
  for (std::size_t i = 0; i < ratings.size(); ++i) {
    require(is_share(ratings[i].r), "rating {} has r = {}, not in [0, 1]", i, ratings[i].r);
    require(ratings[i].r_normalised >= 0.0, "rating {} has r_normalised = {}, below 0", i,
            ratings[i].r_normalised);
    sum += ratings[i].r_normalised;
  }
  require(std::abs(sum - 1.0) <= rounding, "the r_normalised add up to {}, not to 1", sum);
}

void check_verdict(const Verdict& verdict, Motion motion) {
  using enum VerdictKind;
  require(verdict.kind != unknown_place, "the verdict is unknown_place, which is not a rule's to say");
  require((verdict.kind == localized) == verdict.map_from_robot.has_value(),
          "the verdict is {}, {} a pose; a pose is given when localized, and only then",
          to_string(verdict.kind), verdict.map_from_robot ? "with" : "without");
  if (verdict.map_from_robot) check_pose(*verdict.map_from_robot, motion, "the verdict");
  require(verdict.kind != ambiguous || !verdict.candidates.empty(),
          "the verdict is ambiguous, without candidates");
  for (std::size_t i = 0; i < verdict.candidates.size(); ++i)
    check_pose(verdict.candidates[i], motion, "candidate {}", i);
  if (!verdict.estimate) return;
  check_pose(verdict.estimate->map_from_robot, motion, "the estimate");
  require(is_share(verdict.estimate->confidence), "the estimate has the confidence {}, not in [0, 1]",
          verdict.estimate->confidence);
}

void check_verification(const Verification& verification, Motion motion) {
  check_hypotheses(verification.rivals, 0.0, motion);
  require(is_share(verification.margin), "the margin is {}, not in [0, 1]", verification.margin);
  require(verification.near.translation >= 0.0 && verification.near.rotation >= 0.0,
          "rivals are {} m away and turned by {} rad, which is below 0", verification.near.translation,
          verification.near.rotation);
  if (!verification.certificate) return;
  const Certificate& certificate = *verification.certificate;
  require(is_share(certificate.contact) && is_share(certificate.at_most),
          "the certificate tells shares of {} and {}, not in [0, 1]", certificate.contact,
          certificate.at_most);
}

}  // namespace glocal
