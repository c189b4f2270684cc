#include "matchers/box_search/windows_of_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "glocal/parallel.hpp"

namespace glocal {
namespace {

/// The cells of one layer of a frame that are within `epsilon` (m) of a point of the map: by their centres,
/// or, with `anywhere`, by the nearest of their places. Each is a window of one cell.
Windows cells_in_contact(const Points& map_points, const CellFrame& frame, double epsilon, bool anywhere,
                         int layer) {
  Windows cells{.width = static_cast<std::size_t>(frame.columns),
                .height = static_cast<std::size_t>(frame.rows)};
  const double half_cell = anywhere ? 0.5 : 0.0;
  const double reach = epsilon / frame.cell;
  const auto first = [&](double centre) {
    return std::max(0, static_cast<int>(std::ceil(centre - reach - half_cell)));
  };
  const auto square = [&](double distance) {
    const double beyond = std::max(0.0, std::abs(distance) - half_cell);
    return beyond * beyond;
  };
  for (std::size_t i = 0; i < map_points.size(); ++i) {
    // In cells, relative to the centre of cell (0, 0, 0).
    const double x = (map_points.x[i] - frame.min_x) / frame.cell - 0.5;
    const double y = (map_points.y[i] - frame.min_y) / frame.cell - 0.5;
    const double z = frame.in_space ? (map_points.z[i] - frame.min_z) / frame.cell - 0.5 : 0.0;
    if (layer < z - reach - half_cell || layer > z + reach + half_cell) continue;
    for (int row = first(y); row < frame.rows && row <= y + reach + half_cell; ++row) {
      for (int column = first(x); column < frame.columns && column <= x + reach + half_cell; ++column) {
        if (square(column - x) + square(row - y) + square(layer - z) <= reach * reach)
          *cells.at(column, row) = 1;
      }
    }
  }
  return cells;
}

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
  Windows lines{.before = before,
                .width = static_cast<std::size_t>(columns + behind + before),
                .height = static_cast<std::size_t>(rows + before)};
  int first_row = rows;
  int end_row = 0;
  for (int row = 0; row < rows; ++row) {
    const std::uint8_t* cell = cells.at(0, row);
    if (next_set(cell, cell + columns) == cell + columns) continue;
    first_row = std::min(first_row, row);
    end_row = row + 1;
    std::uint8_t* window = lines.at(0, row);
    int last = never;
    slide(
        0, columns, behind, ahead,
        [&](int column) {
          if (cell[column] != 0) last = column;
        },
        [&](int column) { window[column] = last >= column - behind ? 1 : 0; });
  }
  Windows windows{
      .before = before, .width = lines.width, .height = static_cast<std::size_t>(rows + behind + before)};
  const std::size_t width = lines.width;
  std::vector<int> last_of_columns(width, never);
  int* last = last_of_columns.data();
  slide(
      first_row, end_row, behind, ahead,
      [&](int row) {
        const std::uint8_t* line = lines.at(-before, row);
        for (std::size_t i = 0; i < width; ++i) last[i] = line[i] != 0 ? row : last[i];
      },
      [&](int row) {
        std::uint8_t* line = windows.at(-before, row);
        const int first = row - behind;
        for (std::size_t i = 0; i < width; ++i) line[i] = last[i] >= first ? 1 : 0;
      });
  return windows;
}

/// Makes the bits some layers of cells at a time: all of them, at a byte each, would take more memory than
/// the bits.
class WindowBuilder {
 public:
  WindowBuilder(const Points& map_points, const CellFrame& frame, double epsilon, bool anywhere,
                const std::vector<WindowKind>& kinds, int threads)
      : map_points_(map_points),
        frame_(frame),
        epsilon_(epsilon),
        anywhere_(anywhere),
        kinds_(kinds),
        threads_(threads) {
    for (const WindowKind& kind : kinds) {
      bits_.emplace_back(kind.layers(frame));
      highest_ = std::max(highest_, kind.height);
    }
  }

  [[nodiscard]] std::vector<WindowBits> built() {
    const int at_a_time = std::max(8, highest_);
    for (int layer = 0; layer < frame_.layers; layer += at_a_time) {
      take_in_cells(layer, at_a_time + highest_ - 1);
      build(layer, layer + at_a_time);
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

  /// So many layers of cells from one on, some of which may be at hand.
  void take_in_cells(int layer, int layers) {
    const auto known =
        static_cast<std::size_t>(std::max(0, first_ + static_cast<int>(cells_.size()) - layer));
    cells_.erase(cells_.begin(), cells_.end() - static_cast<std::ptrdiff_t>(known));
    first_ = layer;
    cells_.resize(static_cast<std::size_t>(std::min(layers, frame_.layers - layer)));
    parallel_for(threads_, cells_.size() - known, [&](std::size_t i) {
      cells_[known + i] =
          cells_in_contact(map_points_, frame_, epsilon_, anywhere_, layer + static_cast<int>(known + i));
    });
  }

  /// The layers of windows that begin in these layers of cells, or, with the first of them, below.
  void build(int begin, int end) {
    std::vector<Task> tasks;
    for (std::size_t k = 0; k < kinds_.size(); ++k) {
      for (std::size_t i = 0; i < bits_[k].size(); ++i) {
        const int first = (static_cast<int>(i) - kinds_[k].layers_before()) * kinds_[k].step;
        if (std::max(0, first) >= begin && first < end) tasks.push_back({k, i, first});
      }
    }
    parallel_for(threads_, tasks.size(), [&](std::size_t i) {
      const Task& task = tasks[i];
      const WindowKind& kind = kinds_[task.kind];
      const Windows cells = joined(task.first, task.first + kind.height);
      bits_[task.kind][task.number].emplace(kind.level, widened(cells, kind.wider, 1 << kind.level));
    });
  }

  /// Which cells are in contact in one of these layers.
  [[nodiscard]] Windows joined(int begin, int end) const {
    Windows all{.width = static_cast<std::size_t>(frame_.columns),
                .height = static_cast<std::size_t>(frame_.rows)};
    std::uint8_t* bytes = all.bytes.data();
    const std::size_t size = all.bytes.size();
    for (int layer = std::max(0, begin); layer < std::min(end, frame_.layers); ++layer) {
      const std::uint8_t* more = cells_[static_cast<std::size_t>(layer - first_)].bytes.data();
      for (std::size_t i = 0; i < size; ++i) bytes[i] |= more[i];
    }
    return all;
  }

  const Points& map_points_;
  const CellFrame& frame_;
  double epsilon_;
  bool anywhere_;
  const std::vector<WindowKind>& kinds_;
  int threads_;
  int highest_ = 1;             ///< Of the windows of all kinds, in layers of cells.
  int first_ = 0;               ///< Of the layers of cells at hand.
  std::vector<Windows> cells_;  ///< Each one layer.
  std::vector<std::vector<std::optional<LayerBits>>> bits_;  ///< Of each kind.
};

}  // namespace

std::vector<WindowBits> windows_of_map(const Points& map_points, const CellFrame& frame, double epsilon,
                                       bool anywhere, const std::vector<WindowKind>& kinds, int threads) {
  return WindowBuilder(map_points, frame, epsilon, anywhere, kinds, threads).built();
}

}  // namespace glocal
