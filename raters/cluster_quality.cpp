#include "raters/cluster_quality.hpp"

#include <algorithm>

#include "raters/mean_score.hpp"

namespace glocal::raters {

void describe_cluster_quality(ParamVisitor& v, std::string& quality) {
  v.field("quality", quality,
          {.doc = "Score of a cluster: that of its best hypothesis, or their mean weighted with support.",
           .choices = {"best", "mean"}});
}

double cluster_score(const Cluster& cluster, const std::vector<Hypothesis>& hypotheses,
                     const std::string& quality) {
  if (quality == "mean") return std::clamp(mean_score(hypotheses, cluster.members), 0.0, 1.0);
  double best = 0.0;
  for (const std::size_t i : cluster.members) best = std::max(best, hypotheses[i].score);
  return std::min(best, 1.0);
}

}  // namespace glocal::raters
