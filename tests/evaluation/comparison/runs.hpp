// Runs made by hand, to compare.
#pragma once

#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"

namespace glocal::test {

/// Right after so many steps of 0.5 m, with errors and a time that follow from the steps.
inline TrialResult right_after(double steps) {
  TrialResult trial;
  trial.outcome = Outcome::right;
  trial.steps = steps;
  trial.distance_m = 0.5 * steps;
  trial.translation_error_m = 0.01 * steps;
  trial.rotation_error_deg = 0.1 * steps;
  trial.step_cpu_ms = 2.0 * steps;
  return trial;
}

inline TrialResult ended(Outcome outcome) {
  TrialResult trial;
  trial.outcome = outcome;
  trial.steps = 60.0;
  trial.distance_m = 30.0;
  trial.step_cpu_ms = 5.0;
  return trial;
}

/// A complete run whose trials start every 100 m.
inline NamedRun run_of(const std::string& name, const std::vector<TrialResult>& trials) {
  NamedRun run;
  run.name = name;
  run.results.folder = "results/" + name;
  run.results.experiment = name;
  for (std::size_t i = 0; i < trials.size(); ++i) {
    const auto number = static_cast<double>(i);
    run.results.trials[{static_cast<std::int64_t>(i), 100.0 * number, 1000.0 + number}] = trials[i];
  }
  return run;
}

/// 30 starts: both are right at 20 of them, the variant 2 steps sooner; only the baseline at 1, only the
/// variant at 9, where the baseline is wrong.
inline std::vector<NamedRun> slow_and_quick() {
  std::vector<TrialResult> slow, quick;
  for (int i = 0; i < 20; ++i) {
    slow.push_back(right_after(10.0 + i));
    quick.push_back(right_after(8.0 + i));
  }
  slow.push_back(right_after(9.0));
  quick.push_back(ended(Outcome::undecided));
  for (int i = 0; i < 9; ++i) {
    slow.push_back(ended(Outcome::wrong));
    quick.push_back(right_after(7.0));
  }
  return {run_of("slow", slow), run_of("quick", quick)};
}

}  // namespace glocal::test
