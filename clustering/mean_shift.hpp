#pragma once

#include <string>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::clustering {

/// Mean shift over robot poses (Comaniciu and Meer 2002): each hypothesis climbs to a mode of the density of
/// all, weighted with support, by moving to their kernel-weighted mean again and again; hypotheses that end
/// nearer to each other than the bandwidths, and so on, are one cluster. Unlike with dbscan, two maxima with
/// a bridge between them stay two.
///
/// On SE(2) and SE(3) a distance is translation and rotation in units of their bandwidths, squared and added
/// up; means are taken of rotations from where the hypothesis is. Hypotheses within the same cell of a
/// quarter of the bandwidths climb together, from their mean.
class MeanShift final : public Clusterer {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    std::string kernel = "gaussian";
    double bandwidth = 0.15;
  };

  explicit MeanShift(const Params& params) : params_(params) {}
  [[nodiscard]] std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses, Rng& rng) override;

 private:
  Params params_;
};
void describe(ParamVisitor& v, MeanShift::Params& p);

}  // namespace glocal::clustering
