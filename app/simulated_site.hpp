// A generated site: map, drive, and an experiment that reads them back.
#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <string>

#include "glocal/catalog.hpp"
#include "glocal/occupancy_grid.hpp"
#include "glocal/strategies.hpp"

namespace glocal::app {

/// What `glocal simulate` writes.
struct SimulatedFiles {
  Recording drive;
  OccupancyGrid grid;
  std::string experiment;            ///< YAML, which names the files of both.
  int threads = 1;                   ///< Of the experiment.
  Vector3 origin = Vector3::Zero();  ///< That the grid is relative to, m.
};

struct SiteOptions {
  std::string site;
  double side = 0.0;         ///< m
  double resolution = 0.05;  ///< Of the map, m.
  double length = 0.0;       ///< Of the drive, m; 0: chosen.
  int starts = 0;            ///< Of the experiment; 0: chosen.

  /// Adds --site and what goes with it. This object must live as long as the command.
  void add_to(CLI::App& command);
};

/// Throws ConfigError where there is no side, and for a drive of too many observations.
[[nodiscard]] SimulatedFiles simulated_site(const SiteOptions& options, std::uint64_t seed,
                                            const Catalog& catalog);

}  // namespace glocal::app
