#include "matchers/box_search/windows_of_map.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
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

/// Which cells count as in contact, and in which layer.
struct ContactRule {
  double epsilon;  ///< m; within so much of a point of the map are their centres, or …
  bool anywhere;   ///< … the nearest of their places.
  int layer;
};

/// Marks those of the rows from `begin` on and before `end`.
void mark_contact(const Points& map_points, const CellFrame& frame, const ContactRule& rule, int begin,
                  int end, LayerCells& cells) {
  const double half_cell = rule.anywhere ? 0.5 : 0.0;
  const double reach = rule.epsilon / frame.cell;
  const auto first = [&](double centre) { return static_cast<int>(std::ceil(centre - reach - half_cell)); };
  const auto last = [&](double centre) { return static_cast<int>(std::floor(centre + reach + half_cell)); };
  const auto square = [&](double distance) {
    const double beyond = std::max(0.0, std::abs(distance) - half_cell);
    return beyond * beyond;
  };
  const double farthest = reach + half_cell;
  const double low = frame.min_y + frame.cell * (begin - farthest - 1.0);
  const double high = frame.min_y + frame.cell * (end + farthest + 1.0);
  std::vector<double> by_column;
  for (std::size_t i = 0; i < map_points.size(); ++i) {
    if (map_points.y[i] < low || map_points.y[i] > high) continue;
    // In cells, relative to the centre of cell (0, 0, 0).
    const double x = (map_points.x[i] - frame.min_x) / frame.cell - 0.5;
    const double y = (map_points.y[i] - frame.min_y) / frame.cell - 0.5;
    const double z = frame.in_space ? (map_points.z[i] - frame.min_z) / frame.cell - 0.5 : 0.0;
    if (rule.layer < z - reach - half_cell || rule.layer > z + reach + half_cell) continue;
    const double by_layer = square(rule.layer - z);
    const int first_column = std::max(0, first(x));
    by_column.clear();
    for (int column = first_column; column <= std::min(frame.columns - 1, last(x)); ++column)
      by_column.push_back(square(column - x));
    for (int row = std::max(begin, first(y)); row <= std::min(end - 1, last(y)); ++row) {
      const double by_row = square(row - y);
      for (std::size_t k = 0; k < by_column.size(); ++k) {
        if (by_column[k] + by_row + by_layer <= reach * reach)
          cells.set(first_column + static_cast<int>(k), row);
      }
    }
  }
}

/// The cells of a layer that are in contact.
LayerCells cells_in_contact(const Points& map_points, const CellFrame& frame, const ContactRule& rule,
                            int threads) {
  const std::size_t words = static_cast<std::size_t>(frame.columns) / LayerCells::word_bits + 1;
  LayerCells cells{.words = words,
                   .bits = std::vector<std::uint64_t>(words * static_cast<std::size_t>(frame.rows)),
                   .first_row = frame.rows};
  // Each band looks at all points, but no two at the same rows.
  for_bands(threads, frame.rows, 1,
            [&](int begin, int end) { mark_contact(map_points, frame, rule, begin, end, cells); });
  for (int row = 0; row < frame.rows; ++row) {
    const auto of_row = std::span(cells.bits).subspan(static_cast<std::size_t>(row) * words, words);
    if (std::ranges::all_of(of_row, [](std::uint64_t w) { return w == 0; })) continue;
    cells.first_row = std::min(cells.first_row, row);
    cells.end_row = row + 1;
  }
  return cells;
}

/// Joins each bit of a row with the n - 1 before it.
void widen(std::vector<std::uint64_t>& row, int n) {
  constexpr std::size_t word_bits = LayerCells::word_bits;
  for (int joined = 1, more = 0; joined < n; joined += more) {
    more = std::min(joined, n - joined);
    const std::size_t words = static_cast<std::size_t>(more) / word_bits;
    const std::size_t bits = static_cast<std::size_t>(more) % word_bits;
    for (std::size_t w = row.size(); w-- > words;) {
      std::uint64_t moved = row[w - words] << bits;
      if (bits > 0 && w > words) moved |= row[w - words - 1] >> (word_bits - bits);
      row[w] |= moved;
    }
  }
}

/// The bits of one layer of windows, over layers of cells that are at hand: row after row, as all of them at
/// once would take more memory than the bits that are made of them.
class WindowRows {
 public:
  WindowRows(std::span<const LayerCells> layers, const CellFrame& frame, const WindowKind& kind)
      : layers_(layers),
        behind_(kind.wider),
        ahead_(1 << kind.level),
        columns_before_(static_cast<std::size_t>(LayerBits::columns_before(kind.level))),
        last_(static_cast<std::size_t>(behind_ + ahead_)),
        bits_(kind.level, frame.columns + behind_, frame.rows + behind_) {
    const std::size_t windows = columns_before_ + static_cast<std::size_t>(frame.columns + behind_);
    for (std::vector<std::uint64_t>& row : last_) row.resize(windows / LayerCells::word_bits + 1);
    // In space most blocks of most layers are empty.
    if (!frame.in_space) bits_.reserve();
  }

  [[nodiscard]] LayerBits bits() {
    int begin = layers_.front().first_row;
    int end = layers_.front().end_row;
    for (const LayerCells& layer : layers_) {
      begin = std::min(begin, layer.first_row);
      end = std::max(end, layer.end_row);
    }
    std::vector<std::uint64_t> windows(last_.front().size());
    for (int row = begin; row < end + behind_ + ahead_ - 1; ++row) {
      take_in(row, row < end);
      std::ranges::fill(windows, 0);
      for (const std::vector<std::uint64_t>& last : last_) {
        for (std::size_t w = 0; w < windows.size(); ++w) windows[w] |= last[w];
      }
      bits_.add_row(row + 1 - ahead_, windows);
    }
    return std::move(bits_);
  }

 private:
  /// A row of cells: the columns of windows that meet one in contact, in place of the oldest row.
  void take_in(int row, bool is_any) {
    std::vector<std::uint64_t>& columns = last_[static_cast<std::size_t>(row) % last_.size()];
    std::ranges::fill(columns, 0);
    if (!is_any) return;
    // A window begins so many columns before the first that it can meet.
    const std::size_t first = columns_before_ + 1 - static_cast<std::size_t>(ahead_);
    const std::size_t bits = first % LayerCells::word_bits;
    std::uint64_t any = 0;
    for (std::size_t number = 0; number < layers_.front().words; ++number) {
      std::uint64_t word = 0;
      for (const LayerCells& layer : layers_) word |= layer.word(row, number);
      if (word == 0) continue;
      any = word;
      const std::size_t w = first / LayerCells::word_bits + number;
      columns[w] |= word << bits;
      if (const std::uint64_t rest = bits > 0 ? word >> (LayerCells::word_bits - bits) : 0; rest != 0)
        columns[w + 1] |= rest;
    }
    if (any != 0) widen(columns, behind_ + ahead_);
  }

  std::span<const LayerCells> layers_;
  int behind_, ahead_;  ///< Cells of a window before the one that names it, and from that on.
  std::size_t columns_before_;
  /// Of the last rows of cells, as many as a window has, the columns of windows that meet one in contact.
  std::vector<std::vector<std::uint64_t>> last_;
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
    // In the plane, where there is one layer, it is divided.
    const int threads_each = frame_.in_space ? 1 : threads_;
    parallel_for(threads_, cells_.size() - known, [&](std::size_t i) {
      const ContactRule rule{epsilon_, anywhere_, layer + static_cast<int>(known + i)};
      cells_[known + i] = cells_in_contact(map_points_, frame_, rule, threads_each);
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
