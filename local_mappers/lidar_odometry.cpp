#include "local_mappers/lidar_odometry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "glocal/voxel_filter.hpp"
#include "local_mappers/first_pose.hpp"

namespace glocal::local_mappers {
namespace {

/// Share of a scan's hits that must have found a point of the map. A scan that does not fit moves the robot
/// as predicted and adds no points.
constexpr double min_fit = 0.3;

/// The distance of the farthest hit from the sensor, m.
double farthest_range(const Scan& scan) {
  double most = 0.0;
  for (std::size_t i = 0; i < scan.hits.size(); ++i) {
    most = std::max(most, (as_vector(scan.hits[i]) - as_vector(scan.origin)).norm());
  }
  return most;
}

}  // namespace

void describe(ParamVisitor& v, LidarOdometry::Params& p) {
  v.field("surfaces", p.surfaces, {.doc = "Points of the map and their normals."});
  v.field("scan_voxel", p.scan_voxel,
          {.doc = "Side of the voxels whose hits are replaced by their mean before a scan is registered. The "
                  "map gets all hits.",
           .unit = "m",
           .max = 100.0,
           .above = 0.001,
           .audience = Audience::tuner});
  v.field("prediction", p.prediction,
          {.doc = "Where the search for the next pose begins: by odometry, or with the last step once more "
                  "(constant_velocity); either is odometry, but the last step where odometry stands still or "
                  "there is none.",
           .choices = {"odometry", "constant_velocity", "either"}});
  v.field(
      "deskew", p.deskew,
      {.doc = "By which motion a scan that was made in motion is put right, if its hits have times: that of "
              "odometry since the last observation, or the last step (velocity); odometry is the last "
              "step, too, where odometry stands still or there is none.",
       .choices = {"none", "velocity", "odometry"}});
  v.field("scans", p.scans,
          {.doc = "A point is forgotten that none of the last observations has hit, so many of them; 0 sets "
                  "no such limit.",
           .min = 0,
           .max = 1e6,
           .audience = Audience::expert});
  v.field(
      "distance", p.distance,
      {.doc = "A point is forgotten that was not hit on the last way of this length; 0 sets no such limit.",
       .unit = "m",
       .min = 0.0,
       .audience = Audience::tuner});
  v.require(p.scans > 0 || p.distance > 0.0, "scans", "either scans or distance must be above 0");
}

double AdaptiveThreshold::sigma() const {
  return std::sqrt(sum_ / corrections_);
}

void AdaptiveThreshold::note(const Pose3& correction, double range) {
  const double delta =
      correction.translation().norm() + 2.0 * range * std::sin(angle_of(correction.rotation) / 2.0);
  if (delta <= least_) return;
  sum_ += delta * delta;
  corrections_ += 1.0;
}

LidarOdometry::LidarOdometry(const Params& params, const StageSetup& setup)
    : params_(params),
      motion_(setup.motion),
      map_(params.surfaces),
      threshold_(initial_threshold, min_correction) {}

void LidarOdometry::reset() {
  map_.reset();
  threshold_ = {initial_threshold, min_correction};
  odom_from_last_.reset();
  last_from_robot_ = {};
  last_step_seconds_ = last_stamp_ = 0.0;
  misfits_ = 0;
  travelled_ = forgotten_at_ = 0.0;
  since_forgetting_ = 0;
}

void LidarOdometry::add(const Observation& observation) {
  const std::optional<Scan> still =
      params_.deskew == "none" ? std::nullopt : deskewed(observation.scan, motion_in_scan(observation));
  const Scan& scan = still ? *still : observation.scan;
  const Pose3& odom_from_robot = observation.odom_from_robot;
  const int misfits_before = misfits_;
  if (odom_from_last_) {
    const Pose3 local_from_last = map().local_from_robot;
    map_.move_robot(match(scan, predicted(odom_from_robot)));
    last_from_robot_ = inverse(local_from_last) * map().local_from_robot;
    last_step_seconds_ = observation.stamp - last_stamp_;
    travelled_ += last_from_robot_.translation().norm();
  } else {
    map_.move_robot(first_pose(odom_from_robot, motion_));
  }
  odom_from_last_ = odom_from_robot;
  last_stamp_ = observation.stamp;
  if (misfits_ >= params_.restart_after ||
      map().local_from_robot.translation().norm() > SurfaceMap::reach / 2) {
    map_.start_over();
    map_.move_robot(first_pose(odom_from_robot, motion_));
    misfits_ = 0;
  }
  const Pose3& local_from_robot = map().local_from_robot;
  map_.add(misfits_ > misfits_before ? Points{} : moved(scan.hits, local_from_robot),
           as_point(local_from_robot * as_vector(scan.origin)), travelled_);
  forget();
}

Pose3 LidarOdometry::predicted(const Pose3& odom_from_robot) const {
  const bool by_velocity = params_.prediction == "constant_velocity" ||
                           (params_.prediction == "either" && odom_from_robot == *odom_from_last_);
  return map().local_from_robot *
         (by_velocity ? last_from_robot_ : inverse(*odom_from_last_) * odom_from_robot);
}

SteadyMotion LidarOdometry::motion_in_scan(const Observation& observation) const {
  if (!odom_from_last_) return {};
  const bool by_velocity = params_.deskew == "velocity" || observation.odom_from_robot == *odom_from_last_;
  if (by_velocity) return {last_from_robot_, last_step_seconds_};
  return {inverse(*odom_from_last_) * observation.odom_from_robot, observation.stamp - last_stamp_};
}

Pose3 LidarOdometry::match(const Scan& scan, const Pose3& prediction) {
  const Points hits = voxel_downsampled(scan.hits, params_.scan_voxel);
  if (map().points.empty() || hits.size() < min_matches) return prediction;
  const double sigma = threshold_.sigma();
  const MatchLimits limits{.match_distance = std::min(3.0 * sigma, max_match_distance),
                           .kernel = sigma / 3.0};
  const PlaneRegistration found = register_to_planes(map_, hits, scan.origin, prediction, limits);
  const bool fits = found.matches >= min_matches &&
                    static_cast<double>(found.matches) >= min_fit * static_cast<double>(hits.size());
  misfits_ = fits ? 0 : misfits_ + 1;
  if (!fits) return prediction;
  threshold_.note(inverse(prediction) * found.local_from_robot, farthest_range(scan));
  return found.local_from_robot;
}

// Not with each observation, as what is looked up by has to be made anew.
void LidarOdometry::forget() {
  constexpr double share = 0.1;
  const bool has_driven = params_.distance > 0.0 && travelled_ - forgotten_at_ > share * params_.distance;
  const bool has_seen = params_.scans > 0 && ++since_forgetting_ > share * params_.scans;
  if (!has_driven && !has_seen) return;
  const auto unlimited = std::numeric_limits<std::size_t>::max();
  map_.forget(params_.scans > 0 ? static_cast<std::size_t>(params_.scans) : unlimited,
              params_.distance > 0.0 ? travelled_ - params_.distance : 0.0);
  forgotten_at_ = travelled_;
  since_forgetting_ = 0;
}

}  // namespace glocal::local_mappers
