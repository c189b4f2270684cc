#include "sources/simulation/clear_region.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <utility>

#include "sources/grid_ray.hpp"
#include "sources/simulation/clear_cells.hpp"

namespace glocal::simulation {
namespace {

/// To a neighbouring cell: first those over a side, then those over the corner between a side and the next.
struct Step {
  int columns;
  int rows;
  std::uint32_t cost;
};
/// Costs in units of a twelfth of a cell: 17 / 12 is the square root of 2 but for 0.2 %.
constexpr std::uint32_t straight_cost = 12;
constexpr std::uint32_t diagonal_cost = 17;
constexpr std::size_t sides = 4;
constexpr std::array<Step, 2 * sides> steps_of_grid{{{1, 0, straight_cost},
                                                     {0, 1, straight_cost},
                                                     {-1, 0, straight_cost},
                                                     {0, -1, straight_cost},
                                                     {1, 1, diagonal_cost},
                                                     {-1, 1, diagonal_cost},
                                                     {-1, -1, diagonal_cost},
                                                     {1, -1, diagonal_cost}}};

/// Cells to be looked at, the cheapest first and of equal ones the last: a bucket for each cost (Dial,
/// "Algorithm 360: Shortest-path forest with topological ordering", CACM 1969). What is put in costs at most
/// 63 more than what was taken out last.
class OpenCells {
 public:
  OpenCells(std::uint32_t cell, std::uint32_t cost) : cost_(cost) { put(cell, cost); }

  [[nodiscard]] bool empty() const { return count_ == 0; }
  void put(std::uint32_t cell, std::uint32_t cost) {
    buckets_[cost % buckets_.size()].push_back(cell);
    ++count_;
  }
  /// The cell and its cost. Not if there is none.
  std::pair<std::uint32_t, std::uint32_t> take() {
    while (buckets_[cost_ % buckets_.size()].empty()) ++cost_;
    std::vector<std::uint32_t>& bucket = buckets_[cost_ % buckets_.size()];
    const std::uint32_t cell = bucket.back();
    bucket.pop_back();
    --count_;
    return {cell, cost_};
  }

 private:
  std::array<std::vector<std::uint32_t>, 64> buckets_;
  std::uint32_t cost_;
  std::size_t count_ = 0;
};

/// Takes the cells that can be reached from one off the clear ones.
std::vector<std::uint32_t> take_region(std::size_t from, const OccupancyGrid& grid,
                                       std::vector<char>& is_clear) {
  std::vector<std::uint32_t> cells{static_cast<std::uint32_t>(from)};
  is_clear[from] = 0;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const int column = static_cast<int>(cells[i] % static_cast<std::uint32_t>(grid.width));
    const int row = static_cast<int>(cells[i] / static_cast<std::uint32_t>(grid.width));
    for (const auto& [dx, dy] : {std::pair(1, 0), {-1, 0}, {0, 1}, {0, -1}}) {
      if (!grid.holds(column + dx, row + dy)) continue;
      const std::size_t cell = grid.index(column + dx, row + dy);
      if (is_clear[cell] == 0) continue;
      is_clear[cell] = 0;
      cells.push_back(static_cast<std::uint32_t>(cell));
    }
  }
  return cells;
}

/// The same way from its end, with a place for each cell of its length.
std::vector<Position> turned_around(const std::vector<Position>& way) {
  std::vector<Position> places{way.back()};
  for (std::size_t i = way.size() - 1; i > 0; --i) {
    const Position& from = way[i];
    const Position& to = way[i - 1];
    const int parts = std::max(1, static_cast<int>(std::ceil(distance(from, to))));
    for (int k = 1; k < parts; ++k) places.push_back(between(from, to, static_cast<double>(k) / parts));
    places.push_back(to);
  }
  return places;
}

}  // namespace

ClearRegion ClearRegion::largest(const OccupancyGrid& grid, std::vector<char> is_clear) {
  std::vector<std::uint32_t> largest;
  for (std::size_t i = 0; i < is_clear.size(); ++i) {
    if (is_clear[i] == 0) continue;
    std::vector<std::uint32_t> cells = take_region(i, grid, is_clear);
    if (cells.size() > largest.size()) largest = std::move(cells);
  }
  return {grid, std::move(largest)};
}

ClearRegion ClearRegion::around(const Position& place, const OccupancyGrid& grid,
                                std::vector<char> is_clear) {
  const std::optional<std::size_t> cell = cell_under(place, grid);
  if (!cell || is_clear[*cell] == 0) return {grid, {}};
  return {grid, take_region(*cell, grid, is_clear)};
}

ClearRegion::ClearRegion(const OccupancyGrid& grid, std::vector<std::uint32_t> cells)
    : grid_{grid.map_from_grid, grid.resolution, grid.width, grid.height, {}},
      cells_(std::move(cells)),
      is_inside_(grid.cells.size(), 0) {
  for (const std::uint32_t cell : cells_) is_inside_[cell] = 1;
}

bool ClearRegion::holds(const Position& place) const {
  const std::optional<std::size_t> cell = cell_under(place, grid_);
  return cell && is_inside_[*cell] != 0;
}

Position ClearRegion::draw(Rng& rng) const {
  const double choice = rng.uniform() * static_cast<double>(cells_.size());
  return on_map(centre_of(cells_[static_cast<std::size_t>(choice)]));
}

std::vector<Position> ClearRegion::way(const Position& from, const Position& to) const {
  const Position start = on_grid(from, grid_);
  const Position end = on_grid(to, grid_);
  std::vector<Position> places{start};
  const std::vector<std::uint32_t> cells = cells_between(cell_of(start), cell_of(end));
  for (std::size_t i = 1; i + 1 < cells.size(); ++i) places.push_back(centre_of(cells[i]));
  places.push_back(end);
  std::vector<Position> way;
  for (const Position& place : tightened(places)) way.push_back(on_map(place));
  way.erase(way.begin());
  way.back() = to;
  return way;
}

Position ClearRegion::on_map(const Position& place) const {
  const Pose2 p = grid_.map_from_grid * Pose2{place[0] * grid_.resolution, place[1] * grid_.resolution, 0.0};
  return {p.x, p.y};
}

bool ClearRegion::holds_cell(int column, int row) const {
  return grid_.holds(column, row) && is_inside_[grid_.index(column, row)] != 0;
}

std::uint32_t ClearRegion::cell_of(const Position& on_grid) const {
  return static_cast<std::uint32_t>(on_grid[1]) * static_cast<std::uint32_t>(grid_.width) +
         static_cast<std::uint32_t>(on_grid[0]);
}

Position ClearRegion::centre_of(std::uint32_t cell) const {
  const std::uint32_t column = cell % static_cast<std::uint32_t>(grid_.width);
  const std::uint32_t row = cell / static_cast<std::uint32_t>(grid_.width);
  return {column + 0.5, row + 0.5};
}

/// From the first to the last, both included. A step over a corner needs the cells at both of its sides, so
/// that it does not touch others.
std::vector<std::uint32_t> ClearRegion::cells_between(std::uint32_t from, std::uint32_t to) const {
  const std::uint32_t width = static_cast<std::uint32_t>(grid_.width);
  const auto column_of = [&](std::uint32_t cell) { return static_cast<int>(cell % width); };
  const auto row_of = [&](std::uint32_t cell) { return static_cast<int>(cell / width); };
  // At least so much is left: all steps over corners, then all straight ones.
  const auto cost_left = [&](std::uint32_t cell) {
    const auto columns = static_cast<std::uint32_t>(std::abs(column_of(to) - column_of(cell)));
    const auto rows = static_cast<std::uint32_t>(std::abs(row_of(to) - row_of(cell)));
    return straight_cost * std::max(columns, rows) +
           (diagonal_cost - straight_cost) * std::min(columns, rows);
  };
  std::vector<std::uint32_t> costs(is_inside_.size(), 0);  // one more than they are; 0: not yet seen
  std::vector<std::uint8_t> last_steps(is_inside_.size(), 0);
  OpenCells open(from, cost_left(from));
  costs[from] = 1;
  for (bool is_there = from == to; !is_there && !open.empty();) {
    const auto [cell, cost] = open.take();
    is_there = cell == to;
    if (costs[cell] - 1 + cost_left(cell) != cost) continue;  // a cheaper way to it was found meanwhile
    std::array<bool, steps_of_grid.size()> is_open{};
    for (std::size_t i = 0; i < steps_of_grid.size(); ++i) {
      const Step& step = steps_of_grid[i];
      const bool is_beside_open = i < sides || (is_open[i - sides] && is_open[(i + 1) % sides]);
      is_open[i] = is_beside_open && holds_cell(column_of(cell) + step.columns, row_of(cell) + step.rows);
      if (!is_open[i]) continue;
      const std::uint32_t next = static_cast<std::uint32_t>(row_of(cell) + step.rows) * width +
                                 static_cast<std::uint32_t>(column_of(cell) + step.columns);
      const std::uint32_t next_cost = costs[cell] + step.cost;
      if (costs[next] != 0 && costs[next] <= next_cost) continue;
      costs[next] = next_cost;
      last_steps[next] = static_cast<std::uint8_t>(i);
      open.put(next, next_cost - 1 + cost_left(next));
    }
  }
  std::vector<std::uint32_t> cells{to};
  while (cells.back() != from) {
    const Step& step = steps_of_grid[last_steps[cells.back()]];
    cells.push_back(static_cast<std::uint32_t>(row_of(cells.back()) - step.rows) * width +
                    static_cast<std::uint32_t>(column_of(cells.back()) - step.columns));
  }
  std::ranges::reverse(cells);
  return cells;
}

/// Whether a straight way stays in the region, on the grid.
bool ClearRegion::is_straight_way(const Position& from, const Position& to) const {
  bool is_inside = is_inside_[cell_of(to)] != 0;
  visit_cells_before_end(from[0], from[1], to[0], to[1], [&](int column, int row, double) {
    is_inside = is_inside && holds_cell(column, row);
    return is_inside;
  });
  return is_inside;
}

/// Goes on straight as far as that is possible, then leaves out corners until each of them is needed.
std::vector<Position> ClearRegion::shortened(const std::vector<Position>& way) const {
  std::vector<Position> corners{way.front()};
  for (std::size_t i = 1; i + 1 < way.size(); ++i) {
    if (!is_straight_way(corners.back(), way[i + 1])) corners.push_back(way[i]);
  }
  corners.push_back(way.back());
  for (std::size_t i = 1; i + 1 < corners.size();) {
    if (!is_straight_way(corners[i - 1], corners[i + 1])) {
      ++i;
      continue;
    }
    corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
    i = std::max<std::size_t>(i - 1, 1);  // the corner before may be needed no more
  }
  return corners;
}

/// Pulls a way tight, on the grid: begins at either end in turn until that saves less than half a cell.
std::vector<Position> ClearRegion::tightened(const std::vector<Position>& way) const {
  std::vector<Position> corners = shortened(way);
  for (;;) {
    std::vector<Position> tighter = shortened(turned_around(shortened(turned_around(corners))));
    if (length_of(tighter) > length_of(corners) - 0.5) return corners;
    corners = std::move(tighter);
  }
}

}  // namespace glocal::simulation
