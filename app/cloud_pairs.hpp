// How registrations of pairs of clouds turned out.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/pose3.hpp"
#include "glocal/register_clouds.hpp"
#include "sources/clouds/pair_list.hpp"

namespace glocal::app {

/// A pair, and what came of it.
struct PairOutcome {
  clouds::CloudPair pair;
  std::string method = {};  ///< The cloud registrar's name, where it was asked for by name.
  Registration registration = {};
  double cpu_s = 0.0;  ///< CPU time without reading files, s.
  /// Whether the pose found is right; none where the true one is not known.
  std::optional<bool> is_right = {};
};

/// Whether a pose is the true one: the middle of the source's points at most `translation` (m) off, its
/// orientation at most 5 degrees. The middle, as a cloud that is turned about its sensor would move far
/// points most.
[[nodiscard]] bool is_right_pose(const Pose3& found, const Pose3& truth, const Points& source,
                                 double translation);

/// A row for each class and one for all, classes in the order in which they are first met.
[[nodiscard]] std::string table_of(const std::vector<PairOutcome>& outcomes);

/// An outcome on one line: method (if it has a name), source, target, target_from_source, verdict, overlap,
/// cpu_s and more.
[[nodiscard]] std::string json_line(const PairOutcome& outcome);

}  // namespace glocal::app
