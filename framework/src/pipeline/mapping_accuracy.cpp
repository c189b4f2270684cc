#include "pipeline/mapping_accuracy.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <tuple>
#include <utility>

#include "glocal/error.hpp"

namespace glocal {

namespace {

/// A drive cut at its interruptions: metres driven at each sample since the start of its segment.
std::vector<double> driven(const std::vector<Sample>& drive) {
  std::vector<double> metres(drive.size(), 0.0);
  for (std::size_t i = 1; i < drive.size(); ++i) {
    if (drive[i].segment != drive[i - 1].segment) continue;
    metres[i] = metres[i - 1] + distance(*drive[i - 1].map_from_robot, *drive[i].map_from_robot);
  }
  return metres;
}

/// The first sample of the same segment that lies `metres` farther, if there is one.
std::optional<std::size_t> farther(const std::vector<Sample>& drive, const std::vector<double>& driven_m,
                                   std::size_t from, double metres) {
  for (std::size_t i = from; i < drive.size() && drive[i].segment == drive[from].segment; ++i) {
    if (driven_m[i] - driven_m[from] >= metres) return i;
  }
  return std::nullopt;
}

std::vector<std::size_t> starts(const std::vector<Sample>& drive, const std::vector<double>& driven_m,
                                double every_m) {
  std::vector<std::size_t> found;
  double next = 0.0;
  for (std::size_t i = 0; i < drive.size(); ++i) {
    if (i == 0 || drive[i].segment != drive[i - 1].segment) next = 0.0;
    if (driven_m[i] < next) continue;
    found.push_back(i);
    next = (std::floor(driven_m[i] / every_m) + 1.0) * every_m;
  }
  return found;
}

/// Cells that hits have fallen in.
class CellCounter {
 public:
  explicit CellCounter(double cell) : cell_(cell) {}

  void add(const Points& hits, const Pose2& local_from_robot) {
    const Transform transform(local_from_robot);
    for (std::size_t i = 0; i < hits.size(); ++i) {
      const Point p = transform(hits[i]);
      cells_.emplace_back(std::floor(p.x / cell_), std::floor(p.y / cell_));
    }
  }

  [[nodiscard]] std::size_t count() {
    std::sort(cells_.begin(), cells_.end());
    cells_.erase(std::unique(cells_.begin(), cells_.end()), cells_.end());
    return cells_.size();
  }

 private:
  double cell_;
  std::vector<std::pair<double, double>> cells_;
};

/// Error of the way from `first` to `last` as the mapper tells it, as a pose.
Pose2 way_error(const Sample& first, const Sample& last, const Pose2& local_from_robot) {
  const Pose2 truth = inverse(*first.map_from_robot) * *last.map_from_robot;
  return inverse(truth) * local_from_robot;
}

/// Runs the mapper from one start.
class WindowRun {
 public:
  WindowRun(const std::vector<Sample>& drive, LocalMapper& mapper, std::size_t first, double cell)
      : drive_(drive), mapper_(mapper), next_(first), cells_(cell) {
    window_.first = first;
    mapper_.reset();
  }

  /// Goes on up to and including `last`.
  void run_to(std::size_t last, std::vector<double>& add_ms) {
    using Clock = std::chrono::steady_clock;
    for (; next_ <= last; ++next_) {
      const auto begin = Clock::now();
      mapper_.add(drive_[next_].observation);
      add_ms.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
      if (next_ == window_.first) generation_ = mapper_.map().generation;
      cells_.add(drive_[next_].observation.scan.hits, mapper_.map().local_from_robot);
    }
  }

  /// Error (m, rad) at the last observation.
  [[nodiscard]] std::pair<double, double> error() const {
    if (mapper_.map().generation != generation_) {
      return {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    }
    const Pose2 error = way_error(drive_[window_.first], drive_[next_ - 1], mapper_.map().local_from_robot);
    return {std::hypot(error.x, error.y), std::abs(error.theta)};
  }

  /// Takes down what is measured half-way.
  void take_errors() {
    std::tie(window_.translation_error_m, window_.rotation_error_rad) = error();
    window_.occupied_cells = cells_.count();
  }
  void judge(const MappingWindows& windows) {
    const auto [translation, rotation] = error();
    window_.failed = translation > windows.fail_translation || rotation > windows.fail_rotation;
  }

  [[nodiscard]] const MappingWindow& window() const { return window_; }

 private:
  const std::vector<Sample>& drive_;
  LocalMapper& mapper_;
  std::size_t next_;
  int generation_ = 0;
  CellCounter cells_;
  MappingWindow window_;
};

void require_references(const std::vector<Sample>& drive) {
  for (std::size_t i = 0; i < drive.size(); ++i) {
    if (drive[i].map_from_robot) continue;
    Fault fault;
    fault.message = "observations: number " + std::to_string(i + 1) +
                    " has no reference pose; mapping can only be judged on a drive with reference poses";
    throw ConfigError({fault});
  }
}

}  // namespace

MappingAccuracy measure_mapping(const std::vector<Sample>& drive, LocalMapper& mapper,
                                const MappingWindows& windows) {
  require_references(drive);
  const std::vector<double> driven_m = driven(drive);
  MappingAccuracy accuracy;
  for (const std::size_t first : starts(drive, driven_m, windows.every_m)) {
    const auto middle = farther(drive, driven_m, first, windows.after_m);
    if (!middle) continue;
    WindowRun run(drive, mapper, first, windows.cell);
    run.run_to(*middle, accuracy.add_ms);
    run.take_errors();
    if (const auto end = farther(drive, driven_m, first, windows.fail_after_m)) {
      run.run_to(*end, accuracy.add_ms);
      run.judge(windows);
    }
    accuracy.windows.push_back(run.window());
  }
  return accuracy;
}

std::optional<double> quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nullopt;
  std::sort(values.begin(), values.end());
  const double place = share * static_cast<double>(values.size() - 1);
  const auto below = static_cast<std::size_t>(place);
  const std::size_t above = std::min(below + 1, values.size() - 1);
  // Infinite neighbours must not turn into NaN.
  if (values[below] == values[above]) return values[below];
  return values[below] + (place - static_cast<double>(below)) * (values[above] - values[below]);
}

}  // namespace glocal
