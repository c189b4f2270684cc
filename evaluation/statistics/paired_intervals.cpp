#include "evaluation/statistics/paired_intervals.hpp"

#include <algorithm>
#include <boost/math/distributions/normal.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <utility>

#include "evaluation/statistics/statistics.hpp"

namespace glocal {
namespace {

double normal_quantile(double p) {
  return boost::math::quantile(boost::math::normal(), p);
}

/// Sums over places of one stratum, from which follow the mean difference of a trial and its variance.
struct StratumSums {
  double places = 0.0, sum = 0.0, trials = 0.0;
  double squares = 0.0, products = 0.0, squared_trials = 0.0;

  void add(double place_sum, double place_trials) {
    places += 1.0;
    sum += place_sum;
    trials += place_trials;
    squares += place_sum * place_sum;
    products += place_sum * place_trials;
    squared_trials += place_trials * place_trials;
  }

  /// Variance of the sum of what places have beyond that mean; about their own mean where there are several.
  [[nodiscard]] double variance(double mean) const {
    const double about_mean = squares - 2.0 * mean * products + mean * mean * squared_trials;
    if (places < 2.0) return std::max(0.0, about_mean);
    const double excess = sum - mean * trials;
    return std::max(0.0, about_mean - excess * excess / places) * places / (places - 1.0);
  }
};

struct MeanAndError {
  double mean = 0.0, error = 0.0;
};
MeanAndError mean_of(const std::vector<StratumSums>& strata) {
  double sum = 0.0, trials = 0.0, variance = 0.0;
  for (const StratumSums& s : strata) {
    sum += s.sum;
    trials += s.trials;
  }
  for (const StratumSums& s : strata) variance += s.variance(sum / trials);
  return {sum / trials, std::sqrt(variance) / trials};
}

std::vector<std::vector<PlaceSum>> by_stratum(const std::vector<PlaceSum>& places) {
  std::vector<std::vector<PlaceSum>> strata;
  for (const PlaceSum& place : places) {
    if (place.stratum >= strata.size()) strata.resize(place.stratum + 1);
    strata[place.stratum].push_back(place);
  }
  std::erase_if(strata, [](const auto& stratum) { return stratum.empty(); });
  return strata;
}

std::size_t count_resamples(std::size_t places) {
  constexpr std::size_t most_draws = 4'000'000, most = 4000, fewest = 400;
  return std::clamp(most_draws / places, fewest, most);
}

}  // namespace

Interval interval_of_shares(const std::vector<PlaceOutcomes>& places) {
  double first = 0.0, second = 0.0, trials = 0.0, filled = 0.0, most = 0.0;
  std::vector<StratumSums> strata;
  for (const PlaceOutcomes& place : places) {
    const auto a = static_cast<double>(place.only_first);
    const auto b = static_cast<double>(place.only_second);
    const auto n = static_cast<double>(place.trials);
    first += a;
    second += b;
    trials += n;
    filled += n > 0.0 ? 1.0 : 0.0;
    most = std::max(most, n);
    if (place.stratum >= strata.size()) strata.resize(place.stratum + 1);
    strata[place.stratum].add(b - a, n);
  }
  if (trials == 0.0) return {-1.0, 1.0};
  const double mean = (second - first) / trials;
  const double if_independent = first + second - trials * mean * mean;
  double alike = trials / filled;  // Trials that tell as much as one.
  if (if_independent > 0.0) {
    double variance = 0.0;
    for (const StratumSums& s : strata) variance += s.variance(mean);
    alike = std::clamp(variance / if_independent, 1.0, most);
  }
  const double n = trials / alike + 2.0;
  const double p = (first / alike + 1.0) / n;
  const double q = (second / alike + 1.0) / n;
  const double half = normal_quantile(0.975) * std::sqrt((p + q - (q - p) * (q - p)) / n);
  return {std::max(-1.0, q - p - half), std::min(1.0, q - p + half)};
}

Interval interval_of_mean(const std::vector<PlaceSum>& places, Rng rng) {
  const std::vector<std::vector<PlaceSum>> strata = by_stratum(places);
  std::vector<StratumSums> sums(strata.size());
  const auto fill = [&](const auto& place_at) {
    for (std::size_t s = 0; s < strata.size(); ++s) {
      sums[s] = {};
      for (std::size_t i = 0; i < strata[s].size(); ++i) {
        const PlaceSum& place = strata[s][place_at(s, i)];
        sums[s].add(place.sum, static_cast<double>(place.trials));
      }
    }
    return mean_of(sums);
  };
  const MeanAndError found = fill([](std::size_t, std::size_t i) { return i; });
  // Resamples of few places may hold next to nothing but equal ones; their error would be none.
  constexpr double least_share = 0.3;
  const double least_error = least_share * found.error;
  std::vector<double> excesses(count_resamples(places.size()), 0.0);
  for (double& excess : excesses) {
    const MeanAndError resample = fill([&](std::size_t s, std::size_t /*i*/) {
      return rng.below(static_cast<std::uint32_t>(strata[s].size()));
    });
    if (found.error > 0.0 && std::isfinite(found.error))
      excess = (resample.mean - found.mean) / std::max(least_error, resample.error);
  }
  const boost::math::students_t student(static_cast<double>(places.size() - 1));
  const double least = boost::math::quantile(student, 0.975);
  return {found.mean - std::max(quantile(excesses, 0.975), least) * found.error,
          found.mean - std::min(quantile(std::move(excesses), 0.025), -least) * found.error};
}

double places_to_find(double difference, std::size_t places, const Interval& interval) {
  const double z = normal_quantile(0.975);
  const double error = (interval.high - interval.low) / (2.0 * z);
  const double ratio = (z + normal_quantile(0.8)) * error / difference;
  return std::ceil(static_cast<double>(places) * ratio * ratio);
}

}  // namespace glocal
