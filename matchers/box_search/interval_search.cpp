#include "matchers/box_search/interval_search.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <utility>

#include "matchers/box_search/allowed_translations.hpp"

namespace glocal::box_search {

BoxSearchResult::FoundPose Problem::found_at(const Box& box) const {
  const double middle = middle_of_box();
  BoxSearchResult::FoundPose found{boxes.pose(0, box.rotation, box.column + middle, box.row + middle),
                                   boxes.height(box.layer + middle), box.at_middle};
  if (boxes.tilt()) found.tilted_from_local = boxes.tilted_from_local(0, box.rotation);
  return found;
}

bool Problem::is_excluded(const Box& box) const {
  return exclusion &&
         exclusion->near.are_near(found_at(box).pose() * local_from_robot, exclusion->map_from_robot);
}

/// Which boxes of one interval of rotations are worth a look.
class WantedBoxes {
 public:
  WantedBoxes(const Problem& problem, int level, std::size_t rotation)
      : cell_(problem.boxes.frame().cell), beyond_(problem.all_poses != nullptr ? 1 : 0) {
    if (problem.rule.gate.is_open() && !problem.exclusion) return;
    const Pose2 at_zero = problem.boxes.pose(level, rotation, 0.0, 0.0);
    allowed_.emplace(widened(problem.rule.gate, problem.boxes, level, rotation), at_zero, cell_);
    if (problem.exclusion) exclude(problem, level, at_zero, problem.tilted_from_robot(level, rotation));
  }

  /// Some of whose poses are allowed, and not near an excluded one: of a rectangle of translations, in cells,
  /// beginning with those of the tile's first box.
  [[nodiscard]] bool any(const Tile& tile, int columns, int rows) const {
    if (allowed_ && !allowed_->any(tile.column, tile.row, columns + beyond_, rows + beyond_)) return false;
    return !excluded_ || !is_near(tile, columns, rows);
  }

 private:
  void exclude(const Problem& problem, int level, const Pose2& tilted_at_zero,
               const Pose3& tilted_from_robot) {
    const auto& [excluded, near] = *problem.exclusion;
    const Pose3 robot_at_zero = Pose3(tilted_at_zero) * tilted_from_robot;
    // If some of the rotations are no longer near, no box is.
    if (rotation_between(robot_at_zero, excluded) + problem.boxes.half_width(level) > near.rotation) return;
    robot_at_zero_ = robot_at_zero.translation();
    robot_at_zero_.z() += problem.boxes.height(0.0);
    layer_height_ = problem.boxes.frame().in_space ? cell_ : 0.0;
    box_height_ = layer_height_ * problem.boxes.layers_of_box(level);
    excluded_ = excluded.translation();
    near_ = near.translation - problem.boxes.sway(level, problem.local_from_robot.translation());
  }

  /// A gate that allows the middle of an interval, after its tilt, if it allows any of its poses.
  static PoseGate widened(const PoseGate& gate, const PoseBoxes& boxes, int level, std::size_t rotation) {
    Prior prior = gate.prior();
    const Pose3 start = boxes.tilted_from_local(level, rotation) * gate.local_from_start();
    if (prior.region.is_given())
      *prior.region.radius += boxes.sway(level, gate.local_from_start().translation());
    if (prior.heading.is_given()) {
      // A tilt turns what is seen from above, the more the steeper it points.
      const double half_width = boxes.half_width(level);
      const double rises = std::asin(std::abs((start.rotation * Vector3::UnitX()).z()));
      const double flat = boxes.tilt() ? std::cos(std::min(rises + half_width, std::numbers::pi / 2.0)) : 1.0;
      prior.heading.width_deg = std::min(360.0, *prior.heading.width_deg + 2.0 * degrees(half_width) / flat);
    }
    return {prior, start};
  }

  [[nodiscard]] bool is_near(const Tile& tile, int columns, int rows) const {
    const auto farther = [](double low, double size, double excluded) {
      return std::max(std::abs(low - excluded), std::abs(low + size - excluded));
    };
    return std::hypot(farther(robot_at_zero_.x() + cell_ * tile.column, cell_ * columns, excluded_->x()),
                      farther(robot_at_zero_.y() + cell_ * tile.row, cell_ * rows, excluded_->y()),
                      farther(robot_at_zero_.z() + layer_height_ * tile.layer, box_height_,
                              excluded_->z())) <= near_;
  }

  double cell_;
  int beyond_;  ///< Translations by any real numbers reach so many cells farther than those by whole cells.
  std::optional<AllowedTranslations> allowed_ = {};  ///< Where not all are.
  std::optional<Vector3> excluded_ = {};  ///< If all rotations are near those of the excluded pose …
  double near_ = 0.0;  ///< … a robot at most so far from it is near it at all of them, m.
  Vector3 robot_at_zero_ = Vector3::Zero();  ///< m; all heights are 0 in the plane.
  double layer_height_ = 0.0, box_height_ = 0.0;
};

static RobotCells robots_of(const Problem& problem, std::size_t rotation) {
  const double middle = problem.middle_of_box();
  const Pose3 robot = problem.tilted_from_robot(0, rotation);
  return {problem.boxes.pose(0, rotation, middle, middle) * seen_from_above(robot),
          problem.boxes.height(middle) + robot.z, problem.boxes.frame().cell, problem.rule.cell_distance,
          problem.rule.cell_rotation};
}

/// The boxes of level 0 of one rotation.
struct Bottom {
  Bottom(const Problem& problem, std::size_t number)
      : rotation(number), wanted(problem, 0, rotation), robots(robots_of(problem, rotation)) {}

  std::size_t rotation;
  WantedBoxes wanted;
  RobotCells robots;
  std::optional<CellPoints> middles = {};  ///< See AllPoses; once a box has reached the bar.
};

namespace {

constexpr int quarter_columns = TileCounts::columns / 2;
constexpr int quarter_rows = TileCounts::rows / 2;

/// The first box of some.
std::array<int, 2> first_of(const TileCounts::Mask& boxes) {
  int row = 0;
  while (boxes[static_cast<std::size_t>(row)] == 0) ++row;
  return {std::countr_zero(boxes[static_cast<std::size_t>(row)]), row};
}

/// Tiles along each axis.
struct TileNumbers {
  int layers = 0, rows = 0, columns = 0;

  [[nodiscard]] bool is_within(const TileNumbers& all) const {
    return layers < all.layers && rows < all.rows && columns < all.columns;
  }
};

/// A first look at the tiles of the top level of one interval.
class FirstSearch {
 public:
  FirstSearch(const Problem& problem, std::size_t rotation)
      : problem_(problem),
        top_(problem.pyramid.top_level()),
        search_(problem, problem.rule.least),
        points_(problem.boxes.cells(top_, rotation)),
        all_(problem.boxes.translations(points_, problem.rule.least)),
        wanted_(problem, top_, rotation) {
    interval_.rotation = rotation;
    interval_.last_layer = all_.last_layer;
    const auto number = [](int first, int last, int size) {
      return last < first ? 0 : (last - first) / size + 1;
    };
    tiles_ = {number(all_.first_layer, all_.last_layer, problem.boxes.layers_of_box(top_)),
              number(all_.first_row, all_.last_row, TileCounts::rows << top_),
              number(all_.first_column, all_.last_column, TileCounts::columns << top_)};
    if (problem.all_poses == nullptr) return;
    clusters_ = problem.all_poses->cluster_cells(rotation);
    // With fewer clusters in contact, and all points that are in none, the bar is not reached.
    const std::size_t loose = problem.all_poses->points_without_cluster();
    if (problem.rule.least > loose)
      least_clusters_ = (problem.rule.least - loose - 1) / AllPoses::cluster_size + 1;
  }

  /// Tiles that hold all translations which count.
  [[nodiscard]] const TileNumbers& tiles() const { return tiles_; }

  /// At one of them, by how many lie before it.
  void look_at(const TileNumbers& before) {
    const int columns = TileCounts::columns << top_;
    const int rows = TileCounts::rows << top_;
    const Tile tile{all_.first_column + before.columns * columns, all_.first_row + before.rows * rows,
                    all_.first_layer + before.layers * problem_.boxes.layers_of_box(top_)};
    if (!wanted_.any(tile, columns, rows)) return;
    if (problem_.all_poses != nullptr) {
      keep_if_promising(tile);
    } else {
      keep(tile);
    }
  }

  [[nodiscard]] FirstLook end() {
    if (problem_.all_poses != nullptr) {
      interval_.promise = interval_.bound;
    } else if (interval_.bound > 0) {
      dive();
    }
    return {std::move(interval_), std::move(search_.found())};
  }

 private:
  /// Of all poses much contact is asked for, and few tiles can reach the bar.
  void keep_if_promising(const Tile& tile) {
    if (least_clusters_ > 0 && !search_.reaches(top_, clusters_, tile, least_clusters_)) return;
    if (!search_.reaches(top_, points_, tile, search_.least())) return;
    interval_.bound = std::max(interval_.bound, search_.counts().largest());
    if (top_ > 0) {
      search_.add_counted(top_, tile, wanted_, interval_.tiles);
    } else {
      interval_.tiles.push_back(tile);
    }
  }

  /// Of a grid the best poses are asked for, however good they are.
  void keep(const Tile& tile) {
    interval_.tiles.push_back(tile);
    if (!search_.reaches(top_, points_, tile, interval_.bound + 1)) return;
    interval_.bound = search_.counts().largest();
    const auto [column, row] = first_of(search_.counts().at_least(interval_.bound));
    best_ = {tile.column + (column << top_), tile.row + (row << top_), tile.layer};
  }

  /// Follows the box that promises most to the bottom: what is found so raises the bar before the search
  /// begins.
  void dive() {
    Bottom bottom(problem_, interval_.rotation);
    const int end_layer = std::min(best_.layer + problem_.boxes.layers_of_box(top_), all_.last_layer + 1);
    for (Tile tile = best_; tile.layer < end_layer; ++tile.layer) {
      for (tile.row = best_.row; tile.row < best_.row + (1 << top_); tile.row += TileCounts::rows) {
        if (search_.reaches(0, points_, tile, 1)) search_.add_boxes(bottom, tile, search_.counts().largest());
      }
    }
    BestOfCells& places = search_.found().places;
    for (const auto& [cell, box] : places) interval_.promise = std::max(interval_.promise, box.at_middle);
    std::erase_if(places, [&](const auto& place) { return place.second.at_middle < search_.least(); });
  }

  const Problem& problem_;
  int top_;  ///< Level.
  TileSearch search_;
  std::vector<CellPoints> points_;
  std::vector<CellPoints> clusters_;  ///< Of all poses.
  std::size_t least_clusters_ = 0;
  Translations all_;
  TileNumbers tiles_;
  WantedBoxes wanted_;
  Interval interval_;
  Tile best_{};  ///< Of a grid, the box that promises most.
};

}  // namespace

std::vector<FirstLook> first_looks(const Problem& problem, std::size_t first, std::size_t size) {
  std::vector<FirstSearch> searches;
  TileNumbers all;
  for (std::size_t rotation = first; rotation < first + size; ++rotation) {
    const TileNumbers tiles = searches.emplace_back(problem, rotation).tiles();
    all = {std::max(all.layers, tiles.layers), std::max(all.rows, tiles.rows),
           std::max(all.columns, tiles.columns)};
  }
  for (TileNumbers before; before.layers < all.layers; ++before.layers) {
    for (before.rows = 0; before.rows < all.rows; ++before.rows) {
      for (before.columns = 0; before.columns < all.columns; ++before.columns) {
        for (FirstSearch& search : searches) {
          if (before.is_within(search.tiles())) search.look_at(before);
        }
      }
    }
  }
  std::vector<FirstLook> looks;
  for (FirstSearch& search : searches) looks.push_back(search.end());
  return looks;
}

bool TileSearch::reaches(int level, const std::vector<CellPoints>& points, const Tile& tile,
                         std::size_t least) {
  if (level == 0) found_.tested += std::size_t{TileCounts::columns} * TileCounts::rows;
  found_.looks += problem_.pyramid.count(level, points, tile.column, tile.row, tile.layer, least, counts_);
  return counts_.largest() >= least;
}

void TileSearch::add_counted(int level, Tile tile, const WantedBoxes& wanted,
                             std::vector<Tile>& counted) const {
  const TileCounts::Mask promising = counts_.at_least(least_);
  for (int row = 0; row < TileCounts::rows; ++row) {
    for (std::uint64_t left = promising[static_cast<std::size_t>(row)]; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      const auto quarter = static_cast<std::uint8_t>(1 << (row / quarter_rows * 2 + i / quarter_columns));
      if ((tile.quarters & quarter) == 0 &&
          wanted.any({tile.column + (i << level), tile.row + (row << level), tile.layer}, 1 << level,
                     1 << level))
        tile.quarters |= quarter;
    }
  }
  if (tile.quarters == 0) return;
  tile.bound = static_cast<std::uint32_t>(counts_.largest());
  counted.push_back(tile);
}

void TileSearch::add_boxes(Bottom& bottom, const Tile& tile, std::size_t least) {
  if (problem_.all_poses != nullptr) count_middles(bottom, tile);
  const TileCounts::Mask boxes = counts_.at_least(least);
  for (int k = 0; k < TileCounts::rows; ++k) {
    for (std::uint64_t left = boxes[static_cast<std::size_t>(k)]; left != 0; left &= left - 1) {
      const int i = std::countr_zero(left);
      if (!bottom.wanted.any({tile.column + i, tile.row + k, tile.layer}, 1, 1)) continue;
      const std::size_t bound = counts_.at(i, k);
      const std::size_t at_middle = problem_.all_poses != nullptr ? middle_counts_.at(i, k) : bound;
      const Box box{bottom.rotation, tile.row + k, tile.column + i, tile.layer, at_middle};
      found_.at_most = std::max(found_.at_most, bound);
      if (!problem_.is_excluded(box)) take_in(found_.places, bottom.robots.of(box), box);
    }
  }
}

void TileSearch::count_middles(Bottom& bottom, const Tile& tile) {
  if (!bottom.middles) bottom.middles = problem_.all_poses->middle_cells(bottom.rotation);
  problem_.pyramid.count_middles(*bottom.middles, tile.column, tile.row, tile.layer, middle_counts_);
  found_.looks += bottom.middles->size();
}

void TileSearch::raise() {
  least_ = std::max(least_, keep_best(found_.places, problem_.rule.most_places));
}

IntervalSearch::IntervalSearch(const Problem& problem, const Interval& interval, std::size_t least,
                               std::size_t most_looks)
    : problem_(problem), most_looks_(most_looks), last_layer_(interval.last_layer), search_(problem, least) {
  const int top = problem_.pyramid.top_level();
  if (problem_.all_poses == nullptr || top == 0) {
    open_.push_back({top, interval.rotation, interval.tiles});
  } else {
    open_below(top, interval.rotation, interval.tiles);
  }
}

std::size_t IntervalSearch::advance(std::size_t looks) {
  std::size_t taken = 0;
  while (!is_over() && taken < looks) {
    const std::size_t before = found().looks;
    const Part part = std::move(open_.back());
    open_.pop_back();
    look_at(part);
    if (found().looks > most_looks_) open_.clear();
    taken += found().looks - before + problem_.looks_of_interval;
  }
  return taken;
}

void IntervalSearch::look_at(const Part& part) {
  const auto& [level, rotation, tiles] = part;
  // On a grid they are the same at all levels.
  if (problem_.all_poses != nullptr || points_.empty()) points_ = problem_.boxes.cells(level, rotation);
  if (level == 0) return look_at_bottom(part);
  const WantedBoxes wanted(problem_, level, rotation);
  std::vector<Tile> counted;
  for (const Tile& tile : tiles) {
    if (tile.bound < search_.least()) continue;
    if (!wanted.any(tile, TileCounts::columns << level, TileCounts::rows << level)) continue;
    if (found().looks > most_looks_) return;
    if (search_.reaches(level, points_, tile, search_.least()))
      search_.add_counted(level, tile, wanted, counted);
  }
  open_below(level, rotation, counted);
}

/// Quarters of tiles are tiles of the level below; where boxes are higher than those there, one for each half
/// of the layers. Each part of the interval has them. Of all poses some neighbouring ones at a time go down
/// to the bottom in all parts: the bits that they find are at hand then.
void IntervalSearch::open_below(int level, std::size_t rotation, const std::vector<Tile>& counted) {
  const int layers = problem_.boxes.layers_of_box(level - 1);
  std::vector<Tile> tiles;
  for (const Tile& tile : counted) {
    const int end_layer = std::min(tile.layer + problem_.boxes.layers_of_box(level), last_layer_ + 1);
    for (const int quarter : {0, 1, 2, 3}) {
      if ((tile.quarters >> quarter & 1) == 0) continue;
      const int column = tile.column + ((quarter % 2 * quarter_columns) << level);
      const int row = tile.row + ((quarter / 2 * quarter_rows) << level);
      for (int layer = tile.layer; layer < end_layer; layer += layers)
        tiles.push_back({column, row, layer, tile.bound});
    }
  }
  const std::vector<std::size_t> parts = problem_.boxes.parts(level, rotation);
  const std::size_t most_together = problem_.all_poses != nullptr ? 64 : tiles.size();
  for (std::size_t end = tiles.size(); end > 0;) {
    const std::size_t size = std::min(end, most_together);
    const auto last = tiles.begin() + static_cast<std::ptrdiff_t>(end);
    const std::vector<Tile> some(last - static_cast<std::ptrdiff_t>(size), last);
    for (auto part = parts.rbegin(); part != parts.rend(); ++part) open_.push_back({level - 1, *part, some});
    end -= size;
  }
}

void IntervalSearch::look_at_bottom(const Part& part) {
  Bottom bottom(problem_, part.rotation);
  for (const Tile& tile : part.tiles) {
    if (tile.bound < search_.least() || !bottom.wanted.any(tile, TileCounts::columns, TileCounts::rows))
      continue;
    if (found().looks > most_looks_) return;
    if (search_.reaches(0, points_, tile, search_.least())) search_.add_boxes(bottom, tile, search_.least());
  }
  search_.raise();
}

}  // namespace glocal::box_search
