#include "matchers/register.hpp"

#include "matchers/grid_search/branch_and_bound.hpp"
#include "matchers/grid_search/exhaustive.hpp"
#include "matchers/grid_search/upright_branch_and_bound.hpp"
#include "matchers/indexed_ransam/indexed_ransam.hpp"
#include "matchers/iransac/iransac.hpp"
#include "matchers/mcl/mcl.hpp"
#include "matchers/ransac/ransac.hpp"
#include "matchers/ransam/ransam.hpp"
#include "matchers/ransam/triangle_ransam.hpp"
#include "matchers/surfel_ransam/surfel_ransam.hpp"

namespace glocal {

void register_matchers(Catalog& catalog) {
  catalog.matchers.add<grid_search::BranchAndBound>(
      "branch_and_bound", "Exact search of a grid of poses, by upper bounds for whole blocks of them.",
      stable_since("0.1.0"));
  catalog.matchers.add<grid_search::Exhaustive>("exhaustive", "Every pose of a grid, each judged by eq. 4.",
                                                stable_since("0.1.0"),
                                                {.contact = ContactChoice(catalog.contact_indexes)});
  catalog.matchers.add<indexed_ransam::IndexedRansam>(
      "indexed_ransam",
      "Random sample matching of oriented point pairs over an index of the "
      "map; refined, carried on, checked by beams.",
      stable_since("0.1.0"));
  catalog.matchers.add<iransac::IRansac>(
      "iransac", "Incremental, preemptive random sample consensus over features of the map, hashed or not.",
      stable_since("0.1.0"));
  catalog.matchers.add<mcl::Mcl>(
      "mcl", "Monte Carlo localization: a particle filter, as AMCL is; the local map is not looked at.",
      stable_since("0.1.0"));
  catalog.matchers.add<ransac::Ransac>(
      "ransac", "Random sample consensus of pairs of points, without any table.", stable_since("0.1.0"));
  catalog.matchers.add<ransam::Ransam>(
      "ransam", "Random sample matching of triangles over a hash table (Section II, eq. 1-5).",
      stable_since("0.1.0"), {.triples = {.contact = ContactChoice(catalog.contact_indexes)}});
  catalog.matchers.add<surfel_ransam::SurfelRansam>(
      "surfel_ransam",
      "Random sample matching of pairs of surfels over an index of the map in "
      "space; refined, carried on, checked by what the scan looked through.",
      stable_since("0.1.0"));
  catalog.matchers.add<ransam::TriangleRansam>(
      "triangle_ransam",
      "Random sample matching of triangles in space over a hash table, as ransam's in the plane.",
      experimental_since("0.1.0"));
  catalog.matchers.add<grid_search::UprightBranchAndBound>(
      "upright_branch_and_bound",
      "Exact search of a grid of upright poses, as branch_and_bound's of the plane.", stable_since("0.1.0"));
  catalog.matchers.note_counterparts("branch_and_bound", "upright_branch_and_bound");
  catalog.matchers.note_counterparts("indexed_ransam", "surfel_ransam");
  catalog.matchers.note_counterparts("ransam", "triangle_ransam");
}

}  // namespace glocal
