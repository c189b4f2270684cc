// Runs of a sweep, made by hand.
#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/comparison/runs.hpp"

namespace glocal::test {

/// What the results of a run are of.
struct Part {
  std::string setting;
  std::vector<std::pair<std::string, std::string>> values = {};
  std::string case_name = {};
  std::string role = "none";
  std::uint64_t seed = 1;
};

/// A letter for each trial: r, w or u; right ones take `steps`.
inline NamedRun sweep_run(const Part& part, const std::string& outcomes, double steps = 10.0) {
  std::vector<TrialResult> trials;
  for (const char outcome : outcomes)
    trials.push_back(outcome == 'r' ? right_after(steps)
                                    : ended(outcome == 'w' ? Outcome::wrong : Outcome::undecided));
  NamedRun run = run_of(part.setting + "_" + part.case_name + "_seed-" + std::to_string(part.seed), trials);
  run.results.experiment = "toy";
  run.results.seed = part.seed;
  nlohmann::ordered_json values = nlohmann::ordered_json::object();
  for (const auto& [path, value] : part.values) values[path] = value;
  run.results.provenance["variant"] = {{"setting", part.setting},
                                       {"seed", part.seed},
                                       {"case", part.case_name},
                                       {"role", part.role},
                                       {"values", values}};
  return run;
}

}  // namespace glocal::test
