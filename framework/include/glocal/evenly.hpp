// Some of many, spread evenly.
#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "glocal/points.hpp"

namespace glocal {

/// Which of n things in a row to take where at most so many are wanted: rising numbers from 0 on, all of them
/// if there are no more.
[[nodiscard]] inline std::vector<std::size_t> evenly_chosen(std::size_t n, std::size_t most) {
  const std::size_t count = std::min(n, most);
  std::vector<std::size_t> chosen;
  chosen.reserve(count);
  for (std::size_t i = 0; i < count; ++i) chosen.push_back(i * n / count);
  return chosen;
}

/// So many of the points at most.
[[nodiscard]] inline Points evenly_chosen(const Points& points, std::size_t most) {
  Points chosen;
  for (const std::size_t i : evenly_chosen(points.size(), most)) chosen.push_back(points[i]);
  return chosen;
}

}  // namespace glocal
