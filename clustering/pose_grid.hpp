#pragma once

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::clustering {

/// Robot poses in the same cell of a grid over x, y and heading are one cluster; with `joined`, so are those
/// in cells that share a face, an edge or a corner, and so on. Takes time for sorting only. Without joining,
/// the poses around one place may fall into up to eight cells.
class PoseGridClusterer final : public Clusterer {
 public:
  struct Params {
    double cell = 0.25;
    double cell_rotation_deg = 15.0;
    bool joined = false;
  };

  explicit PoseGridClusterer(const Params& params) : params_(params) {}
  [[nodiscard]] std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses, Rng& rng) override;

 private:
  Params params_;
};
void describe(ParamVisitor& v, PoseGridClusterer::Params& p);

}  // namespace glocal::clustering
