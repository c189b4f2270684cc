// Space that is known to be free.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "glocal/points.hpp"

namespace glocal {

/// Voxels that are known to be free: a bit each, in bricks of 8 x 8 x 8 voxels. Bricks without any take no
/// memory.
class FreeVoxels {
 public:
  /// Voxels along each axis lie in [-reach, reach[.
  static constexpr int reach = 8 << 20;

  /// Nothing is known.
  FreeVoxels() = default;
  /// None yet. Voxel (i, j, k) reaches from i, j, k to i + 1, j + 1, k + 1 times the side (m) in a frame of
  /// its own, which lies in the map's as OccupancyGrid::map_from_grid does.
  FreeVoxels(const Pose2& map_from_voxels, double side);

  void add(int column, int row, int layer);
  /// Those of `other`, shifted by so many columns.
  void add_shifted(const FreeVoxels& other, int columns);

  [[nodiscard]] bool empty() const { return bricks_.empty(); }
  /// Whether a point of the map (m) is in one of the voxels; not for NaN.
  [[nodiscard]] bool contains(const Point& p) const;

  [[nodiscard]] double side() const { return side_; }
  [[nodiscard]] const Pose2& map_from_voxels() const { return map_from_voxels_; }
  /// How many bricks have some.
  [[nodiscard]] std::size_t bricks() const { return bricks_.size(); }

 private:
  struct Brick {
    std::uint64_t place = 0;              ///< Its column, row and layer, 21 bits each.
    std::array<std::uint64_t, 8> bits{};  ///< A layer of 8 rows each, the lowest first.
  };

  Pose2 map_from_voxels_;
  double side_ = 1.0;
  Transform voxels_from_map_{Pose2{}};
  std::vector<Brick> bricks_;
  std::unordered_map<std::uint64_t, std::uint32_t> numbers_;  ///< Of the bricks, by their place.
};

}  // namespace glocal
