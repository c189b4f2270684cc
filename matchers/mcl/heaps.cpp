#include "matchers/mcl/heaps.hpp"

#include <algorithm>
#include <cstdint>
#include <unordered_map>

namespace glocal {

std::vector<Heap> heaps_of(const std::vector<Pose2>& particles, const std::vector<double>& weights,
                           const PoseCellSize& size, std::size_t most) {
  std::vector<Heap> heaps;
  std::unordered_map<std::uint64_t, std::size_t> heap_of_cell;
  std::size_t heap = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    // Copies of a particle follow each other.
    if (i == 0 || !(particles[i] == particles[i - 1])) {
      const auto [it, is_new] = heap_of_cell.try_emplace(pose_cell(particles[i], size), heaps.size());
      if (is_new) heaps.emplace_back();
      heap = it->second;
    }
    heaps[heap].add(particles[i], weights[i]);
  }
  std::stable_sort(heaps.begin(), heaps.end(),
                   [](const Heap& a, const Heap& b) { return a.weight > b.weight; });
  heaps.resize(std::min(heaps.size(), most));
  return heaps;
}

}  // namespace glocal
