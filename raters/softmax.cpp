#include "raters/softmax.hpp"

#include <cmath>

#include "raters/cluster_quality.hpp"
#include "raters/normalise.hpp"

namespace glocal::raters {

void describe(ParamVisitor& v, Softmax::Params& p) {
  v.field("beta", p.beta,
          {.doc = "By how much a difference in score counts: a cluster better by 1 / beta weighs e times as "
                  "much. 0: all alike.",
           .min = 0.0,
           .max = 500.0});
  describe_cluster_quality(v, p.quality);
}

std::vector<Rating> Softmax::rate(const std::vector<Cluster>& clusters,
                                  const std::vector<Hypothesis>& hypotheses) {
  std::vector<Rating> ratings;
  for (const Cluster& cluster : clusters) {
    const double score = cluster_score(cluster, hypotheses, params_.quality);
    ratings.push_back({.r = std::exp(params_.beta * (score - 1.0))});
  }
  normalise(ratings);
  return ratings;
}

}  // namespace glocal::raters
