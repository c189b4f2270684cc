// Directions of the surfaces a scan has met.
#pragma once

#include "glocal/params.hpp"
#include "glocal/points.hpp"

namespace glocal::local_mappers {

struct ScanNormalParams {
  int beams = 4;
  double max_roughness = 0.05;
};
void describe(ParamVisitor& v, ScanNormalParams& p);

/// Normals of hits in beam order, seen from `sensor` (same frame, m): unit vectors in the plane, turned
/// towards the sensor; (0, 0, 0) where neighbouring beams show no line. A normal is the minor axis of the
/// covariance of the hit and up to `beams` neighbours on each side; a side ends at the first jump of more
/// than 0.6 m from one hit to the next.
[[nodiscard]] Points scan_normals(const Points& hits, const Point& sensor, const ScanNormalParams& params);

}  // namespace glocal::local_mappers
