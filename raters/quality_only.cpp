#include "raters/quality_only.hpp"

#include <algorithm>

#include "raters/cluster_quality.hpp"
#include "raters/normalise.hpp"

namespace glocal::raters {

void describe(ParamVisitor& v, QualityOnly::Params& p) {
  describe_cluster_quality(v, p.quality);
}

std::vector<Rating> QualityOnly::rate(const std::vector<Cluster>& clusters,
                                      const std::vector<Hypothesis>& hypotheses) {
  constexpr double least = 1e-6;  // r is above 0
  std::vector<Rating> ratings;
  for (const Cluster& cluster : clusters) {
    ratings.push_back({.r = std::max(least, cluster_score(cluster, hypotheses, params_.quality))});
  }
  normalise(ratings);
  return ratings;
}

}  // namespace glocal::raters
