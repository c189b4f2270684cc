// A suite in plain formats, for programs that know nothing of glocal.
#pragma once

#include <cstddef>
#include <filesystem>
#include <vector>

#include "config/suites.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/experiment.hpp"

namespace glocal::app {

/// Writes a folder for each variant with its map (map.yaml and map.pgm where it has cells, map.pcd), its
/// drive (drive.mcap, and a cloud for each scan beside odometry.tum), and starts.csv for all. Reference poses
/// are left out. Returns how many starts there are. Throws ConfigError and RunError.
std::size_t write_plain_suite(const Suite& suite, std::vector<Variant>& variants, ExperimentLoader& loader,
                              const std::filesystem::path& out, bool force);

}  // namespace glocal::app
