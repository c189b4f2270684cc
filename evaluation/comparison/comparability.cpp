#include "evaluation/comparison/comparability.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <set>

namespace glocal {
namespace {

using Sentences = std::vector<std::string>;

/// With fewer places even a method that is right every time may miss one in six: Wilson's bound of 20 of 20
/// is 84 %.
constexpr std::size_t few_places = 20;

/// More of them than this share overlapping spoils the tests.
constexpr double many_overlaps = 0.1;

/// Reference poses of one start that differ by more than rounding: another drive, or another frame.
constexpr double same_reference_m = 1e-3;

constexpr std::size_t most_named = 3;

std::string joined(Sentences items, std::size_t most = SIZE_MAX) {
  if (items.size() > most) {
    const std::size_t more = items.size() - most;
    items.resize(most);
    items.push_back(fmt::format("{} more", more));
  }
  return fmt::format("{}", fmt::join(items, ", "));
}

/// What methods are compared by.
struct Compared {
  const std::vector<NamedRun>& runs;
  const std::vector<Method>& methods;
  const PairedTrials& paired;

  [[nodiscard]] const std::string& name(std::size_t method) const { return methods[method].name; }
  [[nodiscard]] const NamedRun& run(const PairedTrials::Cell& cell, std::size_t method) const {
    return runs[cell.runs[method]];
  }
};

void add_missing_trials(const Compared& compared, Sentences& warnings) {
  const PairedTrials& paired = compared.paired;
  if (!paired.left_out.empty())
    warnings.push_back(
        fmt::format("Left out, as not all methods have them: {}.", joined(paired.left_out, most_named)));
  Sentences interrupted, others;
  for (std::size_t m = 0; m < compared.methods.size(); ++m) {
    std::size_t trials = 0;
    for (const PairedTrials::Cell& cell : paired.cells) {
      const NamedRun& run = compared.run(cell, m);
      if (!run.results.complete) interrupted.push_back(run.name);
      trials += run.results.trials.size();
    }
    if (trials > paired.trials.size())
      others.push_back(fmt::format("{} of {}", trials - paired.trials.size(), compared.name(m)));
  }
  if (!interrupted.empty())
    warnings.push_back(fmt::format("{} {} interrupted: later trials are missing.",
                                   joined(interrupted, most_named),
                                   interrupted.size() == 1 ? "was" : "were"));
  if (!others.empty())
    warnings.push_back(fmt::format("Only the {} starts that all methods have are compared. Left out: {}.",
                                   paired.trials.size(), joined(others)));
}

void add_unjudged(const Compared& compared, Sentences& warnings) {
  for (std::size_t m = 0; m < compared.methods.size(); ++m) {
    const auto& trials = compared.paired.results[m];
    const auto count = [&](Outcome outcome) {
      return std::ranges::count(trials, outcome, &TrialResult::outcome);
    };
    if (const auto failed = count(Outcome::failed); failed > 0) {
      warnings.push_back(fmt::format("{} trials of {} failed with an exception; they count as undecided.",
                                     failed, compared.name(m)));
    }
    if (const auto declared = count(Outcome::declared); declared > 0) {
      warnings.push_back(
          fmt::format("{} declarations of {} have no reference to judge them by; they count as undecided.",
                      declared, compared.name(m)));
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
  return found;
}

/// The same is said once, of however many cases and seeds.
void add_once(const std::string& sentence, Sentences& warnings) {
  if (std::find(warnings.begin(), warnings.end(), sentence) == warnings.end()) warnings.push_back(sentence);
}

void add_settings(const Compared& compared, std::size_t method, std::size_t baseline, Sentences& warnings) {
  struct Section {
    const char* path;
    const char* message;
  };
  const std::string& name = compared.name(method);
  const std::string& other = compared.name(baseline);
  for (const Section& section : {
           Section{"evaluation",
                   "{0} and {1} were judged by other limits, so right and wrong do not mean the "
                   "same ({2})."},
           Section{"map", "{0} and {1} were given other maps ({2})."},
           Section{"observations", "{0} and {1} were given other observations ({2})."},
           Section{"trials.max_steps", "Trials of {0} and {1} may go on for other numbers of steps ({2})."},
           Section{"trials.whole", "Trials of {0} and {1} end otherwise ({2})."},
       }) {
    for (const PairedTrials::Cell& cell : compared.paired.cells) {
      const Sentences found =
          differences(compared.run(cell, method).results, compared.run(cell, baseline).results, section.path);
      if (!found.empty())
        add_once(fmt::format(fmt::runtime(section.message), name, other, joined(found, most_named)),
                 warnings);
    }
  }
  for (const PairedTrials::Cell& cell : compared.paired.cells) {
    const std::uint64_t seed = compared.run(cell, method).results.seed;
    const std::uint64_t seed_of_other = compared.run(cell, baseline).results.seed;
    if (seed != seed_of_other)
      add_once(fmt::format("{} has seed {} and {} seed {}: draws differ, and in simulations the noise of the "
                           "observations.",
                           name, seed, other, seed_of_other),
               warnings);
  }
}

void add_references(const Compared& compared, std::size_t method, std::size_t baseline, Sentences& warnings) {
  std::size_t moved = 0;
  const std::size_t trials = compared.paired.trials.size();
  for (std::size_t i = 0; i < trials; ++i) {
    const auto& a = compared.paired.results[method][i]->start_reference;
    const auto& b = compared.paired.results[baseline][i]->start_reference;
    moved += a && b && distance(*a, *b) > same_reference_m ? 1 : 0;
  }
  if (moved == 0) return;
  warnings.push_back(fmt::format(
      "At {} of {} starts {} and {} have different reference poses: another drive, or another frame "
      "of the map.",
      moved, trials, compared.name(method), compared.name(baseline)));
}

void add_times(const Compared& compared, std::size_t method, std::size_t baseline, Sentences& warnings) {
  Sentences reasons;
  for (const PairedTrials::Cell& cell : compared.paired.cells) {
    if (auto why = why_times_differ(compared.run(cell, method), compared.run(cell, baseline)))
      reasons.push_back(*std::move(why));
  }
  if (reasons.empty()) return;
  const std::size_t cells = compared.paired.cells.size();
  warnings.push_back(fmt::format(
      "Times of {} and {} are not compared{}: {}.", compared.name(method), compared.name(baseline),
      cells == 1 ? "" : fmt::format(" in {} of {} runs", reasons.size(), cells), reasons.front()));
}

/// Trials that reach the next start see some of the same scans: their outcomes are not independent, as all
/// tests take them to be.
void add_overlaps(const Compared& compared, Sentences& warnings) {
  const PairedTrials& paired = compared.paired;
  // Of each trial the way to the next start of its case and seed; none behind the last one.
  std::vector<std::optional<double>> gaps(paired.trials.size());
  std::vector<std::optional<std::size_t>> before(paired.cells.size());
  for (std::size_t t = 0; t < paired.trials.size(); ++t) {
    const auto& [cell, start] = paired.trials[t];
    if (before[cell]) gaps[*before[cell]] = start.distance_m - paired.trials[*before[cell]].start.distance_m;
    before[cell] = t;
  }
  Sentences overlapping;
  for (std::size_t m = 0; m < compared.methods.size(); ++m) {
    std::size_t overlaps = 0;
    for (std::size_t t = 0; t < gaps.size(); ++t)
      overlaps += gaps[t] && paired.results[m][t]->distance_m > *gaps[t] ? 1 : 0;
    if (static_cast<double>(overlaps) > many_overlaps * static_cast<double>(gaps.size()))
      overlapping.push_back(fmt::format("{} of {}", overlaps, compared.name(m)));
  }
  if (overlapping.empty()) return;
  warnings.push_back(
      fmt::format("Of {} trials, these go on beyond the next start: {}. Neighbours are not independent, and "
                  "p-values and intervals are too optimistic. Starts further apart would mend that.",
                  gaps.size(), joined(overlapping)));
}

void add_few_places(std::size_t places, Sentences& warnings) {
  if (places >= few_places) return;
  warnings.push_back(
      fmt::format("Few places: {} right of {} would still leave a success rate of {:.0f} % possible.", places,
                  places, 100.0 * wilson(places, places).low));
}

}  // namespace

std::optional<std::string> why_times_differ(const NamedRun& run, const NamedRun& baseline) {
  const Machine& a = run.results.machine;
  const Machine& b = baseline.results.machine;
  const auto refuse = [&](const std::string& mine, const std::string& other) {
    return mine + ", and " + other;
  };
  if (a.host != b.host || a.cpu != b.cpu || a.threads != b.threads || a.threads == 0) {
    const auto text = [](const Machine& m) {
      return fmt::format("{} ({}), {} threads", m.host, m.cpu,
                         m.threads == 0 ? "several numbers of" : std::to_string(m.threads));
    };
    return refuse(text(a), text(b));
  }
  if (a.jobs != b.jobs || a.jobs == 0) {
    const auto text = [](const Machine& m) {
      return m.jobs == 0 ? "processes of several numbers of jobs" : fmt::format("--jobs {}", m.jobs);
    };
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

std::vector<std::string> comparability_warnings(const std::vector<NamedRun>& runs,
                                                const std::vector<Method>& methods, std::size_t baseline,
                                                const PairedTrials& paired, bool with_times) {
  const Compared compared{runs, methods, paired};
  Sentences warnings;
  add_missing_trials(compared, warnings);
  add_unjudged(compared, warnings);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    if (m == baseline) continue;
    add_settings(compared, m, baseline, warnings);
    add_references(compared, m, baseline, warnings);
    if (with_times) add_times(compared, m, baseline, warnings);
  }
  add_overlaps(compared, warnings);
  add_few_places(paired.places.size(), warnings);
  return warnings;
}

}  // namespace glocal
