// "Which point of the local map is nearest?" and "how likely is a hit here?", answered in constant time.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace glocal::local_mappers {

/// A cell of the plane; (0, 0) is the lowest corner of what the grid can hold.
struct GridCell {
  int column = 0;
  int row = 0;
};

/// Square cells over the plane around the origin, in tiles that exist only where there are points. Each new
/// point stamps the cells around it, so a look-up costs the same however many points there are, and nothing
/// is ever rebuilt.
///
/// A cell knows the point whose cell is nearest to it (the earlier of two equally near ones), up to `reach`
/// cells away in columns and rows, and the likelihood exp(-d^2 / (2 sigma^2)) of a hit at distance d between
/// these cells.
class PointGrid {
 public:
  /// Side of the square the grid can hold, in cells: 819 m to each side of the origin with cells of 5 cm.
  static constexpr int side = 32768;
  /// Farthest a point may stamp, cells.
  static constexpr int max_reach = 11;
  /// Points are counted with 24 bits.
  static constexpr std::size_t max_points = std::size_t{1} << 24U;
  /// Likelihoods are stored as multiples of 1 / 255.
  static constexpr int likelihood_one = 255;
  /// Cells of a row that likelihood_rows() copies.
  static constexpr int window_width = 16;
  static constexpr int none = -1;

  /// `resolution`: side of a cell, m; `reach`: cells, at most max_reach; `sigma`: m; `max_tiles`: memory it
  /// may use.
  PointGrid(double resolution, int reach, double sigma, std::size_t max_tiles);

  /// Whether the point's cell, with all it would stamp, is within the square.
  [[nodiscard]] bool contains(float x, float y) const;
  /// The cell of a point that is within the square.
  [[nodiscard]] GridCell cell(float x, float y) const {
    return {static_cast<int>(x * scale_ + half), static_cast<int>(y * scale_ + half)};
  }

  /// The nearest point, or none if there is none within reach or the place is outside the square.
  [[nodiscard]] int nearest(float x, float y) const {
    const float column = x * scale_ + half;
    const float row = y * scale_ + half;
    if (!(column >= 0.0F && column < side && row >= 0.0F && row < side)) return none;
    const std::uint32_t packed = packed_at({static_cast<int>(column), static_cast<int>(row)});
    return packed == nothing ? none : static_cast<int>(packed & index_mask);
  }

  /// The point in this cell itself, or none.
  [[nodiscard]] int inside(GridCell cell) const {
    const std::uint32_t packed = packed_at(cell);
    return packed <= index_mask ? static_cast<int>(packed) : none;
  }

  /// Adds point `index` (below max_points) to a cell where there is none yet. False, and nothing changes, if
  /// tiles run out.
  bool insert(GridCell cell, std::size_t index);

  /// Copies the likelihoods of the cells from `first` on, `rows` rows of window_width, into `out`. Outside
  /// the square they are 0.
  void likelihood_rows(GridCell first, int rows, std::uint8_t* out) const;

  void clear();

  [[nodiscard]] std::size_t tiles() const { return used_.size(); }
  [[nodiscard]] static constexpr std::size_t tile_bytes() { return sizeof(Tile); }
  [[nodiscard]] std::size_t memory_bytes() const;
  [[nodiscard]] double resolution() const { return resolution_; }

 private:
  static constexpr int tile_bits = 6;
  static constexpr int tile_side = 1 << tile_bits;
  static constexpr int tile_mask = tile_side - 1;
  static constexpr std::size_t tile_cells = std::size_t{tile_side} * tile_side;
  static constexpr int tiles_across = side / tile_side;
  static constexpr float half = 0.5F * side;
  static constexpr unsigned index_bits = 24;
  static constexpr std::uint32_t index_mask = (std::uint32_t{1} << index_bits) - 1;
  static constexpr std::uint32_t nothing = 0xffffffff;

  struct Tile {
    /// Squared distance in cells above the index of the point: the nearer point, then the earlier one, is the
    /// smaller number.
    std::array<std::uint32_t, tile_cells> packed;
    std::array<std::uint8_t, tile_cells> likelihood;

    Tile() { clear(); }
    void clear() {
      packed.fill(nothing);
      likelihood.fill(0);
    }
  };

  [[nodiscard]] static std::size_t tile_index(int column, int row) {
    return static_cast<std::size_t>(row >> tile_bits) * tiles_across +
           static_cast<std::size_t>(column >> tile_bits);
  }
  [[nodiscard]] static std::size_t index_in_tile(int column, int row) {
    return static_cast<std::size_t>(((row & tile_mask) << tile_bits) | (column & tile_mask));
  }
  [[nodiscard]] std::uint32_t packed_at(GridCell cell) const {
    return directory_[tile_index(cell.column, cell.row)]->packed[index_in_tile(cell.column, cell.row)];
  }
  /// Makes the tile if there is none; false if there may be no more.
  bool require_tile(int column, int row);
  void stamp(GridCell centre, GridCell first, GridCell last, std::uint32_t index);

  double resolution_;
  float scale_;  ///< Cells per metre.
  int reach_;
  std::size_t max_tiles_;
  std::vector<std::uint32_t> distance_stamp_;   ///< (2 reach + 1)^2 squared distances, in the upper bits.
  std::vector<std::uint8_t> likelihood_stamp_;  ///< (2 reach + 1)^2
  std::unique_ptr<Tile> empty_;  ///< Stands wherever there is no tile: reading needs no question.
  std::vector<Tile*> directory_;
  std::vector<std::size_t> used_;  ///< Places in the directory that have a tile.
  std::vector<std::unique_ptr<Tile>>
      tiles_;  ///< The first used_.size() are in the directory; the rest are spare.
};

}  // namespace glocal::local_mappers
