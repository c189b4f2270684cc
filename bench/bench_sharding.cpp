// What many trials of many shards cost: to note one, to read all, and to put them together. Journals are
// synthetic: trials of five steps, without steps.jsonl and trajectories, as large sweeps have them.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "evaluation/results/journal_scan.hpp"
#include "evaluation/results/summary.hpp"
#include "evaluation/results/writers.hpp"
#include "evaluation/sharding/manifest.hpp"
#include "evaluation/sharding/merge.hpp"
#include "evaluation/sharding/status.hpp"
#include "temporary_folder.hpp"

namespace glocal::bench {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t variants = 100;
constexpr std::size_t shards = 200;

TrialOutput output_of_trial(std::size_t trial) {
  TrialRecord record;
  record.trial = trial;
  record.start_sample = 7 * trial;
  record.start_m = 2.0 / 3.0 * static_cast<double>(trial);
  record.start_stamp = 1e9 / 7.0 + static_cast<double>(trial);
  record.start_reference = Pose2{1.0 / 3.0, 2.0 / 7.0, 1.0 / 9.0};
  record.outcome = trial % 20 == 0 ? Outcome::undecided : Outcome::right;
  record.steps = 5;
  record.distance_m = 1.0 / 7.0 + static_cast<double>(trial % 13);
  record.pose = Pose2{1.0 / 3.0 + 0.01, 2.0 / 7.0, 1.0 / 9.0};
  record.error = PoseError{1.0 / 101.0, 1.0 / 1007.0};
  record.why = "the best pose explains 0.87 of the local map, 0.21 more than any other, for 3 steps";
  TrialFigures figures{record.outcome, 5.0, record.distance_m, *record.error};
  for (int step = 0; step < 5; ++step)
    figures.step_ms.push_back({0.1 / 3.0, 1.9 / 7.0, 0.2 / 3.0, 0.1 / 7.0, 0.0});
  figures.later_errors = {*record.error};
  return {{trial, figures, trial_line(record), ""}, {}};
}

Manifest manifest_of(std::size_t trials) {
  Manifest manifest;
  manifest.experiment = "synthetic";
  manifest.starts.emplace_back();
  for (std::size_t i = 0; i < trials / variants; ++i) {
    manifest.starts[0].samples.push_back(7 * i);
    manifest.starts[0].steps.push_back(60);
  }
  for (std::size_t v = 0; v < variants; ++v) {
    const std::string name = "variant-" + std::to_string(v);
    manifest.variants.push_back({name, name, "", {{"output.steps", "false"}}, 0, nullptr});
  }
  return manifest;
}

nlohmann::ordered_json description() {
  return {{"effective", "schema: 1\n"},
          {"provenance",
           {{"host", "a"},
            {"cpu", "b"},
            {"threads", 1},
            {"jobs", 1},
            {"inputs_sha256", nlohmann::ordered_json::object()}}},
          {"name", "synthetic"},
          {"seed", 1},
          {"steps", false},
          {"map", {{"points", 1}, {"build_ms", 1.0}, {"index_ms", 1.0}}},
          {"peak_rss_mb", 100.0}};
}

void write_journals(const fs::path& folder, const Manifest& manifest) {
  const auto steps = steps_of(manifest);
  for (std::size_t k = 1; k <= shards; ++k) {
    Journal journal(journals_folder(folder), {k, shards}, 1);
    std::size_t variant = variants;
    for (const PlannedTrial& place : share_of(steps, {k, shards})) {
      const PlannedVariant& planned = manifest.variants[place.variant];
      if (place.variant != variant) journal.add_variant(planned.identity, description());
      variant = place.variant;
      const TrialOutput output = output_of_trial(place.trial);
      const TrialId id = manifest.id_of(variant, place.trial);
      journal.begin(id, {{"sample", place.trial}});
      journal.finish(id, 20.0, output);
    }
    journal.close();
  }
}

std::uintmax_t bytes_in(const fs::path& folder) {
  std::uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    bytes += entry.is_regular_file() ? entry.file_size() : 0;
  return bytes;
}

/// Journals of as many trials as the benchmark's argument says, read by `read` from their folder. Their
/// indexes are there where they are read.
template <class Read>
void with_journals(benchmark::State& state, JournalScan::Closed closed, const Read& read) {
  const test::TemporaryFolder folder;
  const auto trials = static_cast<std::size_t>(state.range(0));
  const Manifest manifest = manifest_of(trials);
  write_journals(folder.path(), manifest);
  const auto scan_all = [&] {
    return JournalScan(
        journals_folder(folder.path()), [](const std::string&) {}, closed);
  };
  if (closed == JournalScan::Closed::indexed) scan_all();
  for ([[maybe_unused]] auto _ : state) {
    read(manifest, scan_all(), folder.path());
  }
  state.counters["journal_bytes_per_trial"] =
      static_cast<double>(bytes_in(journals_folder(folder.path()))) / static_cast<double>(trials);
  state.counters["peak_mb"] = peak_rss_mb();
}

void status_of_all(benchmark::State& state) {
  with_journals(state, JournalScan::Closed::indexed,
                [](const Manifest& manifest, const JournalScan& scan, const fs::path& /*folder*/) {
                  benchmark::DoNotOptimize(status_of(manifest, scan));
                });
}

void merge_all(benchmark::State& state) {
  with_journals(state, JournalScan::Closed::whole,
                [&](const Manifest& manifest, const JournalScan& scan, const fs::path& folder) {
                  if (!merge_shards(manifest, scan, {folder / "merged"}).run.complete)
                    state.SkipWithError("trials are missing");
                });
}

void many_trials(benchmark::internal::Benchmark* b) {
  b->Arg(10'000)->Arg(100'000)->Arg(1'000'000)->Iterations(1)->Unit(benchmark::kMillisecond);
}
BENCHMARK(status_of_all)->Name("sharding/status/trials")->Apply(many_trials);
BENCHMARK(merge_all)->Name("sharding/merge/trials")->Apply(many_trials);

/// With the wait for the disk, beside the same bytes without it.
void note_trial(benchmark::State& state) {
  const test::TemporaryFolder folder;
  Journal journal(folder.path(), {1, 1}, 1);
  const TrialOutput output = output_of_trial(1);
  for ([[maybe_unused]] auto _ : state) journal.finish({1, 2}, 20.0, output);
}
BENCHMARK(note_trial)->Name("sharding/note_trial")->Unit(benchmark::kMicrosecond);

void text_of_trial(benchmark::State& state) {
  const TrialOutput output = output_of_trial(1);
  for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(to_json(output.entry).dump());
}
BENCHMARK(text_of_trial)->Name("sharding/text_of_trial")->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace glocal::bench

BENCHMARK_MAIN();
