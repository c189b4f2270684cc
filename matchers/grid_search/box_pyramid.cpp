#include "matchers/grid_search/box_pyramid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>

#include "glocal/parallel.hpp"
#include "matchers/common/squares.hpp"
#include "matchers/grid_search/pose_grid.hpp"

namespace glocal {
namespace {

/// Says of each window along one axis that has one of the cells from `begin` on and before `end`, whether one
/// of the cells from `behind` before to `ahead` - 1 after its own is marked: calls mark(window) after
/// entered(cell) for all cells up to its last one.
template <class Entered, class Mark>
void slide(int begin, int end, int behind, int ahead, Entered entered, Mark mark) {
  for (int window = begin + 1 - ahead; window < end + behind; ++window) {
    const int cell = window + ahead - 1;
    if (cell < end) entered(cell);
    mark(window);
  }
}

/// Windows of `behind` + `ahead` cells on either axis, of which `behind` come before the cell that names
/// them.
Windows widened(const Windows& cells, int behind, int ahead) {
  constexpr int never = std::numeric_limits<int>::min() / 2;
  const int columns = static_cast<int>(cells.width);
  const int rows = static_cast<int>(cells.height);
  const int before = ahead - 1;
  Windows lines{.columns_before = before,
                .width = static_cast<std::size_t>(columns + behind + before),
                .height = cells.height};
  int first_row = rows;
  int end_row = 0;
  for (int row = 0; row < rows; ++row) {
    const std::uint8_t* cell = &cells.bytes[cells.index(0, row, 0)];
    if (next_set(cell, cell + columns) == cell + columns) continue;
    first_row = std::min(first_row, row);
    end_row = row + 1;
    std::uint8_t* window = &lines.at(0, row, 0);
    int last = never;
    slide(
        0, columns, behind, ahead,
        [&](int column) {
          if (cell[column] != 0) last = column;
        },
        [&](int column) { window[column] = last >= column - behind ? 1 : 0; });
  }
  Windows windows{.columns_before = before,
                  .rows_before = before,
                  .width = lines.width,
                  .height = static_cast<std::size_t>(rows + behind + before)};
  const std::size_t width = lines.width;
  std::vector<int> last_of_columns(width, never);
  int* last = last_of_columns.data();
  slide(
      first_row, end_row, behind, ahead,
      [&](int row) {
        const std::uint8_t* line = &lines.at(-before, row, 0);
        for (std::size_t i = 0; i < width; ++i) last[i] = line[i] != 0 ? row : last[i];
      },
      [&](int row) {
        std::uint8_t* line = &windows.at(-before, row, 0);
        const int first = row - behind;
        for (std::size_t i = 0; i < width; ++i) line[i] = last[i] >= first ? 1 : 0;
      });
  return windows;
}

/// Windows of one size: those of a group of points of a level, or the cells for the middles of boxes.
struct WindowKind {
  int level = 0;
  bool of_middles = true;
  int wider = 0;   ///< How many cells wider than a box.
  int height = 1;  ///< Layers of cells.
  int step = 1;    ///< One begins every so many layers of cells.

  static WindowKind of_group(int level, int group, const CellFrame& frame) {
    const int step = PoseBoxes::layers_of_box(level, frame);
    return {.level = level,
            .of_middles = false,
            .wider = PoseBoxes::wider(level, group),
            .height = frame.in_space ? 2 * step : 1,
            .step = step};
  }

  [[nodiscard]] int layers_before() const { return height > step ? 1 : 0; }
  [[nodiscard]] std::size_t layers(const CellFrame& frame) const {
    return static_cast<std::size_t>((frame.layers + step - 1) / step + layers_before());
  }
};

/// Makes the bits of all kinds of windows, some layers of cells at a time: all of them, at a byte each, would
/// take more memory than the bits.
class WindowBuilder {
 public:
  WindowBuilder(const Points& map_points, const CellFrame& frame, double epsilon,
                const std::vector<WindowKind>& kinds, int threads)
      : map_points_(map_points), frame_(frame), epsilon_(epsilon), kinds_(kinds), threads_(threads) {
    for (const WindowKind& kind : kinds) {
      bits_.emplace_back(kind.layers(frame));
      highest_ = std::max(highest_, kind.height);
    }
  }

  [[nodiscard]] std::vector<WindowBits> built() {
    for (int layer = 0; layer < frame_.layers; layer += highest_) {
      take_in_cells(layer);
      build(layer);
    }
    std::vector<WindowBits> result;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
      std::vector<LayerBits> layers;
      for (std::optional<LayerBits>& bits : bits_[k]) layers.push_back(std::move(*bits));
      bits_[k] = {};
      result.emplace_back(std::move(layers), kinds_[k].layers_before(), frame_.in_space);
    }
    return result;
  }

 private:
  /// A layer of windows that is to be made.
  struct Task {
    std::size_t kind;
    std::size_t number;
    int first;  ///< Of its layers of cells.
  };
  /// The layers from one on that windows which begin in the next `highest_` layers have a part in.
  void take_in_cells(int layer) {
    const auto known =
        static_cast<std::size_t>(std::max(0, first_ + static_cast<int>(cells_.size()) - layer));
    cells_.erase(cells_.begin(), cells_.end() - static_cast<std::ptrdiff_t>(known));
    first_ = layer;
    cells_.resize(static_cast<std::size_t>(std::min(2 * highest_, frame_.layers - layer)));
    parallel_for(threads_, cells_.size() - known, [&](std::size_t i) {
      cells_[known + i] =
          layer_near(map_points_, frame_, epsilon_, true, layer + static_cast<int>(known + i));
    });
  }

  void build(int layer) {
    std::vector<Task> tasks;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
      for (std::size_t i = 0; i < bits_[k].size(); ++i) {
        const int first = (static_cast<int>(i) - kinds_[k].layers_before()) * kinds_[k].step;
        const bool is_of_first = layer == 0 && first < 0;
        if (is_of_first || (first >= layer && first < layer + highest_)) tasks.push_back({k, i, first});
      }
    }
    parallel_for(threads_, tasks.size(), [&](std::size_t i) {
      const Task& task = tasks[i];
      const WindowKind& kind = kinds_[task.kind];
      std::optional<LayerBits>& bits = bits_[task.kind][task.number];
      if (kind.of_middles) {
        bits.emplace(kind.level, layer_near(map_points_, frame_, epsilon_, false, task.first));
      } else {
        const Windows cells = joined(task.first, task.first + kind.height);
        bits.emplace(kind.level, widened(cells, kind.wider, 1 << kind.level));
      }
    });
  }

  /// Which cells are anywhere in contact in one of these layers.
  [[nodiscard]] Windows joined(int begin, int end) const {
    Windows all{.width = static_cast<std::size_t>(frame_.columns),
                .height = static_cast<std::size_t>(frame_.rows),
                .in_space = frame_.in_space};
    for (int layer = std::max(0, begin); layer < std::min(end, frame_.layers); ++layer) {
      const std::uint8_t* more = cells_[static_cast<std::size_t>(layer - first_)].bytes.data();
      std::uint8_t* bytes = all.bytes.data();
      const std::size_t size = all.bytes.size();
      for (std::size_t i = 0; i < size; ++i) bytes[i] |= more[i];
    }
    return all;
  }

  const Points& map_points_;
  const CellFrame& frame_;
  double epsilon_;
  const std::vector<WindowKind>& kinds_;
  int threads_;
  int highest_ = 1;             ///< Of the windows of all kinds, in layers of cells.
  int first_ = 0;               ///< Of the layers of cells at hand.
  std::vector<Windows> cells_;  ///< Each one layer.
  std::vector<std::vector<std::optional<LayerBits>>> bits_;  ///< Of each kind.
};

}  // namespace

PoseBoxes::PoseBoxes(const Points& points, const CellFrame& frame, int top_level)
    : frame_(frame), top_level_(top_level), middle_x_(middle_of(points.x)), middle_y_(middle_of(points.y)) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double x = points.x[i] - middle_x_;
    const double y = points.y[i] - middle_y_;
    const double layer = frame.in_space ? points.z[i] / frame.cell : 0.0;
    points_.push_back({.x = x, .y = y, .distance = std::hypot(x, y), .layer = layer});
  }
  std::stable_sort(points_.begin(), points_.end(),
                   [](const Turning& a, const Turning& b) { return a.distance < b.distance; });
  constexpr double smallest_radius = 0.5;
  radius_ = std::max(points_.back().distance, smallest_radius);
  const double widest = std::ldexp(frame.cell / radius_, top_level);
  top_rotations_ = static_cast<std::size_t>(std::ceil(2.0 * std::numbers::pi / widest));
  find_clusters(std::ldexp(frame.cell, top_level) / 2.0);
  put_rare_first(points_);
  put_rare_first(clusters_);
}

std::int32_t PoseBoxes::box_of_layers(int level, const Turning& one) const {
  return static_cast<std::int32_t>(std::floor(one.layer / layers_of_box(level, frame_)));
}

/// Those in boxes of layers with few of them before the others: a floor is in contact nearly everywhere, so
/// what tells places apart is to be looked at first.
void PoseBoxes::put_rare_first(std::vector<Turning>& all) const {
  std::map<std::int32_t, std::size_t> in_box;
  for (const Turning& one : all) ++in_box[box_of_layers(top_level_, one)];
  const auto neighbours = [&](const Turning& one) { return in_box[box_of_layers(top_level_, one)]; };
  std::stable_sort(all.begin(), all.end(),
                   [&](const Turning& a, const Turning& b) { return neighbours(a) < neighbours(b); });
}

/// Each point that is in none yet makes one with its nearest neighbours that are in none either, if they lie
/// in a disc of the widest radius and in one box of layers.
void PoseBoxes::find_clusters(double widest) {
  std::vector<float> xs, ys;
  for (const Turning& point : points_) {
    xs.push_back(static_cast<float>(point.x));
    ys.push_back(static_cast<float>(point.y));
  }
  const Squares squares(xs, ys, 2.0 * widest);
  const auto box_of = [&](const Turning& point) { return box_of_layers(top_level_, point); };
  std::vector<bool> is_taken(points_.size(), false);
  std::vector<std::pair<double, std::uint32_t>> near;
  for (std::uint32_t i = 0; i < points_.size(); ++i) {
    if (is_taken[i]) continue;
    near.clear();
    squares.near(xs[i], ys[i], [&](std::uint32_t k) {
      const double distance = std::hypot(points_[k].x - points_[i].x, points_[k].y - points_[i].y);
      if (!is_taken[k] && distance <= 2.0 * widest && box_of(points_[k]) == box_of(points_[i]))
        near.emplace_back(distance, k);
    });
    if (near.size() < cluster_size) continue;
    const auto end = near.begin() + cluster_size;
    std::partial_sort(near.begin(), end, near.end());
    const auto middle_of_members = [&](auto coordinate) {
      double low = coordinate(points_[i]), high = low;
      for (auto member = near.begin(); member != end; ++member) {
        low = std::min(low, coordinate(points_[member->second]));
        high = std::max(high, coordinate(points_[member->second]));
      }
      return (low + high) / 2.0;
    };
    const double x = middle_of_members([](const Turning& point) { return point.x; });
    const double y = middle_of_members([](const Turning& point) { return point.y; });
    double radius = 0.0;
    for (auto member = near.begin(); member != end; ++member) {
      const Turning& point = points_[member->second];
      radius = std::max(radius, std::hypot(point.x - x, point.y - y));
    }
    if (radius > widest) continue;
    for (auto member = near.begin(); member != end; ++member) is_taken[member->second] = true;
    clusters_.push_back(
        {.x = x, .y = y, .distance = std::hypot(x, y), .radius = radius, .layer = points_[i].layer});
  }
}

double PoseBoxes::angle(int level, std::size_t rotation) const {
  return 2.0 * half_width(level) * (static_cast<double>(rotation) + 0.5);
}

double PoseBoxes::half_width(int level) const {
  return std::numbers::pi / static_cast<double>(rotations(level));
}

double PoseBoxes::sway(int level, double local_x, double local_y) const {
  return std::hypot(local_x - middle_x_, local_y - middle_y_) * half_width(level);
}

Pose2 PoseBoxes::pose(int level, std::size_t rotation, double column, double row) const {
  const Pose2 moved{frame_.min_x + frame_.cell * column, frame_.min_y + frame_.cell * row,
                    angle(level, rotation)};
  return moved * Pose2{-middle_x_, -middle_y_, 0.0};
}

std::vector<CellPoints> PoseBoxes::cells(int level, std::size_t rotation) const {
  return cells_of(points_, groups(level), level, rotation);
}

std::vector<CellPoints> PoseBoxes::cluster_cells(std::size_t rotation) const {
  return cells_of(clusters_, cluster_groups(top_level_), top_level_, rotation);
}

std::vector<CellPoints> PoseBoxes::cells_of(const std::vector<Turning>& all, int groups, int level,
                                            std::size_t rotation) const {
  const double c = std::cos(angle(level, rotation));
  const double s = std::sin(angle(level, rotation));
  // Rounding must not leave a point a hair beside its window.
  constexpr double hair = 1e-6;
  std::vector<CellPoints> cells(static_cast<std::size_t>(groups));
  const double parts = PoseBoxes::groups(level);
  const double box = std::ldexp(frame_.cell, level);
  for (const Turning& one : all) {
    const double share = one.distance / radius_ + 2.0 * one.radius / box;
    const int group = std::clamp(static_cast<int>(std::ceil(parts * share - hair)), 1, groups);
    const double moved = (one.distance * half_width(level) + one.radius) / frame_.cell + hair;
    const int wider = PoseBoxes::wider(level, group);
    const auto cell_of = [&](double coordinate) {
      return static_cast<std::int32_t>(std::floor(coordinate / frame_.cell - moved)) + wider;
    };
    cells[static_cast<std::size_t>(group - 1)].push_back(
        cell_of(c * one.x - s * one.y), cell_of(s * one.x + c * one.y), box_of_layers(level, one));
  }
  return cells;
}

CellPoints PoseBoxes::middle_cells(std::size_t rotation) const {
  const double c = std::cos(angle(0, rotation));
  const double s = std::sin(angle(0, rotation));
  const auto cell_of = [&](double coordinate) {
    return static_cast<std::int32_t>(std::floor(coordinate / frame_.cell + 0.5));
  };
  CellPoints cells;
  for (const Turning& point : points_)
    cells.push_back(cell_of(c * point.x - s * point.y), cell_of(s * point.x + c * point.y),
                    static_cast<std::int32_t>(std::floor(point.layer + 0.5)));
  return cells;
}

BoxPyramid::BoxPyramid(const Points& map_points, double cell, double epsilon, int top_level, int threads,
                       Motion motion)
    : frame_(cell_frame(map_points, cell, epsilon + cell, motion)) {
  std::vector<WindowKind> kinds = {WindowKind{}};
  for (int level = 0; level <= top_level; ++level) {
    const int groups = level == top_level ? PoseBoxes::cluster_groups(level) : PoseBoxes::groups(level);
    for (int group = 1; group <= groups; ++group) kinds.push_back(WindowKind::of_group(level, group, frame_));
  }
  levels_.resize(static_cast<std::size_t>(top_level) + 1);
  std::vector<WindowBits> bits = WindowBuilder(map_points, frame_, epsilon, kinds, threads).built();
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const auto level = static_cast<std::size_t>(kinds[k].level);
    (kinds[k].of_middles ? middles_ : levels_[level]).push_back(std::move(bits[k]));
  }
}

/// At the middle of a box a point lies in the middle one of three cells along either axis, or half a cell
/// beside it; and half a cell from the middle of two layers at most.
double BoxPyramid::delta() const {
  constexpr double aside = 2.0;
  constexpr double above = 1.5;
  return frame_.cell * std::hypot(aside, aside, frame_.in_space ? above : 0.0);
}

BoxPyramid::BoxesOfLayers BoxPyramid::boxes_of_layers(int level) const {
  const WindowBits& bits = levels_[static_cast<std::size_t>(level)].front();
  return {-bits.layers_before(), bits.layers() - bits.layers_before() - 1};
}

std::size_t BoxPyramid::memory_bytes() const {
  std::size_t bytes = middles_.front().memory_bytes();
  for (const std::vector<WindowBits>& groups : levels_) {
    for (const WindowBits& bits : groups) bytes += bits.memory_bytes();
  }
  return bytes;
}

std::size_t BoxPyramid::count(int level, const std::vector<CellPoints>& points, int column, int row,
                              int layer, std::size_t least, TileCounts& counts) const {
  std::size_t behind = 0;
  for (const CellPoints& group : points) behind += group.size();
  std::size_t looked_at = 0;
  counts.clear();
  for (std::size_t group = points.size(); group-- > 0 && counts.largest() + behind >= least;) {
    behind -= points[group].size();
    looked_at += levels_[static_cast<std::size_t>(level)][group].add(points[group], column, row, layer, least,
                                                                     behind, counts);
  }
  return looked_at;
}

void BoxPyramid::count_middles(const CellPoints& points, int column, int row, int layer,
                               TileCounts& counts) const {
  counts.clear();
  middles_.front().add(points, column, row, layer, 0, 0, counts);
}

std::shared_ptr<const BoxPyramid> box_pyramid(const GlobalMap& map, double cell, double epsilon,
                                              Motion motion, int threads) {
  check_cell(cell, epsilon);
  const bool in_space = motion != Motion::planar;
  constexpr double top_box = 0.4;  // m; larger ones bound nothing indoors
  const int top_level = in_space ? BoxPyramid::default_top_level
                                 : std::max(0, static_cast<int>(std::lround(std::log2(top_box / cell))));
  return map.index<BoxPyramid>(fmt::format("{} {}{}", cell, epsilon, in_space ? " in space" : ""), [&] {
    return BoxPyramid(map.points(), cell, epsilon, top_level, threads, motion);
  });
}

}  // namespace glocal
