#include "evaluation/sweeps/leads.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/statistics/hypothesis_tests.hpp"
#include "glocal/rng.hpp"

namespace glocal {
namespace {

constexpr std::uint64_t sign_seed = 1;
constexpr std::size_t most_resamples = 5000, fewest_resamples = 500;
/// Signs given in all: a second's work.
constexpr std::size_t most_signs = 200'000'000;

/// What a setting differs by from the baseline, where it does.
struct Differences {
  std::size_t setting = 0;
  std::vector<std::pair<std::size_t, int>> at;  ///< Places.
  double spread = 0.0;                          ///< Standard deviation of the sum with random signs.

  /// Sum with these signs, as a multiple of the spread.
  [[nodiscard]] double size(const std::vector<int>& signs) const {
    long sum = 0;
    for (const auto& [place, difference] : at) sum += long{signs[place]} * difference;
    return static_cast<double>(std::labs(sum)) / spread;
  }
};

Differences differences_of(std::size_t setting, std::size_t baseline,
                           const std::vector<ScoresAtPlace>& places) {
  Differences differences{setting, {}, 0.0};
  double squares = 0.0;
  for (std::size_t place = 0; place < places.size(); ++place) {
    const int difference = places[place][setting] - places[place][baseline];
    if (difference == 0) continue;
    differences.at.emplace_back(place, difference);
    squares += static_cast<double>(difference) * difference;
  }
  differences.spread = std::sqrt(squares);
  return differences;
}

/// For each of these, how often the largest of all is at least as large with random signs.
std::vector<double> p_of_largest(const std::vector<Differences>& family, std::size_t places) {
  std::size_t work = 1;
  for (const Differences& differences : family) work += differences.at.size();
  const std::size_t resamples = std::clamp(most_signs / work, fewest_resamples, most_resamples);
  std::vector<int> signs(places, 1);
  std::vector<double> observed;
  for (const Differences& differences : family) observed.push_back(differences.size(signs));
  std::vector<std::size_t> as_large(family.size(), 1);
  Rng rng(sign_seed);
  constexpr double same = 1.0 - 1e-12;
  for (std::size_t k = 0; k < resamples; ++k) {
    for (int& sign : signs) sign = (rng.next() >> 63U) != 0 ? 1 : -1;
    double largest = 0.0;
    for (const Differences& differences : family) largest = std::max(largest, differences.size(signs));
    for (std::size_t i = 0; i < family.size(); ++i) as_large[i] += largest >= same * observed[i] ? 1 : 0;
  }
  std::vector<double> p;
  for (const std::size_t n : as_large)
    p.push_back(static_cast<double>(n) / static_cast<double>(resamples + 1));
  return p;
}

}  // namespace

Lead lead_of(std::size_t setting, std::size_t other, const std::vector<ScoresAtPlace>& places) {
  Lead lead;
  std::vector<long> differences;
  for (const ScoresAtPlace& scores : places) {
    const int difference = scores[setting] - scores[other];
    differences.push_back(difference);
    lead.places_better += difference > 0 ? 1 : 0;
    lead.places_worse += difference < 0 ? 1 : 0;
  }
  const SignFlips test = sign_flip_test(differences);
  lead.score = test.sum;
  lead.p = test.p;
  return lead;
}

std::vector<Lead> leads_over(std::size_t baseline, const std::vector<ScoresAtPlace>& places) {
  std::vector<Lead> leads;
  std::vector<Differences> family;
  const std::size_t settings = places.empty() ? 0 : places.front().size();
  for (std::size_t setting = 0; setting < settings; ++setting) {
    leads.push_back(lead_of(setting, baseline, places));
    Differences differences = differences_of(setting, baseline, places);
    if (least_p(differences.at.size()) < significance) family.push_back(std::move(differences));
  }
  // One alone is tested exactly.
  if (family.size() < 2) return leads;
  const std::vector<double> p = p_of_largest(family, places.size());
  for (std::size_t i = 0; i < family.size(); ++i)
    leads[family[i].setting].p = std::max(leads[family[i].setting].p, p[i]);
  return leads;
}

}  // namespace glocal
