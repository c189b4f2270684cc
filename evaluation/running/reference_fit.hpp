// Whether reference poses belong to the map.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "evaluation/running/drive.hpp"
#include "glocal/global_map.hpp"

namespace glocal {

/// The share of hits that lie within `epsilon` (m) of the map at the reference poses, in [0, 1]: of 50 scans
/// along the drive, 200 hits of each. None without reference poses, or without hits.
[[nodiscard]] std::optional<double> reference_fit(const Drive& drive, const GlobalMap& map, double epsilon);

/// The share of hits of every other scan that lie within `epsilon` (m) of hits of the scans between them, of
/// up to 400 scans along the drive, where `reference_at` (by stamp, s) places them. It is highest where poses
/// are those of the scans. None if fewer than half of these have a pose, or without hits.
[[nodiscard]] std::optional<double> fit_among_scans(
    const Drive& drive, const std::function<std::optional<Pose3>(double)>& reference_at, double epsilon);

/// A sentence for the user where that share is below 0.15: the poses are then in another frame than the map,
/// or of another time than the scans. A laser that sees mostly what is not on the map has 0.2 or more.
[[nodiscard]] std::optional<std::string> doubt_of_references(const Drive& drive, const GlobalMap& map,
                                                             double epsilon);

}  // namespace glocal
