#include "app/run_shard.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <filesystem>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

#include "app/child_process.hpp"
#include "app/interrupts.hpp"
#include "app/progress.hpp"
#include "app/shard_plan.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/journal_scan.hpp"
#include "evaluation/results/number_text.hpp"
#include "evaluation/running/drive.hpp"
#include "evaluation/sharding/run_shard.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

constexpr std::size_t most_shards = 1'000'000;
constexpr int incomplete = 3;

/// Keeps children at work until all trials of a share have come to an end.
class Supervisor {
 public:
  Supervisor(std::vector<Variant> variants, Manifest manifest, const Shard& shard, RunOptions options,
             bool quiet, const Context& context)
      : variants_(std::move(variants)),
        manifest_(std::move(manifest)),
        shard_(shard),
        options_(std::move(options)),
        quiet_(quiet),
        context_(context),
        scan_(journals_folder(options_.out), warn, JournalScan::Closed::indexed) {
    share_ = share_of(steps_of(manifest_), shard_);
  }

  /// The exit code.
  int run();

 private:
  struct Open {
    std::vector<PlannedTrial> fresh;
    std::vector<PlannedTrial> crashed;  ///< Each has ended a process.
  };

  [[nodiscard]] TrialId id(const PlannedTrial& place) const {
    return manifest_.id_of(place.variant, place.trial);
  }
  [[nodiscard]] std::size_t crashes_of(const PlannedTrial& place) const;
  [[nodiscard]] Open open() const;
  [[nodiscard]] bool any_failed() const;
  std::optional<int> run_process(const std::vector<PlannedTrial>& trials);
  int work(const std::vector<PlannedTrial>& trials, Journal& journal);
  void note_death(const ChildEnd& end, const std::vector<PlannedTrial>& trials,
                  const std::filesystem::path& journal);
  void note_crash(const ChildEnd& end, const std::vector<PlannedTrial>& running);
  void note_kill(const std::string& cause);

  std::vector<Variant> variants_;
  Manifest manifest_;
  Shard shard_;
  RunOptions options_;
  bool quiet_;
  const Context& context_;
  JournalScan scan_;
  std::vector<PlannedTrial> share_;
  std::size_t kills_ = 0;  ///< Of processes one after the other that have finished nothing.
  std::size_t finished_before_ = 0;
};

std::size_t Supervisor::crashes_of(const PlannedTrial& place) const {
  const auto crashes = scan_.crashes().find(id(place));
  return crashes == scan_.crashes().end() ? 0 : crashes->second.size();
}

Supervisor::Open Supervisor::open() const {
  Open open;
  for (const PlannedTrial& place : share_) {
    if (scan_.finished().contains(id(place)) || scan_.is_given_up(id(place))) continue;
    (crashes_of(place) == 0 ? open.fresh : open.crashed).push_back(place);
  }
  return open;
}

bool Supervisor::any_failed() const {
  return std::any_of(share_.begin(), share_.end(), [&](const PlannedTrial& place) {
    const auto finished = scan_.finished().find(id(place));
    return finished == scan_.finished().end() || finished->second.outcome == Outcome::failed;
  });
}

int Supervisor::run() {
  Open todo = open();
  if (!quiet_) {
    const std::size_t n = todo.fresh.size() + todo.crashed.size();
    spdlog::info("shard {}/{}: {} of its {} trials are to be run", shard_.number, shard_.of, n,
                 share_.size());
  }
  for (; !todo.fresh.empty() || !todo.crashed.empty(); todo = open()) {
    // One that has crashed is tried once more alone, so that it takes no others with it.
    const std::vector<PlannedTrial> trials =
        todo.fresh.empty() ? std::vector{todo.crashed.front()} : std::move(todo.fresh);
    if (const auto code = run_process(trials)) return *code;
  }
  return any_failed() ? 1 : 0;
}

/// None if there may be more to do.
std::optional<int> Supervisor::run_process(const std::vector<PlannedTrial>& trials) {
  Journal journal(journals_folder(options_.out), shard_, options_.jobs);
  const ChildEnd end = run_in_child([&] { return work(trials, journal); }, [&] { journal.touch(); });
  journal.close();
  scan_.update();
  if (!end.exit_code) note_death(end, trials, journal.file());
  if (is_interrupted()) return incomplete;
  if (end.exit_code.value_or(0) != 0) return end.exit_code;
  return std::nullopt;
}

/// In the child.
int Supervisor::work(const std::vector<PlannedTrial>& trials, Journal& journal) {
  Waiting waiting(quiet_);
  return run_shard_trials(variants_, manifest_, trials, context_.catalog, options_, journal,
                          waiting.callbacks())
             ? 0
             : incomplete;
}

void Supervisor::note_death(const ChildEnd& end, const std::vector<PlannedTrial>& trials,
                            const std::filesystem::path& journal) {
  std::vector<PlannedTrial> running;
  for (const PlannedTrial& place : trials) {
    const auto begun = scan_.begun().find(id(place));
    if (begun != scan_.begun().end() && scan_.journals()[begun->second.journal].file == journal)
      running.push_back(place);
  }
  if (end.is_own_fault) {
    note_crash(end, running);
  } else {
    note_kill(end.cause);
  }
}

/// Where the crash says which trial it was, those beside it are not to blame.
void Supervisor::note_crash(const ChildEnd& end, const std::vector<PlannedTrial>& running) {
  const auto is_named = [&](const PlannedTrial& place) {
    if (!end.crash) return false;
    const std::string& name = manifest_.variants[place.variant].name;
    const auto variant = std::ranges::find(variants_, name, &Variant::name);
    return variant != variants_.end() &&
           end.crash->trial == start_number(variant->experiment.trials, place.trial);
  };
  const bool any_named = std::any_of(running.begin(), running.end(), is_named);
  const Crash crash{end.cause, end.crash ? end.crash->where : ""};
  if (running.empty())
    throw RunError(
        fmt::format("the process crashed ({}) before it began with a trial: while it was loading map and "
                    "drive, or while strategies were made",
                    crash.signal));
  // That of the process may end in half a line.
  Journal journal(journals_folder(options_.out), shard_, 1);
  for (const PlannedTrial& place : running) {
    if (any_named && !is_named(place)) continue;
    journal.add_crash(id(place), crash);
    const std::string& variant = manifest_.variants[place.variant].name;
    spdlog::error("{}{}trial {} has crashed ({}); {}", variant, variant.empty() ? "" : ", ", place.trial,
                  crash.signal,
                  crashes_of(place) + 1 < most_crashes ? "it is tried once more, alone" : "it is given up");
  }
  journal.close();
  scan_.update();
}

/// Somebody has ended the process: its trials are not to blame. Whoever ends it may be about to end this one.
void Supervisor::note_kill(const std::string& cause) {
  constexpr std::size_t most_kills = 5;
  std::this_thread::sleep_for(std::chrono::seconds(1));
  if (is_interrupted()) return;
  kills_ = scan_.finished().size() > finished_before_ ? 1 : kills_ + 1;
  finished_before_ = scan_.finished().size();
  if (kills_ >= most_kills)
    throw RunError(
        fmt::format("{} processes were ended by {} one after the other before they had finished a "
                    "trial; what was finished before is kept",
                    kills_, cause));
  spdlog::warn("the process was ended by {}; another one goes on", cause);
}

}  // namespace

Shard shard_of(const std::string& text) {
  const std::size_t slash = text.find('/');
  const auto number = number_of<std::size_t>(std::string_view(text).substr(0, slash));
  const auto of = slash == std::string::npos
                      ? std::nullopt
                      : number_of<std::size_t>(std::string_view(text).substr(slash + 1));
  if (!number || !of || *number < 1 || *number > *of || *of > most_shards)
    throw ConfigError("--shard " + text,
                      fmt::format("is no shard; give its number and how many there are, from 1/1 to "
                                  "{0}/{0}, as in 3/64",
                                  most_shards));
  return {*number, *of};
}

void run_shard(std::vector<Variant> variants, const std::string& file, const Shard& shard,
               const RunOptions& options, bool quiet, Context& context) {
  listen_to_interrupts();
  auto manifest = planned_shards(variants, file, options.out, context);
  if (!manifest) return;
  context.exit_code =
      Supervisor(std::move(variants), std::move(*manifest), shard, options, quiet, context).run();
}

}  // namespace glocal::app
