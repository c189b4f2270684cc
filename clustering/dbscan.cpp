#include "clustering/dbscan.hpp"

#include "clustering/clusters_of.hpp"
#include "clustering/density_labels.hpp"

namespace glocal {

void describe(ParamVisitor& v, Dbscan::Params& p) {
  v.field("radius", p.radius,
          {.doc = "Hypotheses are near each other up to this distance (Eps) …", .unit = "m", .min = 0.001});
  v.field("radius_rotation_deg", p.radius_rotation_deg,
          {.doc = "… if they are turned by no more than this.", .unit = "deg", .min = 0.01, .max = 180.0});
  v.field("min_support", p.min_support,
          {.doc = "A hypothesis with so many near it, itself included, is a core of a cluster (MinPts).",
           .min = 1});
}

std::vector<Cluster> Dbscan::cluster(const std::vector<Hypothesis>& hypotheses, Rng& /*rng*/) {
  return clusters_of(hypotheses, density_labels(robot_poses(hypotheses), supports(hypotheses),
                                                {params_.radius, radians(params_.radius_rotation_deg)},
                                                params_.min_support));
}

}  // namespace glocal
