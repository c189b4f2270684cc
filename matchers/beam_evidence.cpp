#include "matchers/beam_evidence.hpp"

#include <algorithm>
#include <cmath>

namespace glocal {
namespace {

/// A pose as a transform into the grid's cells: cell (c, r) reaches from (c, r) to (c + 1, r + 1).
Transform cells_from(const OccupancyGrid& grid, const Pose2& map_from_local) {
  const Pose2 grid_from_local = inverse(grid.map_from_grid) * map_from_local;
  return Transform(grid_from_local);
}

bool is_occupied(const OccupancyGrid& grid, float column, float row) {
  if (!(column >= 0.0F && row >= 0.0F && column < static_cast<float>(grid.width) &&
        row < static_cast<float>(grid.height))) {
    return false;
  }
  return grid.cell(static_cast<int>(column), static_cast<int>(row)) == Cell::occupied;
}

/// Whether a beam, both ends in metres of the grid's frame, meets an occupied cell before the last `margin`.
bool is_blocked(const OccupancyGrid& grid, const Point& from, const Point& to, double margin) {
  const float dx = to.x - from.x;
  const float dy = to.y - from.y;
  const float length = std::hypot(dx, dy);
  const float scale = 1.0F / static_cast<float>(grid.resolution);
  const float step = 0.5F * static_cast<float>(grid.resolution);
  const int steps = static_cast<int>((length - static_cast<float>(margin)) / step);
  for (int i = 1; i <= steps; ++i) {
    const float t = static_cast<float>(i) * step / length;
    if (is_occupied(grid, (from.x + t * dx) * scale, (from.y + t * dy) * scale)) return true;
  }
  return false;
}

}  // namespace

void BeamEvidence::add(const LocalMap& local, const Scan& scan) {
  if (local.generation != generation_) scans_.clear();
  generation_ = local.generation;
  const Transform local_from_robot(local.local_from_robot);
  Beams beams{local_from_robot(scan.origin), {}};
  const std::size_t all = scan.hits.size() + scan.free_ends.size();
  const std::size_t n = std::min(all, static_cast<std::size_t>(rule_.beams));
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = k * all / n;
    beams.ends.push_back(
        local_from_robot(i < scan.hits.size() ? scan.hits[i] : scan.free_ends[i - scan.hits.size()]));
  }
  scans_.push_back(std::move(beams));
  if (scans_.size() > static_cast<std::size_t>(rule_.scans)) scans_.pop_front();
}

double BeamEvidence::blocked_share(const OccupancyGrid& grid, const Pose2& map_from_local) const {
  const Transform grid_from_local = cells_from(grid, map_from_local);
  std::size_t all = 0;
  std::size_t blocked = 0;
  for (const Beams& beams : scans_) {
    const Point from = grid_from_local(beams.origin);
    for (std::size_t i = 0; i < beams.ends.size(); ++i) {
      if (is_blocked(grid, from, grid_from_local(beams.ends[i]), rule_.margin)) ++blocked;
    }
    all += beams.ends.size();
  }
  return all == 0 ? 0.0 : static_cast<double>(blocked) / static_cast<double>(all);
}

}  // namespace glocal
