#include "glocal/beams.hpp"

#include "glocal/evenly.hpp"

namespace glocal {

std::vector<Beam> some_beams(const Scan& scan, std::size_t most) {
  const std::size_t hits = scan.hits.size();
  const std::size_t all = hits + scan.free_ends.size();
  std::vector<Beam> beams;
  for (const std::size_t i : evenly_chosen(all, most)) {
    const bool is_hit = i < hits;
    beams.push_back({is_hit ? scan.hits[i] : scan.free_ends[i - hits], is_hit});
  }
  return beams;
}

}  // namespace glocal
