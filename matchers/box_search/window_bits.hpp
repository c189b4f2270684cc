// Counts of points in contact for many neighbouring translations at once. Reasons: docs/performance.md.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace glocal {

/// The cells that rotated points lie in, relative to a translation yet to be found.
class CellPoints {
 public:
  /// Bits in the plane have no layers.
  void push_back(std::int32_t column, std::int32_t row, std::int32_t layer = 0);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<const std::int32_t> columns() const { return {columns_.data(), size_}; }
  [[nodiscard]] std::span<const std::int32_t> rows() const { return {rows_.data(), size_}; }
  [[nodiscard]] std::span<const std::int32_t> layers() const { return {layers_.data(), size_}; }

 private:
  friend class WindowBits;
  /// A multiple of every vector's length of them; beyond the last, so far away that nothing is there.
  std::vector<std::int32_t> columns_, rows_, layers_;
  std::size_t size_ = 0;
};

/// Where in a level's bits the points that meet a tile find those of its nodes.
struct TileLooks {
  std::vector<std::uint32_t> words;   ///< The word of the tile's first row and column.
  std::vector<std::uint32_t> next;    ///< The one behind it in that row.
  std::vector<std::uint32_t> shifts;  ///< The bit in the first.
};

/// How the bits of a layer of windows lie: for each place that a window can begin at within 2^level cells,
/// columns of words, which are cut into blocks of rows.
struct BitsLayout {
  /// A block has the first rows of the next one, too, so that all rows of a tile lie in one block.
  static constexpr int block_rows = 32;

  int level;
  std::int32_t words;       ///< In a row of windows that begin at the same place within 2^level cells.
  std::int32_t row_blocks;  ///< In a column of such words.
  std::int32_t last_column, last_row;  ///< Of tiles that meet windows in contact.
};

/// What finding them takes.
struct TileLayout {
  BitsLayout bits;
  int column, row;  ///< Of the tile's first node, in cells.
  int layer;        ///< What is added to a point's layer to have that of its windows.
  std::int32_t last_layer;
  const std::uint32_t* blocks;  ///< See WindowBits.
};

/// A count for each node of a tile of 64 x 8 neighbours. Bit k of the count of node (column, row) is bit
/// `column` of planes[k][row], so that a few logical operations count for all nodes of a tile at once.
class TileCounts {
 public:
  static constexpr int columns = 64;
  static constexpr int rows = 8;
  static constexpr std::size_t most_points = (std::size_t{1} << 20U) - 1;
  /// One bit for each node.
  using Mask = std::array<std::uint64_t, rows>;

  /// All counts are 0 from now on.
  void clear();

  [[nodiscard]] std::size_t at(int column, int row) const;
  [[nodiscard]] std::size_t largest() const { return largest_; }
  [[nodiscard]] Mask at_least(std::size_t count) const;

 private:
  friend class WindowBits;
  void find_largest();

  std::vector<Mask> planes_ = std::vector<Mask>(3);
  std::size_t largest_ = 0;
  std::size_t points_ = 0;  ///< That can have been counted.
  TileLooks looks_;         ///< Of the last tile; kept for their memory.
};

/// The bits of one layer of windows of one size. Blocks of them that are empty take no memory.
class LayerBits {
 public:
  /// Of windows none of which has a cell in contact yet. The last ones begin in column `columns` - 1 and row
  /// `rows` - 1, the first ones at most 2^level - 1 cells before column and row 0.
  LayerBits(int level, int columns, int rows);

  /// Takes memory for all blocks at once. Pages of it that stay empty are never there; bits that grew would
  /// leave as much behind in each thread as they take.
  void reserve();

  /// How many columns before column 0 the bits of a row begin: as many as a tile has.
  [[nodiscard]] static int columns_before(int level) { return TileCounts::columns << level; }

  /// Those windows of a row which have a cell in contact: a bit for each, the first of column
  /// -columns_before(level).
  void add_row(int row, std::span<const std::uint64_t> windows);

 private:
  friend class WindowBits;
  /// Those of them that begin at one place within 2^level cells, neighbours beside each other.
  void add_phase(int row, int column_phase, std::span<const std::uint64_t> windows);
  /// Where a block begins in `words_`, which takes it in if it was empty.
  [[nodiscard]] std::uint64_t* block(std::size_t place);

  BitsLayout layout_;
  std::vector<std::uint32_t> numbers_;  ///< Of the blocks in `words_`; of those that are empty 0.
  std::vector<std::uint64_t> words_;    ///< The first block is empty.
};

/// The bits of windows of one size, sorted by where a window begins within 2^level cells, so that the nodes
/// of a tile, 2^level cells apart, are neighbouring bits: one word for each row of a tile. Node (i, k) of a
/// tile at (column, row) stands for the translations by [column + i * 2^level, column + (i + 1) * 2^level)
/// cells and rows likewise. In space each layer of windows has its own bits, and all nodes of a tile have the
/// same translation by layers.
class WindowBits {
 public:
  /// Of layers of windows of one size, at least one, of which so many lie below that of layer 0.
  WindowBits(std::vector<LayerBits> layers, int layers_before, bool in_space);

  /// Adds to the count of each node of a tile how many points find a window in contact. Stops early where no
  /// node can reach `least`, though `behind` points that are to be added after these were all in contact; the
  /// counts are then too small, but too small to reach it. Returns how many points were looked at. At most
  /// TileCounts::most_points in all.
  std::size_t add(const CellPoints& points, int column, int row, int layer, std::size_t least,
                  std::size_t behind, TileCounts& counts) const;

  [[nodiscard]] std::size_t memory_bytes() const {
    return bits_.size() * sizeof(std::uint64_t) + blocks_.size() * sizeof(std::uint32_t);
  }

 private:
  /// Where those of the points that meet a tile look; behind them at nothing. Returns how many they are.
  std::size_t find(const CellPoints& points, int column, int row, int layer, TileLooks& looks) const;

  BitsLayout layout_;
  int layers_before_;
  std::int32_t last_layer_;
  bool in_space_;
  /// Where the words of each block begin: of those of one column of words one after the other, then of the
  /// columns, the places within 2^level cells, and the layers.
  std::vector<std::uint32_t> blocks_;
  std::vector<std::uint64_t> bits_;  ///< The first block is that of all that are empty.
};

}  // namespace glocal
