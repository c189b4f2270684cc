// Sets of points that change from step to step.
#pragma once

#include <random>
#include <vector>

#include "glocal/points.hpp"

namespace glocal::test {

inline Points points_at(const std::vector<std::pair<float, float>>& metres) {
  Points points;
  for (const auto& [x, y] : metres) points.push_back({x, y, 0.0F});
  return points;
}

/// Each of 30 places is in each set or not, in any order; some are there twice.
inline std::vector<Points> random_sets(std::size_t n) {
  std::mt19937 random(5);
  std::vector<Points> sets(n);
  for (Points& set : sets) {
    for (int i = 0; i < 20; ++i) {
      const auto place = static_cast<float>(random() % 30);
      set.push_back({0.25F * place - 3.0F, 0.001F * place, 0.0F});
    }
  }
  return sets;
}

}  // namespace glocal::test
