// Some of a scan's beams.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/observation.hpp"

namespace glocal {

/// One beam, from the scan's origin.
struct Beam {
  Point end;            ///< Robot frame, m.
  bool is_hit = false;  ///< It met something there; else it is free as far as there.
};

/// What a hit says of the pose from which it was seen.
enum class HitKind {
  on_map,    ///< It is in contact with the map.
  unmapped,  ///< Nothing of the map is there, nor on the way: the map lacks it.
  beyond,    ///< On the way there the map has something that is gone, or the pose is wrong.
  unknown,   ///< It lies where the map knows nothing.
};

/// At most so many of a scan's beams, chosen evenly: the hits in beam order, then those that met nothing.
[[nodiscard]] std::vector<Beam> some_beams(const Scan& scan, std::size_t most);

}  // namespace glocal
