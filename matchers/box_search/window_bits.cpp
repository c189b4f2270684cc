#include "matchers/box_search/window_bits.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/box_search/window_bits.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

#include "matchers/common/put_chosen-inl.hpp"

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
void add_looks_in_vectors(const std::uint64_t* bits, const TileLooks& looks, std::size_t begin, std::size_t n,
                          std::uint64_t* planes, std::size_t planes_size) {
  const Words d;
  for (std::size_t row = 0; row < TileCounts::rows; row += hn::Lanes(d)) {
    for (std::size_t i = begin; i < begin + n; i += 8) {
      const auto found = [&](std::size_t k) HWY_ATTR {
        const int shift = static_cast<int>(looks.shifts[i + k]);
        const V low = hn::ShiftRightSame(hn::LoadU(d, bits + looks.words[i + k] + row), shift);
        const V next = hn::LoadU(d, bits + looks.next[i + k] + row);
        return hn::Or(low, hn::ShiftLeftSame(hn::ShiftLeft<1>(next), 63 - shift));
      };
      add_eight(found, planes + row, planes_size);
    }
  }
}

/// The looks of those of n points that meet a tile; n is a multiple of every vector's length. Writes whole
/// vectors. Returns how many they are. `layers` are looked at in space alone.
template <bool in_space>
HWY_INLINE std::size_t find_looks(const TileLayout& tile, const std::int32_t* columns,
                                  const std::int32_t* rows, const std::int32_t* layers, std::size_t n,
                                  TileLooks& looks) {
  const hn::CappedTag<std::int32_t, 16> d;
  const hn::Rebind<std::uint32_t, decltype(d)> words;
  const BitsLayout& bits = tile.bits;
  const auto low_bits = hn::Set(d, (1 << bits.level) - 1);
  const auto within = [&](auto value, std::int32_t last) HWY_ATTR {
    return hn::And(hn::Gt(value, hn::Set(d, -1)), hn::Lt(value, hn::Set(d, last + 1)));
  };
  std::size_t size = 0;
  for (std::size_t i = 0; i < n; i += hn::Lanes(d)) {
    const auto x = hn::Add(hn::LoadU(d, columns + i), hn::Set(d, tile.column));
    const auto y = hn::Add(hn::LoadU(d, rows + i), hn::Set(d, tile.row));
    const auto first = hn::Add(hn::ShiftRightSame(x, bits.level), hn::Set(d, TileCounts::columns));
    const auto line = hn::Add(hn::ShiftRightSame(y, bits.level), hn::Set(d, TileCounts::rows));
    auto phase = hn::Or(hn::ShiftLeftSame(hn::And(y, low_bits), bits.level), hn::And(x, low_bits));
    auto meets = hn::And(within(first, bits.last_column), within(line, bits.last_row));
    if constexpr (in_space) {
      const auto layer = hn::Add(hn::LoadU(d, layers + i), hn::Set(d, tile.layer));
      phase = hn::Or(hn::ShiftLeftSame(layer, 2 * bits.level), phase);
      meets = hn::And(meets, within(layer, tile.last_layer));
    }
    if (hn::AllFalse(d, meets)) continue;
    const auto column = hn::Add(hn::Mul(phase, hn::Set(d, bits.words)), hn::ShiftRight<6>(first));
    const auto block = hn::Add(hn::Mul(column, hn::Set(d, bits.row_blocks)), hn::ShiftRight<5>(line));
    // Of points that do not meet the tile, those of the first.
    const auto place = hn::IfThenElseZero(meets, block);
    const auto row = hn::BitCast(words, hn::And(line, hn::Set(d, BitsLayout::block_rows - 1)));
    const auto word = hn::Add(hn::GatherIndex(words, tile.blocks, place), row);
    const auto next = hn::Add(hn::GatherIndex(words, tile.blocks + bits.row_blocks, place), row);
    const auto found = hn::RebindMask(words, meets);
    put_chosen(words, hn::BitCast(words, hn::And(first, hn::Set(d, 63))), found, looks.shifts.data() + size);
    put_chosen(words, next, found, looks.next.data() + size);
    size += put_chosen(words, word, found, looks.words.data() + size);
  }
  return size;
}

std::size_t find_looks_in_vectors(const TileLayout& tile, bool in_space, const std::int32_t* columns,
                                  const std::int32_t* rows, const std::int32_t* layers, std::size_t n,
                                  TileLooks& looks) {
  return in_space ? find_looks<true>(tile, columns, rows, layers, n, looks)
                  : find_looks<false>(tile, columns, rows, layers, n, looks);
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
/// So many looks are added at once.
constexpr std::size_t at_a_time = 8;
constexpr std::size_t block_words = BitsLayout::block_rows + TileCounts::rows;

int low_bits(int value, int n) {
  return value & ((1 << n) - 1);
}

/// Bits 0, 2, 4, … beside each other.
std::uint64_t every_second(std::uint64_t bits) {
  bits &= 0x5555555555555555ULL;
  bits = (bits | bits >> 1U) & 0x3333333333333333ULL;
  bits = (bits | bits >> 2U) & 0x0f0f0f0f0f0f0f0fULL;
  bits = (bits | bits >> 4U) & 0x00ff00ff00ff00ffULL;
  bits = (bits | bits >> 8U) & 0x0000ffff0000ffffULL;
  return (bits | bits >> 16U) & 0x00000000ffffffffULL;
}

}  // namespace

void CellPoints::push_back(std::int32_t column, std::int32_t row, std::int32_t layer) {
  constexpr std::int32_t far_away = -(1 << 29);
  if (size_ == columns_.size()) {
    columns_.resize(size_ + lanes, far_away);
    rows_.resize(size_ + lanes, far_away);
    layers_.resize(size_ + lanes, far_away);
  }
  columns_[size_] = column;
  rows_[size_] = row;
  layers_[size_] = layer;
  ++size_;
}

void TileCounts::clear() {
  planes_.assign(3, {});
  largest_ = 0;
  points_ = 0;
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

LayerBits::LayerBits(int level, int columns, int rows) : words_(block_words) {
  // A tile may begin a whole tile before the first windows and end as far behind the last.
  const int last_column = ((columns - 1) >> level) + TileCounts::columns;
  const int last_row = ((rows - 1) >> level) + TileCounts::rows;
  layout_ = {.level = level,
             .words = last_column / word_bits + 2,
             .row_blocks = last_row / BitsLayout::block_rows + 1,
             .last_column = last_column,
             .last_row = last_row};
  numbers_.resize(static_cast<std::size_t>(layout_.words * layout_.row_blocks) << (2 * level));
}

void LayerBits::reserve() {
  words_.reserve((numbers_.size() + 1) * block_words);
}

void LayerBits::add_row(int row, std::span<const std::uint64_t> windows) {
  // Every second one at a time goes to either side, once for each bit of a place within 2^level cells.
  struct Part {
    std::vector<std::uint64_t> windows;
    int phase;
  };
  std::vector<Part> parts;
  parts.push_back({{windows.begin(), windows.end()}, 0});
  for (int i = 0; i < layout_.level; ++i) {
    std::vector<Part> halves;
    for (const Part& part : parts) {
      for (const int odd : {0, 1}) {
        Part& half = halves.emplace_back();
        half.phase = part.phase | odd << i;
        half.windows.resize((part.windows.size() + 1) / 2);
        for (std::size_t w = 0; w < part.windows.size(); ++w)
          half.windows[w / 2] |= every_second(part.windows[w] >> odd) << (w % 2 * word_bits / 2);
      }
    }
    parts = std::move(halves);
  }
  for (const Part& part : parts) add_phase(row, part.phase, part.windows);
}

void LayerBits::add_phase(int row, int column_phase, std::span<const std::uint64_t> windows) {
  const int level = layout_.level;
  const int phase = low_bits(row, level) << level | column_phase;
  const int line = (row >> level) + TileCounts::rows;
  const int in_block = low_bits(line, std::bit_width(unsigned{BitsLayout::block_rows - 1}));
  for (std::size_t w = 0; w < windows.size(); ++w) {
    if (windows[w] == 0) continue;
    const std::size_t column = static_cast<std::size_t>(phase) * static_cast<std::size_t>(layout_.words) + w;
    const std::size_t place = column * static_cast<std::size_t>(layout_.row_blocks) +
                              static_cast<std::size_t>(line / BitsLayout::block_rows);
    block(place)[in_block] |= windows[w];
    if (in_block < TileCounts::rows && line >= BitsLayout::block_rows)
      block(place - 1)[BitsLayout::block_rows + in_block] |= windows[w];
  }
}

std::uint64_t* LayerBits::block(std::size_t place) {
  if (numbers_[place] == 0) {
    numbers_[place] = static_cast<std::uint32_t>(words_.size() / block_words);
    words_.resize(words_.size() + block_words);
  }
  return &words_[numbers_[place] * block_words];
}

WindowBits::WindowBits(std::vector<LayerBits> layers, int layers_before, bool in_space)
    : layout_(layers.front().layout_),
      layers_before_(layers_before),
      last_layer_(static_cast<std::int32_t>(layers.size()) - 1),
      in_space_(in_space) {
  std::size_t words = block_words;
  for (const LayerBits& layer : layers) words += layer.words_.size() - block_words;
  // In the plane, where there is one layer, nothing is copied.
  bits_ = std::move(layers.front().words_);
  bits_.reserve(words);
  blocks_.reserve(layers.size() * layers.front().numbers_.size());
  for (LayerBits& layer : layers) {
    const bool is_first = &layer == &layers.front();
    const std::size_t before = is_first ? 0 : bits_.size() - block_words;
    for (const std::uint32_t number : layer.numbers_)
      blocks_.push_back(number == 0 ? 0 : static_cast<std::uint32_t>(before + number * block_words));
    if (is_first) continue;
    bits_.insert(bits_.end(), layer.words_.begin() + block_words, layer.words_.end());
    layer.words_ = {};  // or it would all be there twice
  }
}

std::size_t WindowBits::find(const CellPoints& points, int column, int row, int layer,
                             TileLooks& looks) const {
  const std::size_t padded = points.columns_.size();
  for (std::vector<std::uint32_t>* each : {&looks.words, &looks.next, &looks.shifts})
    each->resize(padded + lanes);
  const TileLayout tile{.bits = layout_,
                        .column = column,
                        .row = row,
                        .layer = layer + layers_before_,
                        .last_layer = last_layer_,
                        .blocks = blocks_.data()};
  const std::size_t n = HWY_DYNAMIC_DISPATCH(find_looks_in_vectors)(
      tile, in_space_, points.columns_.data(), points.rows_.data(), points.layers_.data(), padded, looks);
  for (std::vector<std::uint32_t>* each : {&looks.words, &looks.next, &looks.shifts})
    std::fill_n(each->begin() + static_cast<std::ptrdiff_t>(n), at_a_time, 0);  // nothing in the first block
  return n;
}

std::size_t WindowBits::add(const CellPoints& points, int column, int row, int layer, std::size_t least,
                            std::size_t behind, TileCounts& counts) const {
  TileLooks& looks = counts.looks_;
  const std::size_t n = find(points, column, row, layer, looks);
  counts.points_ += n;
  counts.planes_.resize(
      std::max(counts.planes_.size(), static_cast<std::size_t>(std::bit_width(counts.points_))));
  constexpr std::size_t stretch = 64;
  std::size_t looked_at = 0;
  while (looked_at < n && counts.largest() + (n - looked_at) + behind >= least) {
    const std::size_t now = std::min(stretch, n - looked_at);
    HWY_DYNAMIC_DISPATCH(add_looks_in_vectors)
    (bits_.data(), looks, looked_at, (now + at_a_time - 1) / at_a_time * at_a_time,
     counts.planes_.front().data(), counts.planes_.size());
    counts.find_largest();
    looked_at += now;
  }
  return looked_at;
}

}  // namespace glocal
#endif
