// The default local mapper: each scan is matched against the map of the scans before it.
#pragma once

#include <optional>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "local_mappers/correlative_search.hpp"
#include "local_mappers/free_space_check.hpp"
#include "local_mappers/line_registration.hpp"
#include "local_mappers/scan_normals.hpp"
#include "local_mappers/voxel_map.hpp"

namespace glocal::local_mappers {

/// Searches poses around odometry on a likelihood grid, then refines by robust point-to-line Gauss-Newton
/// against the points of the local map. Time per observation does not grow with the drive; memory grows with
/// the area seen only.
///
/// Matching is planar; heights are kept. The map starts anew (the next epoch) when two observations in a row
/// do not fit it, or when the robot leaves what the grid can hold.
class ScanMatching final : public LocalMapper {
 public:
  struct Params {
    VoxelParams voxels;
    ScanNormalParams normals;
    CorrelativeSearchParams search;
    LineRegistrationParams refinement;
    double max_free_space_violation = 0.15;
  };

  explicit ScanMatching(const Params& params);

  void add(const Observation& observation) override;
  [[nodiscard]] const LocalMap& map() const override { return map_.map(); }
  void reset() override;

  // For mappers that choose what of this is kept; add() is place() and insert().
  /// Moves the robot to where the scan fits, which may start the map over. Returns what the scan has to add:
  /// nothing if it does not fit.
  [[nodiscard]] LocalScan place(const Observation& observation);
  void insert(const LocalScan& scan) { map_.add(scan); }
  /// Forgets the points, but neither frame nor robot.
  void clear() { map_.clear(); }

  /// The map's local_from_robot.
  [[nodiscard]] const Pose2& robot() const { return map_.robot(); }
  /// How far the last scan saw that fitted; there is one.
  [[nodiscard]] const RangeProfile& profile() const { return free_space_check_.latest(); }
  /// Index of the points.
  [[nodiscard]] const PointGrid& grid() const { return map_.grid(); }

 private:
  /// Mean likelihood that an observation must reach after the search. One that does not fit moves the robot
  /// by odometry and adds no points.
  static constexpr double min_fit = 0.3;
  /// What a pose at the border of the search loses in likelihood: odometry holds where hits say nothing.
  static constexpr double odometry_penalty = 0.005;
  /// So many observations in a row that do not fit begin a new map.
  static constexpr int restart_after = 2;
  /// With fewer matched hits odometry is kept.
  static constexpr int min_matches = 15;
  /// A refinement that goes farther from where the search ended has run away, m …
  static constexpr double max_correction = 0.6;
  static constexpr double max_correction_angle_deg = 35.0;  ///< … and one that turns farther, deg.

  /// What odometry says, from the last pose on.
  [[nodiscard]] Pose2 predict(const Pose2& odom_from_robot) const;
  /// Where the scan fits best, or `predicted` where it says too little. Counts misfits.
  [[nodiscard]] Pose2 match(const Scan& scan, const Points& normals, const Pose2& predicted);
  [[nodiscard]] Pose2 refine(const Scan& scan, const Points& normals, const Pose2& found,
                             const Pose2& predicted) const;

  Params params_;
  VoxelMap map_;
  FreeSpaceCheck free_space_check_;
  std::optional<Pose2> last_odom_from_robot_;
  int misfits_ = 0;  ///< Observations in a row that did not fit.
};
void describe(ParamVisitor& v, ScanMatching::Params& p);
/// What mappers that match scans in this way have of these parameters.
void describe_common(ParamVisitor& v, ScanMatching::Params& p);

}  // namespace glocal::local_mappers
