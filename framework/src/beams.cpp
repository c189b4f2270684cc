#include "glocal/beams.hpp"

#include <algorithm>

namespace glocal {

std::vector<Beam> some_beams(const Scan& scan, std::size_t most) {
  const std::size_t hits = scan.hits.size();
  const std::size_t all = hits + scan.free_ends.size();
  const std::size_t n = std::min(all, most);
  std::vector<Beam> beams;
  beams.reserve(n);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = k * all / n;
    const bool is_hit = i < hits;
    beams.push_back({is_hit ? scan.hits[i] : scan.free_ends[i - hits], is_hit});
  }
  return beams;
}

}  // namespace glocal
