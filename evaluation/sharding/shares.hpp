// Which trials a shard runs.
#pragma once

#include <compare>
#include <cstddef>
#include <vector>

namespace glocal {

/// One of `of` shards, counted from 1.
struct Shard {
  std::size_t number = 1;
  std::size_t of = 1;
};

/// A trial of an experiment, by the places of its variant and of its start.
struct PlannedTrial {
  std::size_t variant = 0;
  std::size_t trial = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr)
  friend auto operator<=>(const PlannedTrial&, const PlannedTrial&) = default;
};

/// The trials of a shard, by variant and trial; `steps[v][t]` is how long a trial may take. Each trial is in
/// one shard. The trials of a variant are dealt from the longest to the shortest, each to the shard that has
/// the least of this variant so far, then the least of all: variants may differ in what a step costs.
[[nodiscard]] std::vector<PlannedTrial> share_of(const std::vector<std::vector<std::size_t>>& steps,
                                                 const Shard& shard);

}  // namespace glocal
