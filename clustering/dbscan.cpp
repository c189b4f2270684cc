#include "clustering/dbscan.hpp"

#include "clustering/density_labels.hpp"
#include "glocal/clusters_of.hpp"

namespace glocal::clustering {

void describe(ParamVisitor& v, Dbscan::Params& p) {
  v.field("radius", p.radius,
          {.doc = "Hypotheses can be near each other only up to this distance (Eps).",
           .unit = "m",
           .min = 0.001,
           .audience = Audience::tuner});
  v.field("radius_rotation_deg", p.radius_rotation_deg,
          {.doc = "Hypotheses can be near each other only if they are turned by no more than this.",
           .unit = "deg",
           .min = 0.01,
           .max = 180.0,
           .audience = Audience::tuner});
  v.field(
      "min_support", p.min_support,
      {.doc =
           "A hypothesis is a core of a cluster if so many hypotheses are near it, itself included (MinPts).",
       .min = 1});
}

std::vector<Cluster> Dbscan::cluster(const std::vector<Hypothesis>& hypotheses, Rng& /*rng*/) {
  const auto labels = [&](const auto& poses) {
    return density_labels(poses, supports(hypotheses), {params_.radius, radians(params_.radius_rotation_deg)},
                          params_.min_support);
  };
  return clusters_of(hypotheses, are_planar(hypotheses) ? labels(robot_poses<Pose2>(hypotheses))
                                                        : labels(robot_poses<Pose3>(hypotheses)));
}

}  // namespace glocal::clustering
