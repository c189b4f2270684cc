#include "local_mappers/deskew.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace glocal::local_mappers {

std::optional<Scan> deskewed(const Scan& scan, const SteadyMotion& motion) {
  if (scan.times.empty()) return std::nullopt;
  const auto [earliest, latest] = std::minmax_element(scan.times.begin(), scan.times.end());
  const double farthest = std::max(std::abs(double{*earliest}), std::abs(double{*latest}));
  if (!(farthest <= 2.0 * motion.seconds)) return std::nullopt;
  const Pose3 now_from_last = inverse(motion.last_from_now);
  const Vector3 turn = logarithm(now_from_last.rotation);
  Scan still{{}, scan.free_ends, scan.origin};
  still.hits.reserve(scan.hits.size());
  Pose3 now_from_then;
  float time = 0.0F;
  for (std::size_t i = 0; i < scan.hits.size(); ++i) {
    // All beams of a lidar are measured at once: many hits have the same time.
    if (scan.times[i] != time) {
      time = scan.times[i];
      const double share = -time / motion.seconds;
      now_from_then = {share * now_from_last.translation(), exponential(share * turn)};
    }
    still.hits.push_back(as_point(now_from_then * as_vector(scan.hits[i])));
  }
  return still;
}

}  // namespace glocal::local_mappers
