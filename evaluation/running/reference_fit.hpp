// Whether reference poses belong to the map.
#pragma once

#include <optional>
#include <string>

#include "evaluation/running/drive.hpp"
#include "glocal/global_map.hpp"

namespace glocal {

/// The share of hits that lie within `epsilon` (m) of the map at the reference poses, in [0, 1]: of 50 scans
/// along the drive, 200 hits of each. None without reference poses, or without hits.
[[nodiscard]] std::optional<double> reference_fit(const Drive& drive, const GlobalMap& map, double epsilon);

/// A sentence for the user where that share is below 0.15: the poses are then in another frame than the map,
/// or of another time than the scans. A laser that sees mostly what is not on the map has 0.2 or more.
[[nodiscard]] std::optional<std::string> doubt_of_references(const Drive& drive, const GlobalMap& map,
                                                             double epsilon);

}  // namespace glocal
