#include "evaluation/sweeps/chance.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <utility>

#include "evaluation/statistics/statistics.hpp"
#include "glocal/rng.hpp"

namespace glocal {
namespace {

constexpr std::uint64_t exchange_seed = 1;
constexpr std::size_t most_resamples = 2000, fewest_resamples = 200;
/// Outcomes exchanged in all: a second's work.
constexpr std::size_t most_exchanges = 100'000'000;

long best_of(const std::vector<long>& totals) {
  return *std::max_element(totals.begin(), totals.end());
}

void add(const ScoresAtPlace& scores, std::vector<long>& totals) {
  for (std::size_t i = 0; i < scores.size(); ++i) totals[i] += scores[i];
}

/// Fisher's and Yates' shuffle.
void shuffle(ScoresAtPlace& scores, Rng& rng) {
  for (std::size_t i = scores.size(); i > 1; --i)
    std::swap(scores[i - 1], scores[rng.below(static_cast<std::uint32_t>(i))]);
}

}  // namespace

std::optional<ChanceOfBest> chance_of_best(const std::vector<ScoresAtPlace>& places, std::size_t trials) {
  if (places.empty() || places.front().size() < 2) return std::nullopt;
  const std::size_t settings = places.front().size();
  std::vector<long> totals(settings);
  // Where all settings end the same there is nothing to exchange.
  std::vector<ScoresAtPlace> differing;
  std::vector<long> same(settings);
  for (const ScoresAtPlace& scores : places) {
    add(scores, totals);
    const bool differs =
        std::any_of(scores.begin(), scores.end(), [&](int score) { return score != scores.front(); });
    if (differs) {
      differing.push_back(scores);
    } else {
      add(scores, same);
    }
  }
  const auto n = static_cast<double>(trials);
  const long sum = std::accumulate(totals.begin(), totals.end(), 0L);
  const double all = static_cast<double>(sum) / static_cast<double>(settings);
  const auto lead_of = [&](long best) { return (static_cast<double>(best) - all) / n; };

  ChanceOfBest chance{.settings = settings, .places = places.size(), .lead = lead_of(best_of(totals))};
  const std::size_t work = std::max<std::size_t>(differing.size() * settings, 1);
  chance.resamples = std::clamp(most_exchanges / work, fewest_resamples, most_resamples);
  const long best = best_of(totals);
  std::size_t as_good = 1;
  std::vector<double> leads;
  Rng rng(exchange_seed);
  for (std::size_t k = 0; k < chance.resamples; ++k) {
    totals = same;
    for (ScoresAtPlace& scores : differing) {
      shuffle(scores, rng);
      add(scores, totals);
    }
    const long exchanged = best_of(totals);
    as_good += exchanged >= best ? 1 : 0;
    leads.push_back(lead_of(exchanged));
  }
  chance.expected = mean(leads);
  chance.high = quantile(leads, 0.95);
  chance.share = static_cast<double>(as_good) / static_cast<double>(chance.resamples + 1);
  return chance;
}

}  // namespace glocal
