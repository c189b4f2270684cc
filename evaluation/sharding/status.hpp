// How far all shards are.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "evaluation/results/journal_scan.hpp"
#include "evaluation/sharding/manifest.hpp"

namespace glocal {

struct VariantStatus {
  std::string name;
  std::size_t trials = 0;
  std::size_t done = 0;     ///< Those that have come to an end, of which …
  std::size_t right = 0;    ///< … so many declared the right pose, and …
  std::size_t wrong = 0;    ///< … so many a wrong one.
  std::size_t failed = 0;   ///< A strategy threw, or the process crashed each time.
  std::size_t running = 0;  ///< In shards that are at work.
  /// Not begun, or begun by a shard that is gone.
  [[nodiscard]] std::size_t missing() const { return trials - done - failed - running; }
};

struct SharedStatus {
  std::vector<VariantStatus> variants;
  std::size_t live_shards = 0;         ///< Processes that are at work.
  std::vector<std::string> silent;     ///< Journals of processes that have gone without a word.
  std::optional<double> seconds_left;  ///< None if nothing is at work, or nothing has come to an end yet.
  [[nodiscard]] VariantStatus total() const;
};

[[nodiscard]] SharedStatus status_of(const Manifest& manifest, const JournalScan& scan);

}  // namespace glocal
