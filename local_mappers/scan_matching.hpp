// The default local mapper: each scan is matched against the map of the scans before it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "local_mappers/correlative_search.hpp"
#include "local_mappers/line_registration.hpp"
#include "local_mappers/point_grid.hpp"
#include "local_mappers/scan_normals.hpp"
#include "local_mappers/sight.hpp"

namespace glocal {

/// Searches poses around odometry on a likelihood grid, then refines by robust point-to-line Gauss-Newton
/// against the points of the local map. Time per observation does not grow with the drive; memory grows with
/// the area seen only.
///
/// Matching is planar; heights are kept. Points are thinned in cells of `resolution` (cubes, for hits at
/// different heights); a cell's point is the mean of its first `cell_hits` hits. The map starts anew (the
/// next generation) when `restart_after` observations in a row do not fit it, or when the robot leaves what
/// the grid can hold (800 m from where the map began, with cells of 5 cm). Hits outside that square or beyond
/// `memory_mb` are left out.
class ScanMatching final : public LocalMapper {
 public:
  struct Params {
    double resolution = 0.05;
    int cell_hits = 3;
    double likelihood_sigma = 0.1;
    ScanNormalParams normals;
    CorrelativeSearchParams search;
    CorrelativeSearchParams wide_search{.translation = 0.75, .rotation = 1.5, .odometry_penalty = 0.02};
    double wide_search_below = 0.5;
    double wide_search_gain = 0.15;
    LineRegistrationParams refinement;
    int min_matches = 15;
    double max_correction = 0.6;
    double max_correction_angle = 0.6;
    double min_fit = 0.15;
    double max_seen_through = 0.15;
    SightParams sight;
    int restart_after = 2;
    int memory_mb = 256;
  };

  explicit ScanMatching(const Params& params);

  void add(const Observation& observation) override;
  [[nodiscard]] const LocalMap& map() const override { return map_; }
  void reset() override;

  /// Index of the points, for looking at how much the map takes.
  [[nodiscard]] const PointGrid& grid() const { return grid_; }

 private:
  /// What odometry says, from the last pose on.
  [[nodiscard]] Pose2 predict(const Pose2& odom_from_robot) const;
  /// Where the scan fits best, or `predicted` where it says too little. Counts misfits.
  [[nodiscard]] Pose2 match(const Scan& scan, const Points& normals, const Pose2& predicted);
  [[nodiscard]] Pose2 refine(const Scan& scan, const Points& normals, const Pose2& found,
                             const Pose2& predicted) const;
  [[nodiscard]] SearchResult search(const Points& hits, const Pose2& predicted) const;
  void start_over();
  void register_hits(const Points& hits, const Points& normals);
  void register_hit(const Point& p, const Point& normal);
  /// The point of the map in this cell and at this height, or PointGrid::none.
  [[nodiscard]] int find_point(GridCell cell, float z) const;
  void append_point(GridCell cell, const Point& p, const Point& normal);
  void average_into(std::size_t index, const Point& p, const Point& normal);

  Params params_;
  PointGrid grid_;
  LocalMap map_;
  std::vector<std::uint8_t> hits_;        ///< Hits averaged in each point so far.
  std::vector<std::int32_t> next_above_;  ///< Next point in the same column of the plane, or none.
  LatestSights sights_;
  std::optional<Pose2> last_odom_from_robot_;
  int misfits_ = 0;  ///< Observations in a row that did not fit.
};
void describe(ParamVisitor& v, ScanMatching::Params& p);

}  // namespace glocal
