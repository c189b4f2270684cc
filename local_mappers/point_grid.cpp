#include "local_mappers/point_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace glocal::local_mappers {

PointGrid::PointGrid(double resolution, int reach, double sigma, std::size_t max_tiles)
    : resolution_(resolution),
      scale_(static_cast<float>(1.0 / resolution)),
      reach_(reach),
      max_tiles_(max_tiles),
      empty_(std::make_unique<Tile>()),
      directory_(static_cast<std::size_t>(tiles_across) * tiles_across, empty_.get()) {
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int squared = dx * dx + dy * dy;
      const double metres = std::sqrt(squared) * resolution;
      const double likelihood = std::exp(-metres * metres / (2.0 * sigma * sigma));
      distance_stamp_.push_back(static_cast<std::uint32_t>(squared) << index_bits);
      likelihood_stamp_.push_back(static_cast<std::uint8_t>(std::lround(likelihood * likelihood_one)));
    }
  }
}

bool PointGrid::contains(float x, float y) const {
  const float low = static_cast<float>(reach_);
  const float high = static_cast<float>(side - reach_);
  const float column = x * scale_ + half;
  const float row = y * scale_ + half;
  return column >= low && column < high && row >= low && row < high;
}

bool PointGrid::require_tile(int column, int row) {
  Tile*& tile = directory_[tile_index(column, row)];
  if (tile != empty_.get()) return true;
  if (used_.size() >= max_tiles_) return false;
  if (used_.size() == tiles_.size()) tiles_.push_back(std::make_unique<Tile>());
  tile = tiles_[used_.size()].get();
  used_.push_back(tile_index(column, row));
  return true;
}

bool PointGrid::insert(GridCell cell, std::size_t index) {
  const GridCell low{cell.column - reach_, cell.row - reach_};
  const GridCell high{cell.column + reach_, cell.row + reach_};
  // A stamp is narrower than a tile, so its corners name all the tiles it touches.
  if (!require_tile(low.column, low.row) || !require_tile(high.column, low.row) ||
      !require_tile(low.column, high.row) || !require_tile(high.column, high.row)) {
    return false;
  }
  for (int row = low.row; row <= high.row; row = (row | tile_mask) + 1) {
    for (int column = low.column; column <= high.column; column = (column | tile_mask) + 1) {
      stamp(cell, {column, row},
            {std::min(high.column, column | tile_mask), std::min(high.row, row | tile_mask)},
            static_cast<std::uint32_t>(index));
    }
  }
  return true;
}

void PointGrid::stamp(GridCell centre, GridCell first, GridCell last, std::uint32_t index) {
  Tile& tile = *directory_[tile_index(first.column, first.row)];
  const int stride = 2 * reach_ + 1;
  const int width = last.column - first.column + 1;
  for (int row = first.row; row <= last.row; ++row) {
    const std::size_t to = index_in_tile(first.column, row);
    const int from = (row - centre.row + reach_) * stride + first.column - centre.column + reach_;
    std::uint32_t* packed = tile.packed.data() + to;
    std::uint8_t* likelihood = tile.likelihood.data() + to;
    const std::uint32_t* new_distance = distance_stamp_.data() + from;
    const std::uint8_t* new_likelihood = likelihood_stamp_.data() + from;
    for (int i = 0; i < width; ++i) packed[i] = std::min(packed[i], new_distance[i] | index);
    for (int i = 0; i < width; ++i) likelihood[i] = std::max(likelihood[i], new_likelihood[i]);
  }
}

void PointGrid::likelihood_rows(GridCell first, int rows, std::uint8_t* out) const {
  const bool within =
      first.column >= 0 && first.column + window_width <= side && first.row >= 0 && first.row + rows <= side;
  if (!within) {
    std::memset(out, 0, static_cast<std::size_t>(rows) * window_width);
    return;
  }
  const int left_width = std::min(window_width, tile_side - (first.column & tile_mask));
  for (int row = first.row; row < first.row + rows; ++row, out += window_width) {
    const std::size_t tile = tile_index(first.column, row);
    const std::uint8_t* left = directory_[tile]->likelihood.data() + index_in_tile(first.column, row);
    if (left_width == window_width) {
      std::memcpy(out, left, window_width);
    } else {
      const std::uint8_t* right = directory_[tile + 1]->likelihood.data() + index_in_tile(0, row);
      std::memcpy(out, left, static_cast<std::size_t>(left_width));
      std::memcpy(out + left_width, right, static_cast<std::size_t>(window_width - left_width));
    }
  }
}

void PointGrid::clear() {
  for (std::size_t i = 0; i < used_.size(); ++i) {
    tiles_[i]->clear();
    directory_[used_[i]] = empty_.get();
  }
  used_.clear();
}

std::size_t PointGrid::memory_bytes() const {
  return (tiles_.size() + 1) * sizeof(Tile) + directory_.size() * sizeof(void*);
}

}  // namespace glocal::local_mappers
