#include "matchers/box_search/search_boxes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "glocal/parallel.hpp"
#include "matchers/box_search/allowed_translations.hpp"

namespace glocal {
namespace {

/// What is searched, and for what.
struct Problem {
  const BoxPyramid& pyramid;
  const PoseBoxes& boxes;
  const AllPoses* all_poses;  ///< The boxes, if they are not of a grid.
  const Pose3& local_from_robot;
  Pose2 above_from_robot;  ///< The same, seen from above.
  const BoxSearchRule& rule;
  const std::optional<Exclusion>& exclusion;

  /// Intervals searched before the bar is raised. Fixed, so that the answer does not depend on the threads.
  /// One of all poses has as many rotations as many of a grid.
  [[nodiscard]] std::size_t intervals_at_a_time() const { return all_poses != nullptr ? 8 : 32; }
  /// Where in a box of level 0 its middle is, in cells: a pose of a grid is a box.
  [[nodiscard]] double middle_of_box() const { return all_poses != nullptr ? 0.5 : 0.0; }
};

/// A tile of boxes, by its first one's translation.
struct Tile {
  int column, row, layer;
};

/// An interval of rotations of the top level, after a first look.
struct Interval {
  std::size_t rotation = 0;
  std::size_t bound = 0;         ///< No box of any tile can have more points in contact.
  std::size_t promise = 0;       ///< What is searched first promises most.
  std::vector<Tile> tiles = {};  ///< All that may have a box that reaches the bar.
  int last_layer = 0;            ///< Of translations.
};

/// A first look at an interval, and what was found by the way.
struct FirstLook {
  Interval interval;
  FoundPlaces found;
};

/// Which boxes of one interval of rotations are worth a look.
class WantedBoxes {
 public:
  WantedBoxes(const Problem& problem, int level, std::size_t rotation)
      : cell_(problem.boxes.frame().cell), beyond_(problem.all_poses != nullptr ? 1 : 0) {
    if (problem.rule.gate.is_open() && !problem.exclusion) return;
    const Pose2 at_zero = problem.boxes.pose(level, rotation, 0.0, 0.0);
    allowed_.emplace(widened(problem.rule.gate, problem.boxes, level), at_zero, cell_);
    if (problem.exclusion) exclude(problem, level, at_zero * problem.above_from_robot);
  }

  /// Some of whose poses are allowed, and not near an excluded one: of a rectangle of translations, in cells,
  /// beginning with those of the tile's first box.
  [[nodiscard]] bool any(const Tile& tile, int columns, int rows) const {
    if (allowed_ && !allowed_->any(tile.column, tile.row, columns + beyond_, rows + beyond_)) return false;
    return !excluded_ || !is_near(tile, columns, rows);
  }

 private:
  void exclude(const Problem& problem, int level, const Pose2& robot_at_zero) {
    const auto& [excluded, near] = *problem.exclusion;
    // If some of the rotations are no longer near, no box is.
    if (rotation_between(robot_at_zero, seen_from_above(excluded)) + problem.boxes.half_width(level) >
        near.rotation)
      return;
    const Pose3& robot = problem.local_from_robot;
    robot_at_zero_ = robot_at_zero;
    height_at_zero_ = problem.boxes.height(0.0) + robot.z;
    layer_height_ = problem.boxes.frame().in_space ? cell_ : 0.0;
    box_height_ = layer_height_ * problem.boxes.layers_of_box(level);
    excluded_ = excluded.translation();
    near_ = near.translation - problem.boxes.sway(level, robot.x, robot.y);
  }

  /// A gate that allows the middle of an interval if it allows any of its poses.
  static PoseGate widened(const PoseGate& gate, const PoseBoxes& boxes, int level) {
    Prior prior = gate.prior();
    const Pose3& start = gate.local_from_start();
    if (prior.region.is_given()) *prior.region.radius += boxes.sway(level, start.x, start.y);
    if (prior.heading.is_given())
      prior.heading.width_deg =
          std::min(360.0, *prior.heading.width_deg + 2.0 * degrees(boxes.half_width(level)));
    return {prior, start};
  }

  [[nodiscard]] bool is_near(const Tile& tile, int columns, int rows) const {
    const auto farther = [](double low, double size, double excluded) {
      return std::max(std::abs(low - excluded), std::abs(low + size - excluded));
    };
    return std::hypot(farther(robot_at_zero_.x + cell_ * tile.column, cell_ * columns, excluded_->x()),
                      farther(robot_at_zero_.y + cell_ * tile.row, cell_ * rows, excluded_->y()),
                      farther(height_at_zero_ + layer_height_ * tile.layer, box_height_, excluded_->z())) <=
           near_;
  }

  double cell_;
  int beyond_;  ///< Translations by any real numbers reach so many cells farther than those by whole cells.
  std::optional<AllowedTranslations> allowed_ = {};  ///< Where not all are.
  std::optional<Vector3> excluded_ = {};  ///< If all rotations are near those of the excluded pose …
  double near_ = 0.0;  ///< … a robot at most so far from it is near it at all of them, m.
  Pose2 robot_at_zero_ = {};
  double height_at_zero_ = 0.0;  ///< m; all heights are 0 in the plane.
  double layer_height_ = 0.0, box_height_ = 0.0;
};

/// The boxes of level 0 of one rotation.
struct Bottom {
  Bottom(const Problem& problem, std::size_t number)
      : rotation(number),
        wanted(problem, 0, rotation),
        robots(problem.boxes.pose(0, rotation, problem.middle_of_box(), problem.middle_of_box()) *
                   problem.above_from_robot,
               problem.boxes.height(problem.middle_of_box()) + problem.local_from_robot.z,
               problem.boxes.frame().cell, problem.rule.cell_distance, problem.rule.cell_rotation) {}

  std::size_t rotation;
  WantedBoxes wanted;
  RobotCells robots;
  std::optional<CellPoints> middles = {};  ///< See AllPoses; once a box has reached the bar.
};

/// The search below one interval of rotations of the top level.
class IntervalSearch {
 public:
  IntervalSearch(const Problem& problem, std::size_t least, std::size_t most_looks)
      : problem_(problem), least_(least), most_looks_(most_looks) {}

  /// A first look at all tiles of the top level.
  [[nodiscard]] FirstLook look(std::size_t rotation) {
    const std::vector<CellPoints> points = problem_.boxes.cells(problem_.pyramid.top_level(), rotation);
    const Translations all = problem_.boxes.translations(points, least_);
    Interval interval{.rotation = rotation, .tiles = top_tiles(rotation, all), .last_layer = all.last_layer};
    if (problem_.all_poses != nullptr) {
      keep_promising(interval, points);
    } else {
      dive(interval, points);
    }
    return {std::move(interval), std::move(found_)};
  }

  /// Given up after so many looks: what is found is then not all.
  [[nodiscard]] FoundPlaces search(const Interval& interval) {
    const int top = problem_.pyramid.top_level();
    last_layer_ = interval.last_layer;
    look_at(top, interval.rotation, problem_.boxes.cells(top, interval.rotation), interval.tiles);
    return std::move(found_);
  }

 private:
  /// Those that hold all wanted ones of some translations.
  [[nodiscard]] std::vector<Tile> top_tiles(std::size_t rotation, const Translations& all) const {
    const int top = problem_.pyramid.top_level();
    const int columns = TileCounts::columns << top;
    const int rows = TileCounts::rows << top;
    const WantedBoxes wanted(problem_, top, rotation);
    std::vector<Tile> tiles;
    for (int layer = all.first_layer; layer <= all.last_layer; layer += problem_.boxes.layers_of_box(top)) {
      for (int row = all.first_row; row <= all.last_row; row += rows) {
        for (int column = all.first_column; column <= all.last_column; column += columns) {
          const Tile tile{column, row, layer};
          if (wanted.any(tile, columns, rows)) tiles.push_back(tile);
        }
      }
    }
    return tiles;
  }

  /// Counts the points in contact in the boxes of a tile; whether one of them reaches so many.
  [[nodiscard]] bool reaches(int level, const std::vector<CellPoints>& points, const Tile& tile,
                             std::size_t least) {
    if (level == 0) found_.tested += std::size_t{TileCounts::columns} * TileCounts::rows;
    found_.looks += problem_.pyramid.count(level, points, tile.column, tile.row, tile.layer, least, counts_);
    return counts_.largest() >= least;
  }

  /// Leaves the tiles that can reach the bar. Of all poses much contact is asked for, and few can.
  void keep_promising(Interval& interval, const std::vector<CellPoints>& points) {
    const int top = problem_.pyramid.top_level();
    const std::vector<CellPoints> clusters = problem_.all_poses->cluster_cells(interval.rotation);
    // With fewer clusters in contact, and all points that are in none, the bar is not reached.
    const std::size_t loose = problem_.all_poses->points_without_cluster();
    const std::size_t least_clusters = least_ > loose ? (least_ - loose - 1) / AllPoses::cluster_size + 1 : 0;
    std::erase_if(interval.tiles, [&](const Tile& tile) {
      if (least_clusters > 0 && !reaches(top, clusters, tile, least_clusters)) return true;
      if (!reaches(top, points, tile, least_)) return true;
      interval.bound = std::max(interval.bound, counts_.largest());
      return false;
    });
    interval.promise = interval.bound;
  }

  /// Follows the box that promises most to the bottom. Of a grid the best poses are asked for, however good
  /// they are: what is found so raises the bar before the search begins.
  void dive(Interval& interval, const std::vector<CellPoints>& points) {
    const int top = problem_.pyramid.top_level();
    Tile best{};
    for (const Tile& tile : interval.tiles) {
      if (!reaches(top, points, tile, interval.bound + 1)) continue;
      interval.bound = counts_.largest();
      const auto [column, row] = first_of(counts_.at_least(interval.bound));
      best = {tile.column + (column << top), tile.row + (row << top), tile.layer};
    }
    if (interval.bound == 0) return;
    Bottom bottom(problem_, interval.rotation);
    const int end_layer = std::min(best.layer + problem_.boxes.layers_of_box(top), interval.last_layer + 1);
    for (Tile tile = best; tile.layer < end_layer; ++tile.layer) {
      for (tile.row = best.row; tile.row < best.row + (1 << top); tile.row += TileCounts::rows) {
        if (reaches(0, points, tile, 1)) add_boxes(bottom, tile, counts_.largest());
      }
    }
    for (const auto& [cell, place] : found_.places)
      interval.promise = std::max(interval.promise, place.bound);
  }

  static std::array<int, 2> first_of(const TileCounts::Mask& boxes) {
    int row = 0;
    while (boxes[static_cast<std::size_t>(row)] == 0) ++row;
    return {std::countr_zero(boxes[static_cast<std::size_t>(row)]), row};
  }

  /// `points` are the cells of this rotation.
  void look_at(int level, std::size_t rotation, const std::vector<CellPoints>& points,
               const std::vector<Tile>& tiles) {
    if (level == 0) return look_at_bottom(rotation, points, tiles);
    const WantedBoxes wanted(problem_, level, rotation);
    std::vector<Tile> quarters;
    for (const Tile& tile : tiles) {
      if (!wanted.any(tile, TileCounts::columns << level, TileCounts::rows << level)) continue;
      if (found_.looks > most_looks_) return;
      if (reaches(level, points, tile, least_)) add_quarters(level, tile, wanted, quarters);
    }
    if (quarters.empty()) return;
    if (problem_.all_poses == nullptr) return look_at(level - 1, rotation, points, quarters);
    for (const std::size_t half : {2 * rotation, 2 * rotation + 1})
      look_at(level - 1, half, problem_.boxes.cells(level - 1, half), quarters);
  }

  void look_at_bottom(std::size_t rotation, const std::vector<CellPoints>& points,
                      const std::vector<Tile>& tiles) {
    Bottom bottom(problem_, rotation);
    for (const Tile& tile : tiles) {
      if (!bottom.wanted.any(tile, TileCounts::columns, TileCounts::rows)) continue;
      if (found_.looks > most_looks_) return;
      if (reaches(0, points, tile, least_)) add_boxes(bottom, tile, least_);
    }
  }

  /// A quarter of the boxes of the tile just counted makes a tile of the level below; where boxes are higher
  /// than those there, one for each half of the layers.
  void add_quarters(int level, const Tile& tile, const WantedBoxes& wanted, std::vector<Tile>& quarters) {
    const TileCounts::Mask promising = counts_.at_least(least_);
    constexpr int columns = TileCounts::columns / 2;
    constexpr int rows = TileCounts::rows / 2;
    const int layers = problem_.boxes.layers_of_box(level - 1);
    const int end_layer = std::min(tile.layer + problem_.boxes.layers_of_box(level), last_layer_ + 1);
    for (int k = 0; k < TileCounts::rows; k += rows) {
      for (int i = 0; i < TileCounts::columns; i += columns) {
        bool any = false;
        for (int row = k; row < k + rows && !any; ++row) {
          for (auto left = static_cast<std::uint32_t>(promising[static_cast<std::size_t>(row)] >> i);
               left != 0 && !any; left &= left - 1) {
            const int column = tile.column + ((i + std::countr_zero(left)) << level);
            any = wanted.any({column, tile.row + (row << level), tile.layer}, 1 << level, 1 << level);
          }
        }
        for (int layer = tile.layer; any && layer < end_layer; layer += layers)
          quarters.push_back({tile.column + (i << level), tile.row + (k << level), layer});
      }
    }
  }

  /// Those of the tile just counted that reach so much.
  void add_boxes(Bottom& bottom, const Tile& tile, std::size_t least) {
    if (problem_.all_poses != nullptr) count_middles(bottom, tile);
    const TileCounts::Mask boxes = counts_.at_least(least);
    for (int k = 0; k < TileCounts::rows; ++k) {
      for (std::uint64_t left = boxes[static_cast<std::size_t>(k)]; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (!bottom.wanted.any({tile.column + i, tile.row + k, tile.layer}, 1, 1)) continue;
        const std::size_t bound = counts_.at(i, k);
        const std::size_t at_middle = problem_.all_poses != nullptr ? middle_counts_.at(i, k) : bound;
        const Box box{bottom.rotation, tile.row + k, tile.column + i, tile.layer, at_middle};
        found_.take_in(bottom.robots.of(box), {bound, box});
      }
    }
  }

  void count_middles(Bottom& bottom, const Tile& tile) {
    if (!bottom.middles) bottom.middles = problem_.all_poses->middle_cells(bottom.rotation);
    problem_.pyramid.count_middles(*bottom.middles, tile.column, tile.row, tile.layer, middle_counts_);
    found_.looks += bottom.middles->size();
  }

  const Problem& problem_;
  std::size_t least_;
  std::size_t most_looks_;
  int last_layer_ = 0;  ///< Of translations.
  TileCounts counts_, middle_counts_;
  FoundPlaces found_;
};

void take_in(BoxSearchResult& result, const FoundPlaces& found) {
  result.tested += found.tested;
  result.looks += found.looks;
}

/// A first look at every interval: those that promise most come first.
std::vector<Interval> look_at_all(const Problem& problem, BestPlaces& best, BoxSearchResult& result,
                                  int threads) {
  std::vector<FirstLook> looks(problem.boxes.rotations(problem.pyramid.top_level()));
  parallel_for(threads, looks.size(), [&](std::size_t i) {
    looks[i] = IntervalSearch(problem, problem.rule.least, problem.rule.most_looks).look(i);
  });
  std::vector<Interval> intervals;
  for (FirstLook& look : looks) {
    take_in(result, look.found);
    best.add(look.found.places);
    intervals.push_back(std::move(look.interval));
  }
  best.raise();
  std::stable_sort(intervals.begin(), intervals.end(),
                   [](const Interval& a, const Interval& b) { return a.promise > b.promise; });
  return intervals;
}

/// The search of what reaches the bar, which rises. Returns whether it came to its end.
bool search_all(const Problem& problem, std::span<const Interval> intervals, BestPlaces& best,
                BoxSearchResult& result, int threads) {
  const std::size_t most_looks = problem.rule.most_looks;
  const auto reaches_bar = [&](const Interval& interval) { return interval.bound >= best.bar(); };
  while (!intervals.empty()) {
    const auto batch = intervals.first(std::min(problem.intervals_at_a_time(), intervals.size()));
    intervals = intervals.subspan(batch.size());
    if (std::none_of(batch.begin(), batch.end(), reaches_bar)) continue;
    if (result.looks > most_looks) return false;
    // Of each interval, as all of them are searched before the next count.
    const std::size_t looks_each = (most_looks - result.looks) / 4;
    std::vector<FoundPlaces> found(batch.size());
    parallel_for(threads, batch.size(), [&](std::size_t i) {
      if (reaches_bar(batch[i])) found[i] = IntervalSearch(problem, best.bar(), looks_each).search(batch[i]);
    });
    for (const FoundPlaces& of_interval : found) {
      take_in(result, of_interval);
      best.add(of_interval.places);
      best.raise();
      if (of_interval.looks > looks_each) return false;
    }
  }
  return true;
}

}  // namespace

BoxSearchResult search_boxes(const BoxPyramid& pyramid, const Points& points, const Pose3& local_from_robot,
                             const BoxSearchRule& rule, const std::optional<Exclusion>& exclusion,
                             int threads) {
  BoxSearchResult result{.at_most = rule.least - 1};
  if (points.size() > TileCounts::most_points) return result;
  result.is_complete = rule.least > points.size();
  if (result.is_complete) return result;
  std::unique_ptr<const PoseBoxes> boxes;
  if (pyramid.of() == BoxPyramid::Of::pose_grid) {
    boxes = std::make_unique<PoseGrid>(points, pyramid.frame(), rule.min_rotation_step, local_from_robot.z);
  } else {
    boxes = std::make_unique<AllPoses>(points, pyramid.frame(), pyramid.top_level());
  }
  const Problem problem{.pyramid = pyramid,
                        .boxes = *boxes,
                        .all_poses = dynamic_cast<const AllPoses*>(boxes.get()),
                        .local_from_robot = local_from_robot,
                        .above_from_robot = seen_from_above(local_from_robot),
                        .rule = rule,
                        .exclusion = exclusion};
  BestPlaces best(rule.most_places, rule.least);
  const std::vector<Interval> intervals = look_at_all(problem, best, result, threads);
  result.is_complete = search_all(problem, intervals, best, result, threads);
  if (!result.is_complete) return result;
  const double middle = problem.middle_of_box();
  for (const auto& [bound, box] : best.falling(problem.all_poses == nullptr)) {
    result.poses.push_back({boxes->pose(0, box.rotation, box.column + middle, box.row + middle),
                            boxes->height(box.layer + middle), bound});
  }
  if (!result.poses.empty()) result.at_most = result.poses.front().in_contact;
  return result;
}

}  // namespace glocal
