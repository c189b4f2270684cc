// What shards leave in a folder: the manifest, and lines of a journal behind their checksums.
#include <sstream>

#include "evaluation/sharding/merge.hpp"
#include "evaluation/sharding/status.hpp"
#include "fuzz/harness.hpp"

extern "C" int fuzz_shards(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto parts = fuzz::parts(fuzz::text_of(data, size), 2);
  std::string journal;
  std::istringstream lines(parts[1]);
  for (std::string line; std::getline(lines, line);) journal += checksum(line) + " " + line + "\n";
  const auto folder = fuzz::write(".shards/manifest.json", parts[0]).parent_path().parent_path();
  fuzz::write(".shards/journals/a.jsonl", journal);
  return fuzz::answer([&] {
    const Manifest manifest = read_manifest(folder);
    const JournalScan scan(journals_folder(folder), [](const std::string&) {});
    const VariantStatus all = status_of(manifest, scan).total();
    fuzz::must_hold(all.trials == manifest.count_trials(), "trials are lost");
    const auto out = folder / "merged";
    std::filesystem::remove_all(out);
    const MergeResult result = merge_shards(manifest, scan, {out});
    fuzz::must_hold(result.run.complete == (all.done + all.failed == all.trials),
                    "status and merge do not agree on what is missing");
  });
}
