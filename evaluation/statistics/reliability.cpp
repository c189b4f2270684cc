#include "evaluation/statistics/reliability.hpp"

#include <algorithm>

namespace glocal {

void Reliability::add(double confidence, bool is_right) {
  const auto* const above = std::upper_bound(edges.begin() + 1, edges.end() - 1, confidence);
  Sums& sums = sums_[static_cast<std::size_t>(above - edges.begin()) - 1];
  ++sums.count;
  sums.right += is_right ? 1 : 0;
  sums.confidence += confidence;
}

std::vector<Reliability::Bin> Reliability::bins() const {
  std::vector<Bin> bins;
  for (std::size_t i = 0; i < sums_.size(); ++i) {
    const Sums& sums = sums_[i];
    if (sums.count == 0) continue;
    bins.push_back({edges[i], edges[i + 1], sums.confidence / static_cast<double>(sums.count), sums.count,
                    wilson(sums.right, sums.count)});
  }
  return bins;
}

}  // namespace glocal
