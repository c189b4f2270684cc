// Poses that another program has found on a suite, judged as if the method were one of glocal's.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "evaluation/leaderboard/board_entry.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/error.hpp"

namespace glocal {

/// Where the robot was seen in a step.
struct ImportedPose {
  int line = 0;
  Pose3 map_from_robot;
  bool declared = false;  ///< Whether the method is sure of it.
};

struct ImportedPoses {
  std::filesystem::path file;
  /// By case, seed and start, then by step; steps count from 0.
  std::map<std::tuple<std::string, std::uint64_t, std::size_t>, std::map<std::size_t, ImportedPose>> starts;
};

/// Reads a table with the columns case, start, step, declared (0 or 1) and either x, y, yaw_deg or x, y, z,
/// qx, qy, qz, qw, in any order; a column seed where the suite has several. Throws ConfigError with every
/// fault: columns that are missing, what is no number or NaN, rows that are there twice, starts that the
/// suite does not have.
[[nodiscard]] ImportedPoses read_imported(const std::filesystem::path& file, const Suite& suite);

/// What the poses come to on a variant. The first declared one of a start counts; a start without is
/// undecided. Appends to `faults` for rows behind a trial's end, and where the poses fit the references only
/// after they have all been moved alike: they are of another frame.
[[nodiscard]] CaseResult judged(const ImportedPoses& poses, const Variant& variant,
                                const LoadedExperiment& loaded, std::vector<Fault>& faults);

}  // namespace glocal
