#include "matchers/grid_search/rival_search.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <map>
#include <tuple>
#include <utility>

#include "glocal/parallel.hpp"
#include "matchers/grid_search/best_poses.hpp"
#include "matchers/grid_search/pose_grid.hpp"

namespace glocal {
namespace {

/// Intervals searched before the bar is raised. Fixed, so that the answer does not depend on the threads.
constexpr std::size_t intervals_at_a_time = 8;

/// A tile of boxes, by its first one's translation, and their box of layers.
struct Tile {
  int column, row;
  int layer;
};

/// An interval of rotations of the top level, and its tiles with boxes that can reach the bar.
struct Interval {
  std::size_t rotation = 0;
  std::size_t bound = 0;  ///< No box of any tile can have more points in contact.
  std::vector<Tile> tiles = {};
  std::size_t looks = 0;
};

/// A box of level 0, and how many points are in contact at its middle.
struct Box {
  std::size_t rotation = 0;
  int row = 0, column = 0, layer = 0;
  std::size_t at_middle = 0;
};

/// Boxes whose robots are in one cell.
struct Place {
  std::size_t bound = 0;  ///< No box has more points in contact.
  Box best = {};          ///< That with the most at its middle; of several the first.

  void take_in(const Place& other) {
    const auto rank = [](const Box& box) {
      return std::tuple(-static_cast<std::ptrdiff_t>(box.at_middle), box.rotation, box.layer, box.row,
                        box.column);
    };
    if (bound == 0 || rank(other.best) < rank(best)) best = other.best;
    bound = std::max(bound, other.bound);
  }
};

using Places = std::map<RobotCell, Place>;

/// What has been found in one interval of rotations.
struct Found {
  Places places = {};
  std::size_t looks = 0;
};

/// Which boxes of one interval of rotations are worth a look.
class WantedBoxes {
 public:
  WantedBoxes(const PoseBoxes& boxes, int level, std::size_t rotation, const Pose3& local_from_robot,
              const Pose3& declared, double cell, const RivalRule& rule, const PoseGate& gate)
      : cell_(cell),
        robot_at_zero_(boxes.pose(level, rotation, 0.0, 0.0) * seen_from_above(local_from_robot)),
        height_at_zero_(boxes.height(0.0) + local_from_robot.z),
        box_height_(boxes.box_height(level)),
        declared_(declared.translation()),
        near_(rule.distance - boxes.sway(level, local_from_robot.x, local_from_robot.y)),
        is_turned_(rotation_between(robot_at_zero_, seen_from_above(declared)) + boxes.half_width(level) >
                   rule.rotation),
        allowed_(widened(gate, boxes, level), boxes.pose(level, rotation, 0.0, 0.0), cell) {}

  /// Some of whose poses are allowed, and not near the declared one. A rectangle of translations, in cells,
  /// beginning with those of the tile's first box, and the tile's box of layers.
  [[nodiscard]] bool any(const Tile& tile, int columns, int rows) const {
    return allowed_.any(tile.column, tile.row, columns + 1, rows + 1) && !is_near(tile, columns, rows);
  }

 private:
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
    if (is_turned_) return false;
    const auto farther = [](double low, double size, double declared) {
      return std::max(std::abs(low - declared), std::abs(low + size - declared));
    };
    return std::hypot(farther(robot_at_zero_.x + cell_ * tile.column, cell_ * columns, declared_.x),
                      farther(robot_at_zero_.y + cell_ * tile.row, cell_ * rows, declared_.y),
                      farther(height_at_zero_ + box_height_ * tile.layer, box_height_, declared_.z)) <= near_;
  }

  double cell_;
  Pose2 robot_at_zero_;
  double height_at_zero_;  ///< m; 0 in the plane, as is that of a box of layers.
  double box_height_;
  Vector3 declared_;
  double near_;     ///< m; at this distance from the declared pose a robot is near it at all rotations.
  bool is_turned_;  ///< Some of the rotations are no longer near.
  AllowedTranslations allowed_;
};

/// The search below one interval of rotations of the top level.
class IntervalSearch {
 public:
  IntervalSearch(const BoxPyramid& pyramid, const PoseBoxes& boxes, const Pose3& local_from_robot,
                 const Pose3& declared, std::size_t least, const RivalRule& rule, const PoseGate& gate)
      : pyramid_(pyramid),
        boxes_(boxes),
        local_from_robot_(local_from_robot),
        declared_(declared),
        least_(least),
        rule_(rule),
        gate_(gate) {}

  /// A first look at all tiles of the top level.
  [[nodiscard]] Interval look(std::size_t rotation) {
    const int top = pyramid_.top_level();
    const std::vector<CellPoints> points = boxes_.cells(top, rotation);
    const std::vector<CellPoints> clusters = boxes_.cluster_cells(rotation);
    // With fewer clusters in contact, and all points that are in none, the bar is not reached.
    const std::size_t loose = boxes_.points_without_cluster();
    const std::size_t least_clusters =
        least_ > loose ? (least_ - loose - 1) / PoseBoxes::cluster_size + 1 : 0;
    Interval interval{.rotation = rotation};
    for (const Tile& tile : top_tiles(points)) {
      if (least_clusters > 0) {
        interval.looks +=
            pyramid_.count(top, clusters, tile.column, tile.row, tile.layer, least_clusters, counts_);
        if (counts_.largest() < least_clusters) continue;
      }
      interval.looks += pyramid_.count(top, points, tile.column, tile.row, tile.layer, least_, counts_);
      if (counts_.largest() < least_) continue;
      interval.bound = std::max(interval.bound, counts_.largest());
      interval.tiles.push_back(tile);
    }
    return interval;
  }

  /// Given up after so many looks: what is found is then not all.
  [[nodiscard]] Found search(const Interval& interval, std::size_t most_looks) {
    most_looks_ = most_looks;
    const int top = pyramid_.top_level();
    look_at(top, interval.rotation, boxes_.cells(top, interval.rotation), interval.tiles);
    return std::move(found_);
  }

 private:
  /// Tiles that hold all translations which leave `least` points among the windows that are not empty.
  [[nodiscard]] std::vector<Tile> top_tiles(const std::vector<CellPoints>& points) const {
    const int top = pyramid_.top_level();
    const CellFrame& frame = pyramid_.frame();
    // Of windows from the first one with a cell in contact to the last, which is by so many later for points
    // of a group with wider ones.
    const auto range = [&](int first_window, int last_window, auto wider_of,
                           auto coordinates_of) -> std::pair<int, int> {
      std::vector<int> first, last;
      for (std::size_t g = 0; g < points.size(); ++g) {
        const int wider = wider_of(static_cast<int>(g) + 1);
        for (const std::int32_t coordinate : coordinates_of(points[g])) {
          first.push_back(first_window - coordinate);
          last.push_back(last_window + wider - coordinate);
        }
      }
      const auto nth = static_cast<std::ptrdiff_t>(least_ - 1);
      std::nth_element(first.begin(), first.begin() + nth, first.end());
      std::nth_element(last.begin(), last.begin() + nth, last.end(), std::greater<>());
      return {first[least_ - 1], last[least_ - 1]};
    };
    const auto wider = [top](int group) { return PoseBoxes::wider(top, group); };
    const auto no_wider = [](int /*group*/) { return 0; };
    const auto [left, right] =
        range(1 - (1 << top), frame.columns - 1, wider, [](const CellPoints& p) { return p.columns(); });
    const auto [low, high] =
        range(1 - (1 << top), frame.rows - 1, wider, [](const CellPoints& p) { return p.rows(); });
    const BoxPyramid::BoxesOfLayers all = pyramid_.boxes_of_layers(top);
    const auto [bottom, ceiling] =
        range(all.first, all.last, no_wider, [](const CellPoints& p) { return p.layers(); });
    std::vector<Tile> tiles;
    for (int layer = bottom; layer <= ceiling; ++layer) {
      for (int row = low; row <= high; row += TileCounts::rows << top) {
        for (int column = left; column <= right; column += TileCounts::columns << top)
          tiles.push_back({column, row, layer});
      }
    }
    return tiles;
  }

  void look_at(int level, std::size_t rotation, const std::vector<CellPoints>& points,
               const std::vector<Tile>& tiles) {
    const WantedBoxes wanted(boxes_, level, rotation, local_from_robot_, declared_, pyramid_.frame().cell,
                             rule_, gate_);
    std::vector<Tile> promising;
    for (const Tile& tile : tiles) {
      if (!wanted.any(tile, TileCounts::columns << level, TileCounts::rows << level)) continue;
      if (found_.looks > most_looks_) return;
      found_.looks += pyramid_.count(level, points, tile.column, tile.row, tile.layer, least_, counts_);
      if (counts_.largest() < least_) continue;
      if (level == 0) {
        add_boxes(rotation, tile, wanted);
      } else {
        add_quarters(level, tile, wanted, promising);
      }
    }
    if (promising.empty()) return;
    for (const std::size_t half : {2 * rotation, 2 * rotation + 1})
      look_at(level - 1, half, boxes_.cells(level - 1, half), promising);
  }

  /// A quarter of a tile's boxes makes a tile of the level below; where boxes are higher than those there,
  /// one for each half of the layers.
  void add_quarters(int level, const Tile& tile, const WantedBoxes& wanted, std::vector<Tile>& quarters) {
    const TileCounts::Mask boxes = counts_.at_least(least_);
    constexpr int half_columns = TileCounts::columns / 2;
    constexpr int half_rows = TileCounts::rows / 2;
    const CellFrame& frame = pyramid_.frame();
    const int halves = PoseBoxes::layers_of_box(level, frame) / PoseBoxes::layers_of_box(level - 1, frame);
    for (int k = 0; k < TileCounts::rows; k += half_rows) {
      for (int i = 0; i < TileCounts::columns; i += half_columns) {
        bool any = false;
        for (int r = k; r < k + half_rows && !any; ++r) {
          for (auto left = static_cast<std::uint32_t>(boxes[static_cast<std::size_t>(r)] >> i);
               left != 0 && !any; left &= left - 1) {
            const int column = tile.column + ((i + std::countr_zero(left)) << level);
            any = wanted.any({column, tile.row + (r << level), tile.layer}, 1 << level, 1 << level);
          }
        }
        for (int half = 0; any && half < halves; ++half)
          quarters.push_back(
              {tile.column + (i << level), tile.row + (k << level), halves * tile.layer + half});
      }
    }
  }

  /// Those of the tile just counted, of level 0.
  void add_boxes(std::size_t rotation, const Tile& tile, const WantedBoxes& wanted) {
    const TileCounts::Mask boxes = counts_.at_least(least_);
    if (rotation != rotation_of_middles_) middles_ = boxes_.middle_cells(rotation);
    rotation_of_middles_ = rotation;
    pyramid_.count_middles(middles_, tile.column, tile.row, tile.layer, middle_counts_);
    found_.looks += middles_.size();
    const RobotCells robots(boxes_.pose(0, rotation, 0.5, 0.5) * seen_from_above(local_from_robot_),
                            boxes_.height(0.5) + local_from_robot_.z, pyramid_.frame().cell,
                            {.distance = rule_.cell_distance, .rotation = rule_.cell_rotation});
    for (int k = 0; k < TileCounts::rows; ++k) {
      for (std::uint64_t left = boxes[static_cast<std::size_t>(k)]; left != 0; left &= left - 1) {
        const int i = std::countr_zero(left);
        if (!wanted.any({tile.column + i, tile.row + k, tile.layer}, 1, 1)) continue;
        const Box box{rotation, tile.row + k, tile.column + i, tile.layer, middle_counts_.at(i, k)};
        const RobotCell place =
            robots.of({.rotation = rotation, .row = box.row, .column = box.column, .layer = box.layer});
        found_.places[place].take_in({counts_.at(i, k), box});
      }
    }
  }

  const BoxPyramid& pyramid_;
  const PoseBoxes& boxes_;
  Pose3 local_from_robot_, declared_;
  std::size_t least_;
  const RivalRule& rule_;
  const PoseGate& gate_;
  std::size_t most_looks_ = 0;
  TileCounts counts_, middle_counts_;
  CellPoints middles_;
  std::size_t rotation_of_middles_ = std::numeric_limits<std::size_t>::max();
  Found found_;
};

/// The places with the highest bounds, and the bar for others.
class BestPlaces {
 public:
  BestPlaces(std::size_t most, std::size_t least) : most_(most), bar_(least) {}

  [[nodiscard]] std::size_t bar() const { return bar_; }
  [[nodiscard]] std::vector<Place> falling() const {
    std::vector<Place> falling;
    for (const auto& [cell, place] : places_) falling.push_back(place);
    std::stable_sort(falling.begin(), falling.end(),
                     [](const Place& a, const Place& b) { return a.bound > b.bound; });
    if (falling.size() > most_) falling.resize(most_);
    return falling;
  }

  /// If there are as many as are wanted, only what beats the last of them will do from now on.
  void add(const Places& found) {
    for (const auto& [cell, place] : found) places_[cell].take_in(place);
    const std::vector<Place> best = falling();
    if (best.size() < most_) return;
    const std::size_t last = best.back().bound;
    bar_ = last + 1;
    std::erase_if(places_, [&](const auto& entry) { return entry.second.bound < last; });
  }

 private:
  std::size_t most_;
  std::size_t bar_;
  Places places_;
};

}  // namespace

RivalSearchResult search_rivals(const BoxPyramid& pyramid, const Points& points,
                                const Pose3& local_from_robot, const Pose3& map_from_robot, std::size_t least,
                                const RivalRule& rule, const PoseGate& gate, int threads) {
  RivalSearchResult result{.at_most = least - 1};
  if (points.size() > TileCounts::most_points) return result;
  if (least > points.size()) {
    result.is_complete = true;
    return result;
  }
  const PoseBoxes boxes(points, pyramid.frame(), pyramid.top_level());
  const std::size_t rotations = boxes.rotations(pyramid.top_level());
  BestPlaces best(rule.most_rivals, least);
  const auto search_above = [&](std::size_t bar) {
    return IntervalSearch(pyramid, boxes, local_from_robot, map_from_robot, bar, rule, gate);
  };
  std::vector<Interval> intervals(rotations);
  parallel_for(threads, rotations, [&](std::size_t i) { intervals[i] = search_above(least).look(i); });
  for (const Interval& interval : intervals) result.looks += interval.looks;
  // The most promising first, so that the bar rises early.
  std::stable_sort(intervals.begin(), intervals.end(),
                   [](const Interval& a, const Interval& b) { return a.bound > b.bound; });
  std::vector<Found> found;
  for (std::size_t begin = 0; begin < rotations && intervals[begin].bound >= best.bar();
       begin += intervals_at_a_time) {
    if (result.looks > rule.most_looks) return result;
    // Of each interval, as all of them are searched before the next count.
    const std::size_t most_looks = (rule.most_looks - result.looks) / 4;
    found.assign(std::min(intervals_at_a_time, rotations - begin), {});
    parallel_for(threads, found.size(), [&](std::size_t i) {
      const Interval& interval = intervals[begin + i];
      if (interval.bound >= best.bar()) found[i] = search_above(best.bar()).search(interval, most_looks);
    });
    for (const Found& interval : found) {
      result.looks += interval.looks;
      best.add(interval.places);
      if (interval.looks > most_looks) return result;
    }
  }
  for (const Place& place : best.falling()) {
    const Box& box = place.best;
    const Pose2 above = boxes.pose(0, box.rotation, box.column + 0.5, box.row + 0.5);
    result.rivals.push_back(
        {Pose3({above.x, above.y, boxes.height(box.layer + 0.5)}, turn_about_z(above.theta)), place.bound});
  }
  if (!result.rivals.empty()) result.at_most = result.rivals.front().in_contact;
  result.is_complete = true;
  return result;
}

}  // namespace glocal
