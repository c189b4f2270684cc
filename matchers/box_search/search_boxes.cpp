#include "matchers/box_search/search_boxes.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "glocal/parallel.hpp"
#include "matchers/box_search/allowed_translations.hpp"

namespace glocal {
namespace box_search {

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
  /// No box of it can have more points in contact.
  std::size_t bound = std::numeric_limits<std::size_t>::max();
};

/// An interval of rotations of the top level, after a first look.
struct Interval {
  std::size_t rotation = 0;
  std::size_t bound = 0;    ///< No box of any tile can have more points in contact.
  std::size_t promise = 0;  ///< What is searched first promises most.
  /// All that may have a box that reaches the bar: of a grid those of the top level, and else of the one
  /// below, if there is one.
  std::vector<Tile> tiles = {};
  int last_layer = 0;  ///< Of translations.
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

/// The search of one interval of rotations of the top level. It can be interrupted after any part.
class IntervalSearch {
 public:
  IntervalSearch(const Problem& problem, std::size_t least, std::size_t most_looks)
      : problem_(problem), least_(least), most_looks_(most_looks) {}

  /// A first look at all tiles of the top level.
  [[nodiscard]] FirstLook look(std::size_t rotation) {
    const std::vector<CellPoints> points = problem_.boxes.cells(problem_.pyramid.top_level(), rotation);
    const Translations all = problem_.boxes.translations(points, least_);
    last_layer_ = all.last_layer;
    Interval interval{.rotation = rotation, .tiles = top_tiles(rotation, all), .last_layer = all.last_layer};
    if (problem_.all_poses != nullptr) {
      keep_promising(interval, points);
    } else {
      dive(interval, points);
    }
    return {std::move(interval), std::move(found_)};
  }

  /// Begins the search below a first look. Given up after `most_looks`: what is found is then not all.
  void begin(const Interval& interval) {
    last_layer_ = interval.last_layer;
    const int top = problem_.pyramid.top_level();
    if (problem_.all_poses == nullptr || top == 0) {
      open_.push_back({top, interval.rotation, interval.tiles});
    } else {
      open_below(top, interval.rotation, interval.tiles);
    }
  }

  /// Goes on for about so many looks, at least one part, until it is over. Returns how many were taken.
  std::size_t advance(std::size_t looks) {
    const std::size_t before = found_.looks;
    while (!is_over() && found_.looks - before < looks) {
      const Part part = std::move(open_.back());
      open_.pop_back();
      look_at(part);
    }
    return found_.looks - before;
  }

  [[nodiscard]] bool is_over() const { return open_.empty(); }
  [[nodiscard]] const FoundPlaces& found() const { return found_; }

 private:
  /// What is still to be looked at: some tiles of an interval of a level.
  struct Part {
    int level;
    std::size_t rotation;
    std::vector<Tile> tiles;
  };

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
    const WantedBoxes wanted(problem_, top, interval.rotation);
    std::vector<Tile> promising;
    for (const Tile& tile : interval.tiles) {
      if (least_clusters > 0 && !reaches(top, clusters, tile, least_clusters)) continue;
      if (!reaches(top, points, tile, least_)) continue;
      interval.bound = std::max(interval.bound, counts_.largest());
      if (top > 0) {
        add_quarters(top, tile, wanted, promising);
      } else {
        promising.push_back(tile);
      }
    }
    interval.tiles = std::move(promising);
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
    for (const auto& [cell, box] : found_.places)
      interval.promise = std::max(interval.promise, box.at_middle);
    std::erase_if(found_.places, [&](const auto& place) { return place.second.at_middle < least_; });
  }

  static std::array<int, 2> first_of(const TileCounts::Mask& boxes) {
    int row = 0;
    while (boxes[static_cast<std::size_t>(row)] == 0) ++row;
    return {std::countr_zero(boxes[static_cast<std::size_t>(row)]), row};
  }

  void look_at(const Part& part) {
    const auto& [level, rotation, tiles] = part;
    // On a grid they are the same at all levels.
    if (problem_.all_poses != nullptr || points_.empty()) points_ = problem_.boxes.cells(level, rotation);
    if (level == 0) return look_at_bottom(rotation, tiles);
    const WantedBoxes wanted(problem_, level, rotation);
    std::vector<Tile> quarters;
    for (const Tile& tile : tiles) {
      if (tile.bound < least_) continue;
      if (!wanted.any(tile, TileCounts::columns << level, TileCounts::rows << level)) continue;
      if (found_.looks > most_looks_) return;
      if (reaches(level, points_, tile, least_)) add_quarters(level, tile, wanted, quarters);
    }
    open_below(level, rotation, std::move(quarters));
  }

  /// Tiles of the level below, in each half of an interval.
  void open_below(int level, std::size_t rotation, std::vector<Tile> tiles) {
    if (tiles.empty()) return;
    if (problem_.all_poses == nullptr) {
      open_.push_back({level - 1, rotation, std::move(tiles)});
    } else {
      open_.push_back({level - 1, 2 * rotation + 1, tiles});
      open_.push_back({level - 1, 2 * rotation, std::move(tiles)});
    }
  }

  void look_at_bottom(std::size_t rotation, const std::vector<Tile>& tiles) {
    Bottom bottom(problem_, rotation);
    for (const Tile& tile : tiles) {
      if (tile.bound < least_ || !bottom.wanted.any(tile, TileCounts::columns, TileCounts::rows)) continue;
      if (found_.looks > most_looks_) return;
      if (reaches(0, points_, tile, least_)) add_boxes(bottom, tile, least_);
    }
    // What is worse than as many of this interval as are wanted is not among the best of all.
    least_ = std::max(least_, keep_best(found_.places, problem_.rule.most_places));
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
          quarters.push_back({tile.column + (i << level), tile.row + (k << level), layer, counts_.largest()});
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
        take_in(found_.places, bottom.robots.of(box), box);
        found_.at_most = std::max(found_.at_most, bound);
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
  int last_layer_ = 0;              ///< Of translations.
  std::vector<Part> open_;          ///< The last of them comes next.
  std::vector<CellPoints> points_;  ///< Of the rotation that is looked at.
  TileCounts counts_, middle_counts_;
  FoundPlaces found_;
};

std::unique_ptr<const PoseBoxes> boxes_of(const BoxPyramid& pyramid, const Points& points,
                                          double robot_height, double min_rotation_step) {
  if (pyramid.of() == BoxPyramid::Of::pose_grid)
    return std::make_unique<PoseGrid>(points, pyramid.frame(), min_rotation_step, robot_height);
  return std::make_unique<AllPoses>(points, pyramid.frame(), pyramid.top_level());
}

/// First all intervals get a first look. Then those that promise most are searched, a batch of them at a
/// time, and what they bring raises the bar for the next.
class State {
 public:
  State(const BoxPyramid& pyramid, Points points, const Pose3& local_from_robot, const BoxSearchRule& rule,
        const std::optional<Exclusion>& exclusion, int threads)
      : points_(std::move(points)),
        local_from_robot_(local_from_robot),
        rule_(rule),
        exclusion_(exclusion),
        threads_(threads),
        boxes_(boxes_of(pyramid, points_, local_from_robot.z, rule.min_rotation_step)),
        problem_{.pyramid = pyramid,
                 .boxes = *boxes_,
                 .all_poses = dynamic_cast<const AllPoses*>(boxes_.get()),
                 .local_from_robot = local_from_robot_,
                 .above_from_robot = seen_from_above(local_from_robot_),
                 .rule = rule_,
                 .exclusion = exclusion_},
        best_(rule.most_places, rule.least),
        rotations_(boxes_->rotations(pyramid.top_level())) {
    result_.at_most = rule.least - 1;
  }
  State(const State&) = delete;  // The problem refers to what is here.
  State& operator=(const State&) = delete;

  void advance(std::size_t looks) {
    const std::size_t before = looks_;
    while (!is_over_ && looks_ - before < looks) {
      const std::size_t left = looks - (looks_ - before);
      if (first_looks_.size() < rotations_) {
        take_first_looks(left);
      } else if (batch_.empty()) {
        begin_batch();
      } else {
        search_batch(left);
      }
    }
  }

  [[nodiscard]] bool is_over() const { return is_over_; }
  [[nodiscard]] std::size_t looks() const { return looks_; }

  [[nodiscard]] BoxSearchResult result() const {
    BoxSearchResult result = result_;
    if (!result.is_complete) return result;
    const double middle = problem_.middle_of_box();
    for (const Box& box : best_.falling()) {
      result.poses.push_back({boxes_->pose(0, box.rotation, box.column + middle, box.row + middle),
                              boxes_->height(box.layer + middle), box.at_middle});
    }
    return result;
  }

 private:
  /// At as many intervals as these looks are likely to do for, going by those before.
  void take_first_looks(std::size_t looks) {
    constexpr std::size_t at_first = 8;
    const std::size_t done = first_looks_.size();
    const std::size_t likely = done == 0 ? at_first : looks / (looks_ / done + 1);
    const std::size_t size = std::clamp<std::size_t>(likely, 1, rotations_ - done);
    first_looks_.resize(done + size);
    parallel_for(threads_, size, [&](std::size_t i) {
      first_looks_[done + i] = IntervalSearch(problem_, rule_.least, rule_.most_looks).look(done + i);
    });
    for (const FirstLook& look : std::span(first_looks_).subspan(done)) {
      looks_ += look.found.looks;
      take_in(look.found);
    }
    if (first_looks_.size() < rotations_) return;
    best_.raise();
    std::stable_sort(first_looks_.begin(), first_looks_.end(), [](const FirstLook& a, const FirstLook& b) {
      return a.interval.promise > b.interval.promise;
    });
  }

  void begin_batch() {
    const auto rest = std::span<const FirstLook>(first_looks_).subspan(next_);
    const auto some = rest.first(std::min(problem_.intervals_at_a_time(), rest.size()));
    next_ += some.size();
    const bool is_given_up = result_.looks > rule_.most_looks;
    // Of each interval, as all of them are searched before the next count.
    looks_each_ = is_given_up ? 0 : (rule_.most_looks - result_.looks) / 4;
    for (const auto& [interval, found] : some) {
      if (interval.bound < best_.bar()) continue;
      if (is_given_up) return end(false);
      batch_.emplace_back(problem_, best_.bar(), looks_each_).begin(interval);
    }
    if (batch_.empty() && next_ == first_looks_.size()) end(true);
  }

  void search_batch(std::size_t looks) {
    const std::size_t looks_of_each = std::max<std::size_t>(looks / batch_.size(), 1);
    std::vector<std::size_t> taken(batch_.size());
    parallel_for(threads_, batch_.size(),
                 [&](std::size_t i) { taken[i] = batch_[i].advance(looks_of_each); });
    for (const std::size_t of_interval : taken) looks_ += of_interval;
    if (std::all_of(batch_.begin(), batch_.end(), [](const IntervalSearch& s) { return s.is_over(); }))
      end_batch();
  }

  void end_batch() {
    for (const IntervalSearch& search : batch_) {
      take_in(search.found());
      best_.raise();
      if (search.found().looks > looks_each_) return end(false);
    }
    batch_.clear();
    if (next_ == first_looks_.size()) end(true);
  }

  void take_in(const FoundPlaces& found) {
    result_.tested += found.tested;
    result_.looks += found.looks;
    result_.at_most = std::max(result_.at_most, found.at_most);
    best_.add(found.places);
  }

  void end(bool is_complete) {
    result_.is_complete = is_complete;
    is_over_ = true;
  }

  Points points_;
  Pose3 local_from_robot_;
  BoxSearchRule rule_;
  std::optional<Exclusion> exclusion_;
  int threads_;
  std::unique_ptr<const PoseBoxes> boxes_;
  Problem problem_;
  BestPlaces best_;
  BoxSearchResult result_;
  std::size_t looks_ = 0;  ///< With those of intervals whose result does not count yet.
  bool is_over_ = false;
  std::size_t rotations_;               ///< How many intervals there are.
  std::vector<FirstLook> first_looks_;  ///< Once there are all, those that promise most come first.
  std::size_t next_ = 0;                ///< Of them; those before are searched, or in the batch.
  std::vector<IntervalSearch> batch_;   ///< Searched before the bar is raised again.
  std::size_t looks_each_ = 0;          ///< That an interval of the batch may take.
};

}  // namespace box_search

BoxSearch::BoxSearch(const BoxPyramid& pyramid, Points points, const Pose3& local_from_robot,
                     const BoxSearchRule& rule, const std::optional<Exclusion>& exclusion, int threads) {
  over_.at_most = rule.least - 1;
  over_.is_complete = points.size() <= TileCounts::most_points && rule.least > points.size();
  if (points.size() <= TileCounts::most_points && !over_.is_complete)
    state_ = std::make_unique<box_search::State>(pyramid, std::move(points), local_from_robot, rule,
                                                 exclusion, threads);
}

BoxSearch::BoxSearch(BoxSearch&&) noexcept = default;
BoxSearch& BoxSearch::operator=(BoxSearch&&) noexcept = default;
BoxSearch::~BoxSearch() = default;

std::size_t BoxSearch::advance(std::size_t looks) {
  if (is_over()) return 0;
  const std::size_t before = state_->looks();
  state_->advance(looks);
  return state_->looks() - before;
}

bool BoxSearch::is_over() const {
  return !state_ || state_->is_over();
}

BoxSearchResult BoxSearch::result() const {
  return state_ ? state_->result() : over_;
}

BoxSearchResult search_boxes(const BoxPyramid& pyramid, const Points& points, const Pose3& local_from_robot,
                             const BoxSearchRule& rule, const std::optional<Exclusion>& exclusion,
                             int threads) {
  BoxSearch search(pyramid, points, local_from_robot, rule, exclusion, threads);
  search.advance(BoxSearch::to_the_end);
  return search.result();
}

}  // namespace glocal
