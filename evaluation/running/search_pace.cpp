#include "evaluation/running/search_pace.hpp"

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <limits>
#include <vector>

#include "evaluation/running/drive.hpp"
#include "evaluation/running/elapsed.hpp"
#include "evaluation/running/trials.hpp"
#include "glocal/localizer.hpp"

namespace glocal {
namespace {

/// Long beside what begins a piece, and short beside a search.
constexpr std::size_t looks_of_piece = 100'000;
constexpr std::size_t pieces_wanted = 100;
constexpr std::size_t most_trials = 10;

/// Times (ms) of pieces of the trial's searches, until there are as many as wanted. The last piece of a
/// search has fewer looks and is none.
void time_pieces(Localizer& localizer, const TrialsConfig& trials, const Drive& drive,
                 std::size_t start_sample, std::vector<double>& times) {
  const std::size_t end = start_sample + steps_left(drive, trials, start_sample);
  for (std::size_t i = start_sample; i < end; ++i) {
    StepResult result = localizer.step(drive.samples[i].observation);
    while (result.goes_on()) {
      if (times.size() == pieces_wanted) return;
      const auto begin = std::chrono::steady_clock::now();
      result = localizer.go_on(looks_of_piece);
      if (result.goes_on()) times.push_back(ms_since(begin));
    }
    if (result.verdict.kind == VerdictKind::localized) return;
  }
}

}  // namespace

std::optional<int> looks_within(double ms, Experiment experiment, const Catalog& catalog,
                                LoadedExperiment& loaded) {
  experiment.localizer.looks_per_step = static_cast<int>(looks_of_piece);
  Localizer localizer = make_localizer(experiment, catalog, loaded);
  std::vector<double> times;
  const std::size_t trials = std::min(most_trials, loaded.starts.size());
  for (std::size_t trial = 0; trial < trials && times.size() < pieces_wanted; ++trial) {
    localizer.reset(start_number(experiment.trials, trial));
    time_pieces(localizer, experiment.trials, loaded.drive, loaded.starts[trial], times);
  }
  if (times.empty()) return std::nullopt;
  const auto median = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::ranges::nth_element(times, median);
  const double looks = ms / *median * static_cast<double>(looks_of_piece);
  return static_cast<int>(std::clamp(looks, 1.0, double{std::numeric_limits<int>::max()}));
}

}  // namespace glocal
