#include "sources/register.hpp"

#include "sources/carmen_log.hpp"
#include "sources/log_map.hpp"

namespace glocal {

void register_sources(Catalog& catalog) {
  catalog.observation_sources.add<CarmenLog>("carmen_log", "A drive recorded as a CARMEN log.");
  catalog.map_sources.add<LogMap>("log_map", "A map from the reference poses of a CARMEN log.");
}

}  // namespace glocal
