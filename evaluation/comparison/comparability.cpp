#include "evaluation/comparison/comparability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

namespace glocal {
namespace {

using Sentences = std::vector<std::string>;

/// With fewer starts even a run that is right every time may miss one in six: Wilson's bound of 20 of 20 is
/// 84 %.
constexpr std::size_t few_starts = 20;

/// More of them than this share overlapping spoils the tests.
constexpr double many_overlaps = 0.1;

/// Reference poses of one start that differ by more than rounding: another drive, or another frame.
constexpr double same_reference_m = 1e-3;

std::string joined(const Sentences& items) {
  std::string text;
  for (const std::string& item : items) text += (text.empty() ? "" : ", ") + item;
  return text;
}

void add_missing_trials(const std::vector<NamedRun>& runs, std::size_t starts, Sentences& warnings) {
  Sentences left_out;
  for (const NamedRun& run : runs) {
    if (!run.results.complete)
      warnings.push_back(fmt::format("{} was interrupted: its later trials are missing.", run.name));
    const std::size_t others = run.results.trials.size() - starts;
    if (others > 0) left_out.push_back(fmt::format("{} of {}", others, run.name));
  }
  if (left_out.empty()) return;
  warnings.push_back(fmt::format("Only the {} starts that all runs have are compared. Left out: {}.", starts,
                                 joined(left_out)));
}

void add_unjudged(const std::vector<NamedRun>& runs, const std::vector<TrialsByStart>& trials,
                  Sentences& warnings) {
  for (std::size_t i = 0; i < runs.size(); ++i) {
    const auto count = [&](Outcome outcome) {
      return std::count_if(trials[i].begin(), trials[i].end(),
                           [&](const TrialResult* trial) { return trial->outcome == outcome; });
    };
    if (const auto failed = count(Outcome::failed); failed > 0) {
      warnings.push_back(fmt::format("{} trials of {} failed with an exception; they count as undecided.",
                                     failed, runs[i].name));
    }
    if (const auto declared = count(Outcome::declared); declared > 0) {
      warnings.push_back(
          fmt::format("{} declarations of {} have no reference to judge them by; they count as undecided.",
                      declared, runs[i].name));
    }
  }
}

bool is_below(const std::string& path, const std::string& section) {
  return path == section || path.starts_with(section + ".") || path.starts_with(section + "[");
}

/// "map.log_map.resolution: 0.1 instead of 0.05", of the first few settings of a section that differ.
Sentences differences(const StoredRun& run, const StoredRun& baseline, const std::string& section) {
  std::set<std::string> paths;
  for (const StoredRun* results : {&run, &baseline}) {
    for (const auto& [path, setting] : results->settings) {
      if (is_below(path, section)) paths.insert(path);
    }
  }
  const auto find = [](const StoredRun& results, const std::string& path) {
    const auto found = results.settings.find(path);
    return found == results.settings.end() ? Setting{"nothing", "nothing"} : found->second;
  };
  Sentences found;
  for (const std::string& path : paths) {
    const Setting mine = find(run, path);
    const Setting other = find(baseline, path);
    if (mine.identity == other.identity) continue;
    found.push_back(mine.text == other.text
                        ? fmt::format("{}: {} has changed", path, mine.text)
                        : fmt::format("{}: {} instead of {}", path, mine.text, other.text));
  }
  constexpr std::size_t most_listed = 3;
  if (found.size() > most_listed) {
    const std::size_t more = found.size() - most_listed;
    found.resize(most_listed);
    found.push_back(fmt::format("{} more", more));
  }
  return found;
}

void add_settings(const NamedRun& run, const NamedRun& baseline, Sentences& warnings) {
  struct Section {
    const char* path;
    const char* message;
  };
  for (const Section& section : {
           Section{"evaluation",
                   "{0} and {1} were judged by other limits, so right and wrong do not mean the "
                   "same ({2})."},
           Section{"map", "{0} and {1} were given other maps ({2})."},
           Section{"observations", "{0} and {1} were given other observations ({2})."},
           Section{"trials.max_steps", "Trials of {0} and {1} may go on for other numbers of steps ({2})."},
           Section{"trials.whole", "Trials of {0} and {1} end otherwise ({2})."},
       }) {
    const Sentences found = differences(run.results, baseline.results, section.path);
    if (!found.empty()) {
      warnings.push_back(fmt::format(fmt::runtime(section.message), run.name, baseline.name, joined(found)));
    }
  }
  if (run.results.seed != baseline.results.seed) {
    warnings.push_back(fmt::format(
        "{} has seed {} and {} seed {}: draws differ, and in simulations the noise of the observations.",
        run.name, run.results.seed, baseline.name, baseline.results.seed));
  }
}

void add_references(const NamedRun& run, const NamedRun& baseline, const TrialsByStart& mine,
                    const TrialsByStart& others, Sentences& warnings) {
  std::size_t moved = 0;
  for (std::size_t i = 0; i < mine.size(); ++i) {
    const auto& a = mine[i]->start_reference;
    const auto& b = others[i]->start_reference;
    moved += a && b && distance(*a, *b) > same_reference_m ? 1 : 0;
  }
  if (moved == 0) return;
  warnings.push_back(fmt::format(
      "At {} of {} starts {} and {} have different reference poses: another drive, or another frame "
      "of the map.",
      moved, mine.size(), run.name, baseline.name));
}

/// Trials that reach the next start see some of the same scans: their outcomes are not independent, as all
/// tests take them to be.
void add_overlaps(const std::vector<NamedRun>& runs, const std::vector<TrialStart>& starts,
                  const std::vector<TrialsByStart>& trials, Sentences& warnings) {
  Sentences overlapping;
  for (std::size_t run = 0; run < runs.size(); ++run) {
    std::size_t overlaps = 0;
    for (std::size_t i = 0; i + 1 < starts.size(); ++i) {
      const double gap = starts[i + 1].distance_m - starts[i].distance_m;
      overlaps += trials[run][i]->distance_m > gap ? 1 : 0;
    }
    if (static_cast<double>(overlaps) > many_overlaps * static_cast<double>(starts.size()))
      overlapping.push_back(fmt::format("{} of {}", overlaps, runs[run].name));
  }
  if (overlapping.empty()) return;
  warnings.push_back(
      fmt::format("Of {} trials, these go on beyond the next start: {}. Neighbours are not independent, and "
                  "p-values and intervals are too optimistic. Starts further apart would mend that.",
                  starts.size(), joined(overlapping)));
}

void add_few_starts(std::size_t starts, Sentences& warnings) {
  if (starts >= few_starts) return;
  warnings.push_back(
      fmt::format("Few starts: {} right of {} would still leave a success rate of {:.0f} % possible.", starts,
                  starts, 100.0 * wilson(starts, starts).low));
}

}  // namespace

std::optional<std::string> why_times_differ(const NamedRun& run, const NamedRun& baseline) {
  const Machine& a = run.results.machine;
  const Machine& b = baseline.results.machine;
  const auto refuse = [&](const std::string& mine, const std::string& other) {
    return fmt::format("Times of {} and {} are not compared: {}, and {}.", run.name, baseline.name, mine,
                       other);
  };
  if (a.host != b.host || a.cpu != b.cpu || a.threads != b.threads) {
    const auto text = [](const Machine& m) {
      return fmt::format("{} ({}), {} threads", m.host, m.cpu, m.threads);
    };
    return refuse(text(a), text(b));
  }
  if (a.jobs != b.jobs) {
    const auto text = [](const Machine& m) { return fmt::format("--jobs {}", m.jobs); };
    return refuse(text(a), text(b));
  }
  // Caches and clocks are shared: others slow down even what only the own processor's time is counted of.
  constexpr double same_load = 0.5;
  if (a.others_load && b.others_load && std::abs(*a.others_load - *b.others_load) > same_load) {
    const auto text = [](const Machine& m) {
      return fmt::format("others kept {:.1f} processors busy", *m.others_load);
    };
    return refuse(text(a), text(b));
  }
  return std::nullopt;
}

std::vector<std::string> comparability_warnings(const std::vector<NamedRun>& runs, std::size_t baseline,
                                                const std::vector<TrialStart>& starts,
                                                const std::vector<TrialsByStart>& trials) {
  Sentences warnings;
  add_missing_trials(runs, starts.size(), warnings);
  add_unjudged(runs, trials, warnings);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    if (i == baseline) continue;
    add_settings(runs[i], runs[baseline], warnings);
    add_references(runs[i], runs[baseline], trials[i], trials[baseline], warnings);
    if (auto why = why_times_differ(runs[i], runs[baseline])) warnings.push_back(*std::move(why));
  }
  add_overlaps(runs, starts, trials, warnings);
  add_few_starts(starts.size(), warnings);
  return warnings;
}

}  // namespace glocal
