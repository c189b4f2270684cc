#include "clustering/pose_grid.hpp"

#include "clustering/disjoint_sets.hpp"
#include "glocal/clusters_of.hpp"
#include "glocal/pose_cells.hpp"

namespace glocal::clustering {

void describe(ParamVisitor& v, PoseGridClusterer::Params& p) {
  v.field("cell", p.cell,
          {.doc = "Side of a cell; its multiples are borders.",
           .unit = "m",
           .min = 0.001,
           .audience = Audience::tuner});
  v.field("cell_rotation_deg", p.cell_rotation_deg,
          {.doc = "Largest width of a cell in heading: a full turn is cut into equal parts, of which the "
                  "first is centred at 0.",
           .unit = "deg",
           .min = 0.01,
           .max = 360.0});
  v.field("joined", p.joined,
          {.doc = "Whether cells that touch, directly or through others, are one cluster.",
           .audience = Audience::tuner});
}

std::vector<Cluster> PoseGridClusterer::cluster(const std::vector<Hypothesis>& hypotheses, Rng& /*rng*/) {
  const std::vector<Pose2> poses = robot_poses<Pose2>(hypotheses);
  const PoseCells cells(poses, {params_.cell, parts_of_a_turn(radians(params_.cell_rotation_deg))});
  DisjointSets sets(cells.size());
  for (std::size_t c = 0; params_.joined && c < cells.size(); ++c) {
    cells.visit_near(cells.cell(c), 1, 1, [&](std::size_t other) {
      sets.unite(c, other);
      return true;
    });
  }
  std::vector<std::size_t> labels(hypotheses.size());
  for (std::size_t c = 0; c < cells.size(); ++c) {
    for (const std::size_t i : cells.members(c)) labels[i] = sets.find(c);
  }
  return clusters_of(hypotheses, labels);
}

}  // namespace glocal::clustering
