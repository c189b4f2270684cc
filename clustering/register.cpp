#include "clustering/register.hpp"

#include "clustering/dbscan.hpp"
#include "clustering/hierarchical_kmeans.hpp"
#include "clustering/mean_shift.hpp"
#include "clustering/pose_grid.hpp"

namespace glocal {

void register_clustering(Catalog& catalog) {
  catalog.clusterers.add<clustering::HierarchicalKmeans>(
      "hierarchical_kmeans",
      "Splits in two, again and again, what is spread too widely (Section III-A, eq. 6).",
      stable_since("0.1.0"));
  catalog.clusterers.add<clustering::Dbscan>(
      "dbscan", "Joins what has enough others near it, in clusters of any shape.",
      experimental_since("0.1.0"));
  catalog.clusterers.add<clustering::MeanShift>(
      "mean_shift", "Joins what climbs to the same maximum of density.", experimental_since("0.1.0"));
  catalog.clusterers.add<clustering::PoseGridClusterer>(
      "pose_grid", "Joins what lies in the same cell of a grid of poses.", experimental_since("0.1.0"));
}

}  // namespace glocal
