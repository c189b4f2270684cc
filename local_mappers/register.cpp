#include "local_mappers/register.hpp"

#include "local_mappers/bounded.hpp"
#include "local_mappers/keyframes.hpp"
#include "local_mappers/lidar_odometry.hpp"
#include "local_mappers/odometry.hpp"
#include "local_mappers/scan_matching.hpp"

namespace glocal {

void register_local_mappers(Catalog& catalog) {
  catalog.local_mappers.add<ScanMatching>(
      "scan_matching",
      "Searches around odometry, then refines point to line against the map of all scans so far.");
  catalog.local_mappers.add<Bounded>("bounded",
                                     "Scan matching against a map of the last scans or metres only.");
  catalog.local_mappers.add<Keyframes>("keyframes",
                                       "Scan matching that registers only scans that bring something new.");
  catalog.local_mappers.note_renamed("key_frames", "keyframes");
  catalog.local_mappers.add<Odometry>("odometry", "Scans joined by odometry alone.");
  catalog.local_mappers.add<LidarOdometry>(
      "lidar_odometry",
      "Scans in space, each registered to the surfaces seen before; as KISS-ICP, but to planes.");
}

}  // namespace glocal
