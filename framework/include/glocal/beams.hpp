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

/// At most so many of a scan's beams, chosen evenly: the hits in beam order, then those that met nothing.
[[nodiscard]] std::vector<Beam> some_beams(const Scan& scan, std::size_t most);

}  // namespace glocal
