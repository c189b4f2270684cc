// How many points of a local map can be in contact, at most, over whole blocks of translations.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/motion.hpp"
#include "glocal/points.hpp"

namespace glocal {

/// The cells that rotated points lie in, relative to a translation yet to be found.
class CellPoints {
 public:
  /// A pyramid in the plane does not look at layers.
  void push_back(std::int32_t column, std::int32_t row, std::int32_t layer = 0);
  [[nodiscard]] std::size_t size() const { return size_; }
  [[nodiscard]] std::span<const std::int32_t> columns() const { return {columns_.data(), size_}; }
  [[nodiscard]] std::span<const std::int32_t> rows() const { return {rows_.data(), size_}; }
  [[nodiscard]] std::span<const std::int32_t> layers() const { return {layers_.data(), size_}; }

 private:
  friend class ContactPyramid;
  /// A multiple of every vector's length of them; beyond the last, so far away that nothing is there.
  std::vector<std::int32_t> columns_, rows_, layers_;
  std::size_t size_ = 0;
};

/// Square cells over a map, or cubic ones in space, and wherever a point can be in contact with it.
struct CellFrame {
  double cell = 0.0;  ///< m
  /// Outer corner of cell (0, 0, 0) in the map's frame, m.
  double min_x = 0.0, min_y = 0.0, min_z = 0.0;
  int columns = 0, rows = 0, layers = 1;
};

/// Throws ConfigError where the cells of a search (m) are larger than epsilon (m): poses between them would
/// be missed.
void check_cell(double cell, double epsilon);

/// All cells within `epsilon` (m) of a point of the map, in the plane or, where the motion is not planar, in
/// space. Throws ConfigError where they are too many for a grid (1 GiB).
[[nodiscard]] CellFrame cell_frame(const Points& map_points, double cell, double epsilon,
                                   Motion motion = Motion::planar);

/// Where in a level's bits the points that meet a tile find those of its nodes.
struct TileLooks {
  std::vector<std::uint32_t> words;   ///< The word of the tile's first row and column.
  std::vector<std::uint32_t> shifts;  ///< The bit in it.
  std::size_t size = 0;
};

/// What finding them takes.
struct TileLayout {
  int level;
  int column, row;           ///< Of the tile's first node, in cells.
  std::int32_t words, rows;  ///< See ContactPyramid::Level.
  std::int32_t last_column, last_row;
  int layer;  ///< What is added to a point's layer to have that of its windows.
  std::int32_t layer_words, last_layer;
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

  [[nodiscard]] std::size_t at(int column, int row) const;
  [[nodiscard]] std::size_t largest() const { return largest_; }
  [[nodiscard]] Mask at_least(std::size_t count) const;

 private:
  friend class ContactPyramid;
  void find_largest();

  std::vector<Mask> planes_;
  std::size_t largest_ = 0;
  TileLooks looks_;  ///< Of the last tile; kept for their memory.
};

/// Which cells of a map are in contact, and for each level l the sliding-window maximum of that: whether any
/// cell of the 2^l x 2^l cells from a cell on is. A node of level l stands for 2^l x 2^l translations; each
/// point meets their cells in one such window, wherever the window begins, so the number of windows in
/// contact bounds what any of the translations reaches (Olson 2015; Hess et al. 2016). A maximum over aligned
/// blocks would be no bound: a window lies across up to four of them.
///
/// Bits of a level are sorted by where a window begins within 2^l cells, so that the nodes of a tile, 2^l
/// cells apart, are neighbouring bits: one word for each row of a tile.
///
/// In space windows are cubes of 2^l cells, and each layer of windows has its own bits.
class ContactPyramid {
 public:
  /// Nodes of the top level are 0.8 m wide where cells are 0.05 m: larger ones bound nothing indoors.
  static constexpr int default_top_level = 4;

  /// A cell (of side `cell`, m) is in contact if its centre is within `epsilon` (m) of a point in the plane;
  /// in space where the motion is not planar. Throws ConfigError if it would need more than 1 GiB.
  ContactPyramid(const Points& map_points, double cell, double epsilon, int top_level = default_top_level,
                 Motion motion = Motion::planar);

  /// All cells in contact lie in it.
  [[nodiscard]] const CellFrame& frame() const { return frame_; }
  [[nodiscard]] bool in_space() const { return in_space_; }
  [[nodiscard]] int top_level() const { return static_cast<int>(levels_.size()) - 1; }
  [[nodiscard]] std::size_t memory_bytes() const;

  /// For each node of a tile of level l, how many of the points are in contact after any of the node's
  /// translations at most, and exactly how many on level 0. Node (i, k) of the tile stands for the
  /// translations by [column + i * 2^l, column + (i + 1) * 2^l) cells and rows likewise. Stops early where no
  /// node can reach `least`; the counts are then too small, but all below `least`. Returns how many points
  /// were looked at. At most TileCounts::most_points. In space, all nodes of a tile stand for the
  /// translations by [layer, layer + 2^l) layers.
  std::size_t count(int level, const CellPoints& points, int column, int row, std::size_t least,
                    TileCounts& counts, int layer = 0) const;

 private:
  struct Level {
    std::int32_t words = 0;  ///< In a row of windows that begin at the same place within 2^l cells.
    std::int32_t rows = 0;   ///< Of such windows; words of one column of words are neighbours.
    std::int32_t last_column = 0, last_row = 0;  ///< Of tiles that meet windows in contact.
    std::int32_t layer_words = 0;                ///< In a layer of windows.
    std::vector<std::uint64_t> bits;
  };
  /// A byte for each window; they may begin before the first cell.
  struct Windows;
  void add_level(int level, const Windows& windows);

  CellFrame frame_;
  bool in_space_;
  int layers_before_ = 0;  ///< Layers of windows that begin before the first cell.
  std::vector<Level> levels_;
};

/// The pyramid over a map, built once per map.
[[nodiscard]] std::shared_ptr<const ContactPyramid> contact_pyramid(const GlobalMap& map, double cell,
                                                                    double epsilon,
                                                                    Motion motion = Motion::planar);

}  // namespace glocal
