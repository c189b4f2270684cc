#include "glocal/builtin.hpp"

#include "clustering/register.hpp"
#include "local_mappers/register.hpp"
#include "matchers/register.hpp"
#include "matchers/surfels/surfel_pair_registrar.hpp"
#include "raters/register.hpp"
#include "sources/register.hpp"
#include "verifiers/register.hpp"

namespace glocal {

void register_builtin_strategies(Catalog& catalog) {
  register_contact_indexes(catalog.contact_indexes);
  register_sources(catalog);
  register_local_mappers(catalog);
  register_matchers(catalog);
  register_clustering(catalog);
  register_raters(catalog);
  register_verifiers(catalog);
  catalog.cloud_registrars.add<surfels::SurfelPairRegistrar>(
      "surfel_pairs", "Pairs of surfels that are alike, judged by what each cloud saw through.",
      stable_since("0.1.0"));
}

}  // namespace glocal
