#include "evaluation/running/mapping_accuracy.hpp"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <numbers>
#include <string>

#include "evaluation/running/elapsed.hpp"
#include "glocal/error.hpp"

namespace glocal {

namespace {

/// The first sample of the same segment that lies `metres` farther, if there is one.
std::optional<std::size_t> farther(const Drive& drive, std::size_t from, double metres) {
  const auto it = std::lower_bound(drive.path_m.begin() + static_cast<std::ptrdiff_t>(from),
                                   drive.path_m.end(), drive.path_m[from] + metres);
  if (it == drive.path_m.end()) return std::nullopt;
  const auto found = static_cast<std::size_t>(it - drive.path_m.begin());
  if (drive.samples[found].segment != drive.samples[from].segment) return std::nullopt;
  return found;
}

/// The first sample at or after each multiple of `every_m`.
std::vector<std::size_t> window_starts(const Drive& drive, double every_m) {
  std::vector<std::size_t> starts;
  double next = 0.0;
  for (std::size_t i = 0; i < drive.samples.size(); ++i) {
    if (drive.path_m[i] < next) continue;
    starts.push_back(i);
    next = (std::floor(drive.path_m[i] / every_m) + 1.0) * every_m;
  }
  return starts;
}

/// The last sample of the first segment.
std::size_t end_of_first_segment(const Drive& drive) {
  std::size_t last = 0;
  while (last + 1 < drive.samples.size() && drive.samples[last + 1].segment == drive.samples[0].segment)
    ++last;
  return last;
}

/// Runs the mapper from one start.
class WindowRun {
 public:
  WindowRun(const Drive& drive, LocalMapper& mapper, std::size_t first, double cell)
      : drive_(drive), mapper_(mapper), first_(first), next_(first), cell_(cell) {
    mapper_.reset();
  }

  /// Goes on up to and including `last`.
  void run_to(std::size_t last, std::vector<double>& add_ms) {
    for (; next_ <= last; ++next_) {
      const Observation& observation = drive_.samples[next_].observation;
      const auto begin = std::chrono::steady_clock::now();
      mapper_.add(observation);
      add_ms.push_back(ms_since(begin));
      const LocalMap& map = mapper_.map();
      if (next_ == first_) {
        epoch_ = map.epoch;
        local_from_first_ = map.local_from_robot;
      }
      const Points in_local = moved(observation.scan.hits, map.local_from_robot);
      for (std::size_t i = 0; i < in_local.size(); ++i)
        cells_.push_back({std::floor(in_local.x[i] / cell_), std::floor(in_local.y[i] / cell_),
                          std::floor(in_local.z[i] / cell_)});
    }
  }

  /// After the last observation.
  [[nodiscard]] PoseError error() const {
    const std::size_t last = next_ - 1;
    if (mapper_.map().epoch != epoch_) {
      return {drive_.path_m[last] - drive_.path_m[first_], std::numbers::pi};
    }
    const Pose3 first_from_last =
        inverse(*drive_.samples[first_].map_from_robot) * *drive_.samples[last].map_from_robot;
    return pose_error(inverse(local_from_first_) * mapper_.map().local_from_robot, first_from_last);
  }

  [[nodiscard]] std::size_t occupied_cells() {
    std::sort(cells_.begin(), cells_.end());
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
    return cells_.size();
  }

 private:
  const Drive& drive_;
  LocalMapper& mapper_;
  std::size_t first_;
  std::size_t next_;
  int epoch_ = 0;
  Pose3 local_from_first_;  ///< Where the mapper has put the robot at the start.
  double cell_;
  std::vector<std::array<double, 3>> cells_;  ///< That hits have fallen in.
};

void require_references(const Drive& drive) {
  for (std::size_t i = 0; i < drive.samples.size(); ++i) {
    if (drive.samples[i].map_from_robot) continue;
    throw ConfigError("",
                      "observations: number " + std::to_string(i + 1) +
                          " has no reference pose; judge mapping on a drive where every observation has one");
  }
}

}  // namespace

MappingAccuracy measure_mapping(const Drive& drive, LocalMapper& mapper, const MappingWindows& windows) {
  require_references(drive);
  MappingAccuracy accuracy;
  if (windows.whole && !drive.samples.empty()) {
    WindowRun run(drive, mapper, 0, windows.cell);
    run.run_to(end_of_first_segment(drive), accuracy.add_ms);
    accuracy.windows.push_back({0, run.error(), run.occupied_cells(), std::nullopt});
    return accuracy;
  }
  for (const std::size_t first : window_starts(drive, windows.every_m)) {
    const auto middle = farther(drive, first, windows.after_m);
    if (!middle) continue;
    WindowRun run(drive, mapper, first, windows.cell);
    run.run_to(*middle, accuracy.add_ms);
    MappingWindow window{first, run.error(), run.occupied_cells(), std::nullopt};
    if (const auto end = farther(drive, first, windows.fail_after_m)) {
      run.run_to(*end, accuracy.add_ms);
      const PoseError error = run.error();
      window.failed = error.translation_m > windows.fail_translation ||
                      degrees(error.rotation_rad) > windows.fail_rotation_deg;
    }
    accuracy.windows.push_back(window);
  }
  return accuracy;
}

}  // namespace glocal
