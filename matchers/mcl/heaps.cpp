#include "matchers/mcl/heaps.hpp"

#include <algorithm>
#include <unordered_map>

namespace glocal {

std::vector<Heap> heaps_of(const std::vector<Pose2>& particles, const std::vector<double>& weights,
                           const PoseBinning& binning, std::size_t most) {
  std::vector<Heap> heaps;
  std::unordered_map<PoseCell, std::size_t, PoseCellHash> heap_of_cell;
  std::size_t heap = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    // Copies of a particle follow each other.
    if (i == 0 || !(particles[i] == particles[i - 1])) {
      const auto [it, is_new] = heap_of_cell.try_emplace(binning.cell_of(particles[i]), heaps.size());
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
