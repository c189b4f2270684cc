#include "clustering/register.hpp"

#include "clustering/hierarchical_kmeans.hpp"

namespace glocal {

void register_clustering(Catalog& catalog) {
  catalog.clusterers.add<HierarchicalKmeans>(
      "hierarchical_kmeans",
      "Splits in two, again and again, what is spread too widely (Section III-A, eq. 6).");
}

}  // namespace glocal
