#include "local_mappers/register.hpp"

#include "local_mappers/bounded.hpp"
#include "local_mappers/keyframes.hpp"
#include "local_mappers/lidar_odometry.hpp"
#include "local_mappers/odometry.hpp"
#include "local_mappers/scan_matching.hpp"

namespace glocal {

void register_local_mappers(Catalog& catalog) {
  catalog.local_mappers.add<local_mappers::ScanMatching>(
      "scan_matching",
      "Searches around odometry, then refines point to line against the map of all scans so far.",
      stable_since("0.1.0"));
  catalog.local_mappers.add<local_mappers::Bounded>(
      "bounded", "Scan matching against a map of the last scans or metres only.", stable_since("0.1.0"));
  catalog.local_mappers.add<local_mappers::Keyframes>(
      "keyframes", "Scan matching that registers only scans that bring something new.",
      stable_since("0.1.0"));
  catalog.local_mappers.note_renamed("key_frames", "keyframes");
  catalog.local_mappers.add<local_mappers::Odometry>("odometry", "Scans joined by odometry alone.",
                                                     stable_since("0.1.0"));
  catalog.local_mappers.add<local_mappers::LidarOdometry>(
      "lidar_odometry",
      "Scans in space, each registered to the surfaces seen before; as KISS-ICP, but to planes.",
      stable_since("0.1.0"));
}

}  // namespace glocal
