// Scans in space, each registered to the surfaces seen before.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "glocal/catalog.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "local_mappers/deskew.hpp"
#include "local_mappers/plane_registration.hpp"
#include "local_mappers/surface_map.hpp"

namespace glocal::local_mappers {

/// How far hits may be from where a prediction puts them, learnt from how far predictions were off: sigma is
/// the root mean square of delta = |t| + 2 r sin(|angle| / 2), the most that a correction has moved a point
/// at the range r. Corrections below `least` are not counted, so that a robot at rest forgets nothing. After
/// Vizzo et al., "KISS-ICP: In defense of point-to-point ICP", RA-L 2023, eq. 5 to 8.
class AdaptiveThreshold {
 public:
  /// `start`: sigma before the first correction, which counts as one (m).
  AdaptiveThreshold(double start, double least) : least_(least), sum_(start * start) {}

  [[nodiscard]] double sigma() const;
  /// `range`: that of the scan's farthest hit, m.
  void note(const Pose3& correction, double range);

 private:
  double least_;
  double sum_;  ///< Of squares, m^2.
  double corrections_ = 1.0;
};

/// Joins scans in space. Each is predicted by odometry, downsampled, and registered point to plane to the map
/// of the scans before it, of which what was not seen for a while is forgotten. As KISS-ICP does it, but for
/// the planes and the odometry.
///
/// A scan that was made in motion is deskewed, if its hits have times: by odometry or by the last step.
///
/// A scan that fits nowhere moves the robot as predicted, and adds no points. Several in a row start the map
/// over (the next epoch), as does a robot that goes farther from where the map began than single precision
/// allows.
class LidarOdometry final : public LocalMapper {
 public:
  static constexpr Motions motions = motions_in_space;
  struct Params {
    SurfaceMapParams surfaces;
    double scan_voxel = 0.25;
    std::string prediction = "odometry";
    std::string deskew = "odometry";
    int restart_after = 3;  ///< Not in YAML.
    int scans = 400;
    double distance = 30.0;
  };

  LidarOdometry(const Params& params, const StageSetup& setup);

  void add(const Observation& observation) override;
  [[nodiscard]] const LocalMap& map() const override { return map_.map(); }
  void reset() override;

 private:
  /// Sigma before anything is known of predictions, m.
  static constexpr double initial_threshold = 0.3;
  /// Corrections that move no hit farther than this do not count for sigma, m.
  static constexpr double min_correction = 0.02;
  /// A hit matches a point of the map within three sigma, and at most this, m.
  static constexpr double max_match_distance = 2.0;
  /// With fewer matched hits the prediction is kept.
  static constexpr std::size_t min_matches = 30;

  [[nodiscard]] Pose3 predicted(const Pose3& odom_from_robot) const;
  /// The robot's motion while it made the scan of an observation, as far as it is known.
  [[nodiscard]] SteadyMotion motion_in_scan(const Observation& observation) const;
  /// Where the scan fits best, or `prediction` where it says too little. Counts misfits.
  [[nodiscard]] Pose3 match(const Scan& scan, const Pose3& prediction);
  void forget();

  Params params_;
  Motion motion_;
  SurfaceMap map_;
  AdaptiveThreshold threshold_;
  std::optional<Pose3> odom_from_last_;  ///< The robot at the last observation.
  Pose3 last_from_robot_;                ///< Its last step …
  double last_step_seconds_ = 0.0;       ///< … and how long it took; 0 before the first.
  double last_stamp_ = 0.0;              ///< s
  int misfits_ = 0;                      ///< Observations in a row that did not fit.
  double travelled_ = 0.0;               ///< Driven so far, m.
  double forgotten_at_ = 0.0;            ///< Where on the way forget() has looked last, m …
  int since_forgetting_ = 0;             ///< … and observations since then.
};
void describe(ParamVisitor& v, LidarOdometry::Params& p);

}  // namespace glocal::local_mappers
