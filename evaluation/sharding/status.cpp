#include "evaluation/sharding/status.hpp"

#include <algorithm>

namespace glocal {
namespace {

/// What trials of a variant have taken so far.
struct Cost {
  double ms = 0.0;
  std::size_t trials = 0;
};

/// What is left takes as long as what is done has, trial by trial of the same variant, or of any where none
/// of it is done. None if nothing is.
std::optional<double> ms_left(const std::vector<VariantStatus>& variants, const std::vector<Cost>& costs) {
  Cost all;
  for (const Cost& cost : costs) {
    all.ms += cost.ms;
    all.trials += cost.trials;
  }
  if (all.trials == 0) return std::nullopt;
  double left = 0.0;
  for (std::size_t i = 0; i < variants.size(); ++i) {
    const Cost& cost = costs[i].trials > 0 ? costs[i] : all;
    // Running ones are half done on average.
    const double trials =
        static_cast<double>(variants[i].missing()) + 0.5 * static_cast<double>(variants[i].running);
    left += trials * cost.ms / static_cast<double>(cost.trials);
  }
  return left;
}

}  // namespace

VariantStatus SharedStatus::total() const {
  VariantStatus total{"all"};
  for (const VariantStatus& v : variants) {
    total.trials += v.trials;
    total.done += v.done;
    total.right += v.right;
    total.wrong += v.wrong;
    total.failed += v.failed;
    total.running += v.running;
  }
  return total;
}

SharedStatus status_of(const Manifest& manifest, const JournalScan& scan) {
  SharedStatus status;
  std::size_t at_work = 0;
  for (const JournalScan::Journal& journal : scan.journals()) {
    if (journal.is_live) {
      ++status.live_shards;
      at_work += journal.jobs;
    } else if (!journal.is_closed) {
      status.silent.push_back(journal.file.filename());
    }
  }
  std::vector<Cost> costs(manifest.variants.size());
  for (std::size_t v = 0; v < manifest.variants.size(); ++v) {
    VariantStatus variant{manifest.variants[v].name, manifest.starts_of(v).samples.size()};
    for (std::size_t trial = 0; trial < variant.trials; ++trial) {
      const TrialId id = manifest.id_of(v, trial);
      const auto finished = scan.finished().find(id);
      const auto begun = scan.begun().find(id);
      if (finished != scan.finished().end()) {
        const Outcome outcome = finished->second.outcome;
        if (outcome == Outcome::failed) {
          ++variant.failed;
          continue;
        }
        ++variant.done;
        variant.right += outcome == Outcome::right ? 1 : 0;
        variant.wrong += outcome == Outcome::wrong ? 1 : 0;
        costs[v].ms += finished->second.ms;
        ++costs[v].trials;
      } else if (scan.is_given_up(id)) {
        ++variant.failed;
      } else if (begun != scan.begun().end() && scan.journals()[begun->second.journal].is_live) {
        ++variant.running;
      }
    }
    status.variants.push_back(std::move(variant));
  }
  const auto left = ms_left(status.variants, costs);
  if (left && at_work > 0) status.seconds_left = *left / 1000.0 / static_cast<double>(at_work);
  return status;
}

}  // namespace glocal
