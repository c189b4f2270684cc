#include "local_mappers/register.hpp"

#include "local_mappers/scan_matching.hpp"

namespace glocal {

void register_local_mappers(Catalog& catalog) {
  catalog.local_mappers.add<ScanMatching>(
      "scan_matching",
      "Searches around odometry, then refines point to line against the map of all scans so far.");
}

}  // namespace glocal
