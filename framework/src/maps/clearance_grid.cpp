#include "glocal/clearance_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "glocal/parallel.hpp"
#include "maps/look_up.hpp"

namespace glocal {
namespace {

static_assert(std::endian::native == std::endian::little,
              "a block's least number is the lowest byte of its word");

constexpr int most = 255;

/// How much nearer than `most` the nearest occupied cell is, of rows of cells. Said so, what is told from
/// cell to cell falls to 0 and no farther, which vector loops can do. There is a cell more on either side.
class Nearness {
 public:
  Nearness(const OccupancyGrid& grid, int first_row, int end_row)
      : width_(static_cast<std::size_t>(grid.width)),
        rows_(static_cast<std::size_t>(end_row - first_row)),
        numbers_(stride() * rows_),
        told_(width_) {
    for (std::size_t row = 0; row < rows_; ++row) {
      const std::size_t begin = grid.index(0, first_row) + row * width_;
      std::uint8_t* numbers = at(row);
      grid.cells.for_occupied(begin, begin + width_, [&](std::size_t cell) { numbers[cell - begin] = most; });
    }
    // Two passes over the neighbours already visited give the chessboard distance (Rosenfeld and Pfaltz
    // 1966).
    for (std::size_t row = 0; row < rows_; ++row) {
      if (row > 0) tell_row(at(row - 1), at(row));
      for (std::size_t n = 1; n <= most; n *= 2) tell(at(row), n, true);
    }
    for (std::size_t row = rows_; row-- > 0;) {
      if (row + 1 < rows_) tell_row(at(row + 1), at(row));
      for (std::size_t n = 1; n <= most; n *= 2) tell(at(row), n, false);
    }
  }

  [[nodiscard]] std::size_t stride() const { return width_ + 2; }
  [[nodiscard]] std::uint8_t* at(std::size_t row) { return numbers_.data() + row * stride() + 1; }

 private:
  [[nodiscard]] static std::uint8_t less(std::uint8_t number, std::uint8_t by) {
    return static_cast<std::uint8_t>(std::max(number, by) - by);
  }

  /// From a row to the next one.
  void tell_row(const std::uint8_t* from, std::uint8_t* to) const {
    const std::uint8_t* left = from - 1;
    const std::uint8_t* right = from + 1;
    for (std::size_t i = 0; i < width_; ++i)
      to[i] = std::max(to[i], less(std::max(from[i], std::max(left[i], right[i])), 1));
  }

  /// From each cell of a row to the one n cells to the right, or to the left. For n = 1, 2, 4, … all are told
  /// of all.
  void tell(std::uint8_t* row, std::size_t n, bool to_right) {
    if (n >= width_) return;
    std::copy(row, row + width_, told_.begin());
    const std::uint8_t* from = told_.data() + (to_right ? 0 : n);
    std::uint8_t* to = row + (to_right ? n : 0);
    const auto by = static_cast<std::uint8_t>(n);
    for (std::size_t i = 0; i < width_ - n; ++i) to[i] = std::max(to[i], less(from[i], by));
  }

  std::size_t width_, rows_;
  std::vector<std::uint8_t> numbers_;
  std::vector<std::uint8_t> told_;
};

}  // namespace

ClearanceGrid::ClearanceGrid(const OccupancyGrid& grid, int threads)
    : grid_from_map_(inverse(grid.map_from_grid)),
      resolution_(static_cast<float>(grid.resolution)),
      width_(grid.width),
      height_(grid.height),
      block_columns_(static_cast<std::size_t>((width_ + block_side - 1) / block_side)) {
  if (grid.cells.empty()) return;
  blocks_.resize(block(0, height_ - 1 + block_side) + sizeof(Word));
  // Some rows at a time, with all that is near them: numbers of all cells would take more memory than is
  // kept.
  constexpr int rows_at_a_time = 1024;
  const int strips = (height_ - 1) / rows_at_a_time + 1;
  parallel_for(threads, static_cast<std::size_t>(strips), [&](std::size_t strip) {
    const int begin = static_cast<int>(strip) * rows_at_a_time;
    const int end = std::min(height_, begin + rows_at_a_time);
    const int first = std::max(0, begin - most);
    Nearness near(grid, first, std::min(height_, end + most));
    pack(near.at(static_cast<std::size_t>(begin - first)), near.stride(), begin, end);
  });
}

void ClearanceGrid::pack(const std::uint8_t* nearness, std::size_t stride, int first_row, int end_row) {
  for (int row = first_row; row < end_row; row += block_side) {
    for (int column = 0; column < width_; column += block_side) {
      const auto for_cells = [&](auto visit) {
        for (int r = row; r < std::min(end_row, row + block_side); ++r) {
          const std::uint8_t* line = nearness + static_cast<std::size_t>(r - first_row) * stride;
          for (int c = column; c < std::min(width_, column + block_side); ++c)
            visit(line[c], (r - row) * block_side + c - column);
        }
      };
      std::uint8_t nearest = 0;
      for_cells([&](std::uint8_t number, int /*place*/) { nearest = std::max(nearest, number); });
      auto word = static_cast<Word>(most - nearest);
      for_cells([&](std::uint8_t number, int place) {
        word |= static_cast<Word>(nearest - number) << (8 + 2 * place);
      });
      std::memcpy(&blocks_[block(column, row)], &word, block_bytes);
    }
  }
}

inline int ClearanceGrid::clearance(int column, int row) const {
  Word word;
  std::memcpy(&word, &blocks_[block(column, row)], sizeof(word));
  constexpr int within = block_side - 1;
  const int place = (row & within) * block_side + (column & within);
  return static_cast<int>((word & 255U) + (word >> (8 + 2 * place) & 3U));
}

std::optional<double> ClearanceGrid::first_occupied(const Point& from, const Point& to, double margin) const {
  const Point a = grid_from_map_(from);
  const Point b = grid_from_map_(to);
  const float dx = b.x - a.x;
  const float dy = b.y - a.y;
  const float length = std::sqrt(dx * dx + dy * dy);
  if (blocks_.empty() || !(length > 0.0F)) return std::nullopt;
  const float scale = 1.0F / resolution_;
  const float end = std::min((length - static_cast<float>(margin)) * scale, farthest);
  const float columns = dx / length, rows = dy / length;
  float t = 0.5F;
  // A ray from beyond the grid begins a cell or two before the first one that it meets, if it meets any.
  const auto enter = [&](float beyond, float along) {
    if (beyond == 0.0F) return true;
    const float entry = -beyond / along;
    t = std::max(t, std::floor(entry) - 1.0F);
    return entry > 0.0F;
  };
  if (!enter(outside(a.x * scale, width_), columns) || !enter(outside(a.y * scale, height_), rows))
    return std::nullopt;
  bool was_inside = false;
  while (t <= end) {
    const float column = a.x * scale + t * columns;
    const float row = a.y * scale + t * rows;
    const bool inside = column >= 0.0F && row >= 0.0F && column < static_cast<float>(width_) &&
                        row < static_cast<float>(height_);
    // A ray that has left the grid does not come back.
    if (was_inside && !inside) return std::nullopt;
    was_inside = inside;
    const int clear = inside ? clearance(static_cast<int>(column), static_cast<int>(row)) : 1;
    if (clear == 0) return t * resolution_;
    t += std::max(0.5F, static_cast<float>(clear - 1));
  }
  return std::nullopt;
}

void ClearanceGrid::find_blocked(const Point& from, const Points& ends, const Transform& map_from_ends,
                                 double margin, std::vector<std::uint8_t>& blocked) const {
  blocked.assign(ends.size(), 0);
  if (blocks_.empty()) return;
  const ClearanceView view{.blocks = blocks_.data(),
                           .block_columns = static_cast<std::int32_t>(block_columns_),
                           .width = width_,
                           .height = height_,
                           .resolution = resolution_};
  glocal::find_blocked(view, grid_from_map_(from), ends, map_from_ends, grid_from_map_,
                       static_cast<float>(margin), blocked);
}

std::shared_ptr<const ClearanceGrid> clearance_grid(const GlobalMap& map, int threads) {
  return map.index<ClearanceGrid>("", [&] { return ClearanceGrid(map.grid(), threads); });
}

}  // namespace glocal
