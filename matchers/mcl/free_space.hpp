// Where a robot can be.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/pose2.hpp"
#include "glocal/rng.hpp"

namespace glocal::mcl {

/// The cells of a map that are known to be free.
class FreeSpace {
 public:
  /// Throws ConfigError if there is none.
  explicit FreeSpace(const OccupancyGrid& grid);

  /// A robot pose anywhere in free space: each place and each heading as likely as any other.
  [[nodiscard]] Pose2 draw(Rng& rng) const;

  [[nodiscard]] double square_metres() const {
    return static_cast<double>(cells_.size()) * resolution_ * resolution_;
  }

 private:
  Pose2 map_from_grid_;
  double resolution_;
  std::uint32_t width_;
  std::vector<std::uint32_t> cells_;
};

/// That of a map, shared by all who ask for it.
[[nodiscard]] std::shared_ptr<const FreeSpace> free_space(const GlobalMap& map);

}  // namespace glocal::mcl
