// Finds roughly where a scan fits the local map, by trying poses.
#pragma once

#include "glocal/params.hpp"
#include "glocal/points.hpp"
#include "glocal/pose2.hpp"
#include "local_mappers/point_grid.hpp"

namespace glocal::local_mappers {

struct CorrelativeSearchParams {
  double translation = 0.1;
};
void describe(ParamVisitor& v, CorrelativeSearchParams& p);

/// What the search has found.
struct SearchResult {
  Pose2 local_from_robot;
  double likelihood = 0.0;  ///< Mean over the points used, in [0, 1].
};

/// The best of all poses in a box around `predicted` (cell by cell in x and y, degree by degree up to 9°), by
/// the mean likelihood of at most 100 hits (robot frame, m; spread evenly) minus `odometry_penalty` times the
/// squared deviation from `predicted`, in units of the box. Of equally good poses, the one tried first. After
/// Olson, "Real-time correlative scan matching", ICRA 2009.
[[nodiscard]] SearchResult correlative_search(const PointGrid& grid, const Points& hits,
                                              const Pose2& predicted, const CorrelativeSearchParams& params,
                                              double odometry_penalty);

}  // namespace glocal::local_mappers
