#include "matchers/grid_search/contact_pyramid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "glocal/error.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/grid_search/contact_pyramid.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace glocal::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Words = hn::CappedTag<std::uint64_t, TileCounts::rows>;
using V = hn::Vec<Words>;

/// Full adder in each bit: sum + a + b = 2 * carry + sum.
HWY_INLINE V add(V& sum, V a, V b) {
  const V either = hn::Xor(sum, a);
  const V carry = hn::Or(hn::And(sum, a), hn::And(either, b));
  sum = hn::Xor(either, b);
  return carry;
}

/// Adds the bits that eight points find to the counts of some rows of a tile (Harley and Seal's counter).
template <class Bits>
HWY_INLINE void add_eight(const Bits& bits, std::uint64_t* planes, std::size_t planes_size) {
  const Words d;
  constexpr std::size_t stride = TileCounts::rows;
  V ones = hn::LoadU(d, planes);
  V twos = hn::LoadU(d, planes + stride);
  V fours = hn::LoadU(d, planes + 2 * stride);
  V a = add(ones, bits(0), bits(1));
  V b = add(ones, bits(2), bits(3));
  const V c = add(twos, a, b);
  a = add(ones, bits(4), bits(5));
  b = add(ones, bits(6), bits(7));
  V carry = add(fours, c, add(twos, a, b));
  hn::StoreU(ones, d, planes);
  hn::StoreU(twos, d, planes + stride);
  hn::StoreU(fours, d, planes + 2 * stride);
  for (std::size_t k = 3; k < planes_size; ++k) {
    const V plane = hn::LoadU(d, planes + k * stride);
    hn::StoreU(hn::Xor(plane, carry), d, planes + k * stride);
    carry = hn::And(plane, carry);
  }
}

/// Adds the bits found by looks [begin, begin + n), n a multiple of eight.
void add_looks_in_vectors(const std::uint64_t* level, std::size_t rows, const TileLooks& looks,
                          std::size_t begin, std::size_t n, std::uint64_t* planes, std::size_t planes_size) {
  const Words d;
  for (std::size_t row = 0; row < TileCounts::rows; row += hn::Lanes(d)) {
    for (std::size_t i = begin; i < begin + n; i += 8) {
      const auto bits = [&](std::size_t k) HWY_ATTR {
        const std::uint64_t* words = level + looks.words[i + k] + row;
        const int shift = static_cast<int>(looks.shifts[i + k]);
        const V low = hn::ShiftRightSame(hn::LoadU(d, words), shift);
        const V high = hn::ShiftLeftSame(hn::ShiftLeft<1>(hn::LoadU(d, words + rows)), 63 - shift);
        return hn::Or(low, high);
      };
      add_eight(bits, planes + row, planes_size);
    }
  }
}

/// The looks of those of n points that meet a tile; n is a multiple of every vector's length. Writes whole
/// vectors. Returns how many they are.
std::size_t find_looks_in_vectors(const TileLayout& tile, const std::int32_t* columns,
                                  const std::int32_t* rows, std::size_t n, TileLooks& looks) {
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::Rebind<std::uint32_t, decltype(d)> words;
  const auto low_bits = hn::Set(d, (1 << tile.level) - 1);
  const auto within = [&](auto value, std::int32_t last) HWY_ATTR {
    return hn::And(hn::Gt(value, hn::Set(d, -1)), hn::Lt(value, hn::Set(d, last + 1)));
  };
  std::size_t size = 0;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const auto x = hn::Add(hn::LoadU(d, columns + i), hn::Set(d, tile.column));
    const auto y = hn::Add(hn::LoadU(d, rows + i), hn::Set(d, tile.row));
    const auto first = hn::Add(hn::ShiftRightSame(x, tile.level), hn::Set(d, TileCounts::columns));
    const auto line = hn::Add(hn::ShiftRightSame(y, tile.level), hn::Set(d, TileCounts::rows));
    const auto phase = hn::Or(hn::ShiftLeftSame(hn::And(y, low_bits), tile.level), hn::And(x, low_bits));
    const auto column = hn::Add(hn::Mul(phase, hn::Set(d, tile.words)), hn::ShiftRight<6>(first));
    const auto word = hn::Add(hn::Mul(column, hn::Set(d, tile.rows)), line);
    const auto meets = hn::And(within(first, tile.last_column), within(line, tile.last_row));
    hn::CompressStore(hn::BitCast(words, hn::And(first, hn::Set(d, 63))), hn::RebindMask(words, meets), words,
                      looks.shifts.data() + size);
    size += hn::CompressStore(hn::BitCast(words, word), hn::RebindMask(words, meets), words,
                              looks.words.data() + size);
  }
  return size;
}

}  // namespace
}  // namespace glocal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glocal {

HWY_EXPORT(add_looks_in_vectors);
HWY_EXPORT(find_looks_in_vectors);

namespace {

constexpr int word_bits = 64;
/// Points and looks come in multiples of this: a vector of the widest instruction set.
constexpr std::size_t lanes = 16;

int low_bits(int value, int n) {
  return value & ((1 << n) - 1);
}

}  // namespace

void CellPoints::push_back(std::int32_t column, std::int32_t row) {
  constexpr std::int32_t far_away = -(1 << 29);
  if (size_ == columns_.size()) {
    columns_.resize(size_ + lanes, far_away);
    rows_.resize(size_ + lanes, far_away);
  }
  columns_[size_] = column;
  rows_[size_] = row;
  ++size_;
}

std::size_t TileCounts::at(int column, int row) const {
  std::size_t count = 0;
  for (std::size_t k = 0; k < planes_.size(); ++k) {
    count |= (planes_[k][static_cast<std::size_t>(row)] >> column & 1U) << k;
  }
  return count;
}

void TileCounts::find_largest() {
  Mask nodes;
  nodes.fill(~std::uint64_t{0});
  largest_ = 0;
  for (std::size_t k = planes_.size(); k-- > 0;) {
    Mask with_bit;
    std::uint64_t any = 0;
    for (std::size_t row = 0; row < rows; ++row) any |= with_bit[row] = nodes[row] & planes_[k][row];
    if (any == 0) continue;
    nodes = with_bit;
    largest_ |= std::size_t{1} << k;
  }
}

TileCounts::Mask TileCounts::at_least(std::size_t count) const {
  Mask nodes;
  nodes.fill(count >> planes_.size() == 0 ? ~std::uint64_t{0} : 0);
  // From the lowest bit on: whether the bits so far are at least those of `count`.
  for (std::size_t k = 0; k < planes_.size(); ++k) {
    const bool needed = (count >> k & 1U) != 0;
    for (std::size_t row = 0; row < rows; ++row) {
      nodes[row] = needed ? nodes[row] & planes_[k][row] : nodes[row] | planes_[k][row];
    }
  }
  return nodes;
}

void check_cell(double cell, double epsilon) {
  if (cell <= epsilon) return;
  throw ConfigError(
      {{"", 0, 0,
        fmt::format("the cell of {} m of an exact search is larger than contact_epsilon, which is "
                    "{:.3g} m on this map; take a smaller cell or a larger contact_epsilon",
                    cell, epsilon)}});
}

CellFrame cell_frame(const Points& map_points, double cell, double epsilon) {
  const auto [low_x, high_x] = std::minmax_element(map_points.x.begin(), map_points.x.end());
  const auto [low_y, high_y] = std::minmax_element(map_points.y.begin(), map_points.y.end());
  CellFrame frame{.cell = cell, .min_x = *low_x - epsilon, .min_y = *low_y - epsilon};
  const double columns = std::floor((*high_x + epsilon - frame.min_x) / cell) + 1.0;
  const double rows = std::floor((*high_y + epsilon - frame.min_y) / cell) + 1.0;
  constexpr double largest = 1024.0 * 1024.0 * 1024.0;
  if (!(columns * rows <= largest)) {
    throw ConfigError({{"", 0, 0,
                        fmt::format("the map is too large for a grid of cells of {} m: it would need more "
                                    "than 1 GiB; cut the map, or take a larger cell",
                                    cell)}});
  }
  frame.columns = static_cast<int>(columns);
  frame.rows = static_cast<int>(rows);
  return frame;
}

ContactPyramid::ContactPyramid(const Points& map_points, double cell, double epsilon, int top_level)
    : frame_(cell_frame(map_points, cell, epsilon)) {
  // Windows may begin before the first cell.
  const int border = (1 << top_level) - 1;
  const auto width = static_cast<std::size_t>(frame_.columns) + static_cast<std::size_t>(border);
  const auto height = static_cast<std::size_t>(frame_.rows) + static_cast<std::size_t>(border);
  std::vector<std::uint8_t> windows(width * height, 0);
  const auto window = [&](int column, int row) -> std::uint8_t& {
    return windows[static_cast<std::size_t>(row + border) * width +
                   static_cast<std::size_t>(column + border)];
  };
  for (std::size_t i = 0; i < map_points.size(); ++i) {
    // In cells, relative to the centre of cell (0, 0).
    const double x = (map_points.x[i] - frame_.min_x) / cell - 0.5;
    const double y = (map_points.y[i] - frame_.min_y) / cell - 0.5;
    const double reach = epsilon / cell;
    const auto first = [&](double centre) {
      return std::max(0, static_cast<int>(std::ceil(centre - reach)));
    };
    for (int r = first(y); r < frame_.rows && r <= y + reach; ++r) {
      for (int c = first(x); c < frame_.columns && c <= x + reach; ++c) {
        if ((c - x) * (c - x) + (r - y) * (r - y) <= reach * reach) window(c, r) = 1;
      }
    }
  }
  for (int level = 0; level <= top_level; ++level) {
    if (level > 0) {
      // Four windows of the last level make one of this; those read have not been replaced yet.
      const auto half = std::size_t{1} << (level - 1);
      for (std::size_t row = 0; row < height; ++row) {
        for (std::size_t i = row * width; i + half < (row + 1) * width; ++i) windows[i] |= windows[i + half];
      }
      for (std::size_t i = 0; i + half * width < windows.size(); ++i) windows[i] |= windows[i + half * width];
    }
    add_level(level, windows, border);
  }
}

void ContactPyramid::add_level(int level, const std::vector<std::uint8_t>& windows, int border) {
  const auto nodes = [&](int cells) { return ((cells - 1) >> level) + 1; };
  Level l;
  // A tile may begin a whole tile before the first windows and end as far behind the last.
  l.last_column = nodes(frame_.columns) + TileCounts::columns - 1;
  l.last_row = nodes(frame_.rows) + TileCounts::rows - 1;
  l.words = l.last_column / word_bits + 2;
  l.rows = l.last_row + TileCounts::rows;
  l.bits.assign(static_cast<std::size_t>(l.words) * static_cast<std::size_t>(l.rows) << (2 * level), 0);
  const int width = frame_.columns + border;
  for (std::size_t i = 0; i < windows.size(); ++i) {
    if (windows[i] == 0) continue;
    const int column = static_cast<int>(i % static_cast<std::size_t>(width)) - border;
    const int row = static_cast<int>(i / static_cast<std::size_t>(width)) - border;
    const auto phase = static_cast<std::size_t>(low_bits(row, level) << level | low_bits(column, level));
    const int bit = (column >> level) + TileCounts::columns;
    const int line = (row >> level) + TileCounts::rows;
    const std::size_t column_of_words =
        phase * static_cast<std::size_t>(l.words) + static_cast<std::size_t>(bit / word_bits);
    l.bits[column_of_words * static_cast<std::size_t>(l.rows) + static_cast<std::size_t>(line)] |=
        std::uint64_t{1} << (bit % word_bits);
  }
  levels_.push_back(std::move(l));
}

std::size_t ContactPyramid::memory_bytes() const {
  std::size_t words = 0;
  for (const Level& level : levels_) words += level.bits.size();
  return words * sizeof(std::uint64_t);
}

std::size_t ContactPyramid::count(int level, const CellPoints& points, int column, int row, std::size_t least,
                                  TileCounts& counts) const {
  const Level& l = levels_[static_cast<std::size_t>(level)];
  TileLooks& looks = counts.looks_;
  looks.words.resize(points.columns_.size() + lanes);
  looks.shifts.resize(points.columns_.size() + lanes);
  const TileLayout tile{level, column, row, l.words, l.rows, l.last_column, l.last_row};
  const std::size_t n = HWY_DYNAMIC_DISPATCH(find_looks_in_vectors)(
      tile, points.columns_.data(), points.rows_.data(), points.columns_.size(), looks);
  // The first words are empty: nothing is in contact so far before the first cell.
  constexpr std::ptrdiff_t group = 8;
  std::fill_n(looks.words.begin() + static_cast<std::ptrdiff_t>(n), group, 0);
  std::fill_n(looks.shifts.begin() + static_cast<std::ptrdiff_t>(n), group, 0);

  counts.planes_.assign(std::max<std::size_t>(3, static_cast<std::size_t>(std::bit_width(n))), {});
  counts.largest_ = 0;
  constexpr std::size_t stretch = 64;
  std::size_t looked_at = 0;
  while (looked_at < n && counts.largest() + (n - looked_at) >= least) {
    const std::size_t now = std::min(stretch, n - looked_at);
    HWY_DYNAMIC_DISPATCH(add_looks_in_vectors)
    (l.bits.data(), static_cast<std::size_t>(l.rows), looks, looked_at, (now + group - 1) / group * group,
     counts.planes_.front().data(), counts.planes_.size());
    counts.find_largest();
    looked_at += now;
  }
  return looked_at;
}

std::shared_ptr<const ContactPyramid> contact_pyramid(const GlobalMap& map, double cell, double epsilon) {
  check_cell(cell, epsilon);
  return map.index<ContactPyramid>(fmt::format("{} {}", cell, epsilon),
                                   [&] { return ContactPyramid(map.points(), cell, epsilon); });
}

}  // namespace glocal
#endif
