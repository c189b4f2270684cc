#include "evaluation/sharding/shares.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <queue>
#include <tuple>

namespace glocal {
namespace {

/// Numbers of the trials, the longest first.
std::vector<std::size_t> longest_first(const std::vector<std::size_t>& steps) {
  std::vector<std::size_t> order(steps.size());
  std::iota(order.begin(), order.end(), 0);
  std::ranges::stable_sort(order, std::greater<>(), [&](std::size_t i) { return steps[i]; });
  return order;
}

/// What a shard has: of this variant, of all, and which it is. The least one is served next.
using Load = std::tuple<std::size_t, std::size_t, std::size_t>;

}  // namespace

std::vector<PlannedTrial> share_of(const std::vector<std::vector<std::size_t>>& steps, const Shard& shard) {
  std::vector<std::size_t> all(shard.of, 0);  // Steps of each shard.
  std::vector<PlannedTrial> share;
  for (std::size_t variant = 0; variant < steps.size(); ++variant) {
    std::priority_queue<Load, std::vector<Load>, std::greater<>> loads;
    for (std::size_t k = 0; k < shard.of; ++k) loads.emplace(0, all[k], k);
    for (const std::size_t trial : longest_first(steps[variant])) {
      const auto [of_variant, of_all, k] = loads.top();
      loads.pop();
      all[k] += steps[variant][trial];
      loads.emplace(of_variant + steps[variant][trial], all[k], k);
      if (k + 1 == shard.number) share.push_back({variant, trial});
    }
  }
  std::ranges::sort(share);
  return share;
}

}  // namespace glocal
