// Where one map lies in another.
#pragma once

#include <cstdint>
#include <optional>

#include "glocal/global_map.hpp"
#include "glocal/strategies.hpp"

namespace glocal::app {

struct Alignment {
  Pose2 map_from_other;
  double in_contact;  ///< Share of the other map's points.
};

/// Lays points on a map by a matcher that was made for it, then by Gauss-Newton on the distance field. None
/// if the matcher finds no pose that it scores at least 0.25.
[[nodiscard]] std::optional<Alignment> align_maps(const GlobalMap& map, const Points& other, Matcher& matcher,
                                                  double contact_epsilon, std::uint64_t seed);

}  // namespace glocal::app
