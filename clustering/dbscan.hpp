#pragma once

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::clustering {

/// DBSCAN over robot poses (Ester et al. 1996): clusters of any shape and number, made of hypotheses that
/// have enough others near them, near in translation and in rotation. Support counts as so many hypotheses.
/// What the paper calls noise, a hypothesis near no cluster, is a cluster of its own here.
class Dbscan final : public Clusterer {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    double radius = 0.1;
    double radius_rotation_deg = 5.0;
    int min_support = 4;
  };

  explicit Dbscan(const Params& params) : params_(params) {}
  [[nodiscard]] std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses, Rng& rng) override;

 private:
  Params params_;
};
void describe(ParamVisitor& v, Dbscan::Params& p);

}  // namespace glocal::clustering
