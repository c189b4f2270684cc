// A global map from the reference poses of a log.
#pragma once

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/carmen/log_drive.hpp"

namespace glocal::carmen {

/// Counts, for each cell, the rays that end in it and those that pass it.
class LogMap final : public MapSource {
 public:
  struct Params {
    Params();
    LogParams log;
    double resolution = 0.05;
    int min_hits = 3;
    /// Of the rays that reach an occupied cell, those that end in it, at least: people leave hits, but more
    /// rays pass there later. Not in YAML.
    double min_hit_share = 0.1;
  };

  LogMap(const Params& params, const SourceSetup& setup);

  /// Throws ConfigError for an unusable log, scans without reference pose, a map too large to hold, no
  /// occupied cell.
  [[nodiscard]] MapData load() override;

 private:
  Params params_;
};
void describe(ParamVisitor& v, LogMap::Params& p);

}  // namespace glocal::carmen
