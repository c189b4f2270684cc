// Where one map lies in another.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "glocal/global_map.hpp"
#include "matchers/ransam/ransam.hpp"

namespace glocal::app {

struct Alignment {
  Pose2 map_from_other;
  double in_contact;  ///< Share of the other map's points.
};

/// Random sample matching of whole maps, then Gauss-Newton on the distance field. None if no pose brings a
/// quarter of the points into contact.
[[nodiscard]] std::optional<Alignment> align_maps(const std::shared_ptr<const GlobalMap>& map,
                                                  const Points& other, const Ransam::Params& params,
                                                  std::uint64_t seed);

}  // namespace glocal::app
