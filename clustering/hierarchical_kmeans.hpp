#pragma once

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::clustering {

/// Hierarchical K-means over robot poses (Section III-A of the paper, eq. 6): starts with one cluster of all
/// hypotheses and splits in two whatever is spread too widely. Clusters come in the order of the split tree,
/// left before right.
class HierarchicalKmeans final : public Clusterer {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    double max_variance_translation = 0.0030;
    double max_variance_rotation_deg2 = 50.0;
  };

  explicit HierarchicalKmeans(const Params& params) : params_(params) {}
  [[nodiscard]] std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses, Rng& rng) override;

 private:
  Params params_;
};
void describe(ParamVisitor& v, HierarchicalKmeans::Params& p);

}  // namespace glocal::clustering
