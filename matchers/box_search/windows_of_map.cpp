#include "matchers/box_search/windows_of_map.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <utility>

#include "glocal/parallel.hpp"

namespace glocal {
namespace {

/// Which cells of one layer of a frame are in contact: a bit for each, row after row.
struct LayerCells {
  static constexpr std::size_t word_bits = 64;

  std::size_t words;  ///< Of a row.
  std::vector<std::uint64_t> bits;
  /// All rows with such a cell are from the first one on, and before the end.
  int first_row, end_row = 0;

  void set(int column, int row) {
    const auto bit = static_cast<std::size_t>(column);
    bits[static_cast<std::size_t>(row) * words + bit / word_bits] |= std::uint64_t{1} << bit % word_bits;
  }
  [[nodiscard]] std::uint64_t word(int row, std::size_t number) const {
    return bits[static_cast<std::size_t>(row) * words + number];
  }
};

/// Those of a layer that are within `epsilon` (m) of a point of the map: by their centres, or, with
/// `anywhere`, by the nearest of their places.
LayerCells cells_in_contact(const Points& map_points, const CellFrame& frame, double epsilon, bool anywhere,
                            int layer) {
  const std::size_t words = static_cast<std::size_t>(frame.columns) / LayerCells::word_bits + 1;
  LayerCells cells{.words = words,
                   .bits = std::vector<std::uint64_t>(words * static_cast<std::size_t>(frame.rows)),
                   .first_row = frame.rows};
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
      cells.first_row = std::min(cells.first_row, row);
      cells.end_row = std::max(cells.end_row, row + 1);
      for (int column = first(x); column < frame.columns && column <= x + reach + half_cell; ++column) {
        if (square(column - x) + square(row - y) + square(layer - z) <= reach * reach) cells.set(column, row);
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

/// The bits of one layer of windows, over layers of cells that are at hand: row after row, as a byte for each
/// window would take more memory than all bits.
class WindowRows {
 public:
  WindowRows(std::span<const LayerCells> layers, const CellFrame& frame, const WindowKind& kind)
      : layers_(layers),
        columns_(frame.columns),
        rows_(frame.rows),
        behind_(kind.wider),
        ahead_(1 << kind.level),
        cells_(static_cast<std::size_t>(columns_)),
        windows_(static_cast<std::size_t>(columns_ + behind_ + ahead_ - 1)),
        last_rows_(windows_.size(), never),
        bits_(kind.level, columns_ + behind_, rows_ + behind_) {
    // In space most blocks of most layers are empty.
    if (!frame.in_space) bits_.reserve();
  }

  [[nodiscard]] LayerBits bits() {
    int begin = rows_;
    int end = 0;
    for (const LayerCells& layer : layers_) {
      begin = std::min(begin, layer.first_row);
      end = std::max(end, layer.end_row);
    }
    slide(
        begin, end, behind_, ahead_, [&](int row) { enter(row); }, [&](int row) { mark(row); });
    return std::move(bits_);
  }

 private:
  static constexpr int never = std::numeric_limits<int>::min() / 2;

  /// Takes in a row of cells: the columns of windows that meet one in contact.
  void enter(int row) {
    if (!join(row)) return;
    const std::uint8_t* cells = cells_.data();
    std::uint8_t* windows = windows_.data() + ahead_ - 1;
    int last = never;
    slide(
        0, columns_, behind_, ahead_,
        [&](int column) {
          if (cells[column] != 0) last = column;
        },
        [&](int column) { windows[column] = last >= column - behind_ ? 1 : 0; });
    int* last_rows = last_rows_.data();
    const std::uint8_t* first = windows_.data();
    const std::size_t width = windows_.size();
    for (std::size_t i = 0; i < width; ++i) last_rows[i] = first[i] != 0 ? row : last_rows[i];
  }

  /// Which cells of a row are in contact in one of the layers. Returns whether one is.
  bool join(int row) {
    std::fill(cells_.begin(), cells_.end(), std::uint8_t{0});
    bool any = false;
    for (std::size_t number = 0; number < layers_.front().words; ++number) {
      std::uint64_t word = 0;
      for (const LayerCells& layer : layers_) word |= layer.word(row, number);
      any = any || word != 0;
      for (; word != 0; word &= word - 1)
        cells_[number * LayerCells::word_bits + static_cast<std::size_t>(std::countr_zero(word))] = 1;
    }
    return any;
  }

  /// The windows of a row, all of whose cells have been taken in.
  void mark(int row) {
    const int first = row - behind_;
    const int* last_rows = last_rows_.data();
    std::uint8_t* windows = windows_.data();
    const std::size_t width = windows_.size();
    for (std::size_t i = 0; i < width; ++i) windows[i] = last_rows[i] >= first ? 1 : 0;
    bits_.add_row(row, 1 - ahead_, windows_);
  }

  std::span<const LayerCells> layers_;
  int columns_, rows_;
  int behind_, ahead_;                 ///< Cells of a window before the one that names it, and from that on.
  std::vector<std::uint8_t> cells_;    ///< Of a row, a byte for each.
  std::vector<std::uint8_t> windows_;  ///< Of a row; the first of column 1 - `ahead_`.
  std::vector<int> last_rows_;         ///< For each of these columns the last row that it met.
  LayerBits bits_;
};

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
      const int first = std::max(0, task.first);
      const int layers = std::min(task.first + kind.height, frame_.layers) - first;
      const auto cells = std::span<const LayerCells>(cells_).subspan(static_cast<std::size_t>(first - first_),
                                                                     static_cast<std::size_t>(layers));
      bits_[task.kind][task.number] = WindowRows(cells, frame_, kind).bits();
    });
  }

  const Points& map_points_;
  const CellFrame& frame_;
  double epsilon_;
  bool anywhere_;
  const std::vector<WindowKind>& kinds_;
  int threads_;
  int highest_ = 1;  ///< Of the windows of all kinds, in layers of cells.
  int first_ = 0;    ///< Of the layers of cells at hand.
  std::vector<LayerCells> cells_;
  std::vector<std::vector<std::optional<LayerBits>>> bits_;  ///< Of each kind.
};

}  // namespace

std::vector<WindowBits> windows_of_map(const Points& map_points, const CellFrame& frame, double epsilon,
                                       bool anywhere, const std::vector<WindowKind>& kinds, int threads) {
  return WindowBuilder(map_points, frame, epsilon, anywhere, kinds, threads).built();
}

}  // namespace glocal
