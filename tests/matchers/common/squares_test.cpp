#include "matchers/common/squares.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "glocal/rng.hpp"

namespace glocal::squares_test {
namespace {

constexpr double side = 0.5;

/// Each point's square has all that are nearer than a side in and about it.
void expect_neighbours(const Squares& squares, const std::vector<float>& x, const std::vector<float>& y) {
  for (std::size_t i = 0; i < x.size(); ++i) {
    std::set<std::size_t> found;
    squares.near(x[i], y[i], [&](std::uint32_t k) { found.insert(k); });
    for (std::size_t k = 0; k < x.size(); ++k) {
      const bool is_near = std::hypot(x[k] - x[i], y[k] - y[i]) <= side;
      EXPECT_TRUE(!is_near || found.contains(k)) << i << ", " << k;
    }
  }
}

TEST(Squares, FindAllThatAreNear) {
  Rng rng(3);
  std::vector<float> x, y;
  for (int i = 0; i < 300; ++i) {
    x.push_back(static_cast<float>(rng.uniform(-3.0, 4.0)));
    y.push_back(static_cast<float>(rng.uniform(5.0, 8.0)));
  }
  const Squares squares(x, y, side);
  expect_neighbours(squares, x, y);
  std::size_t members = 0;
  for (std::size_t i = 0; i < squares.size(); ++i) members += squares.members(i).size();
  EXPECT_EQ(members, x.size());
}

TEST(Squares, OfPointsThatAreFarFromEachOtherTakeNoMoreMemory) {
  const std::vector<float> x = {0.0F, 0.4F, 100000.0F, 100000.4F}, y = {0.0F, 0.0F, 100000.0F, 100000.0F};
  const Squares squares(x, y, side);
  EXPECT_LT(squares.size(), 5'000'000U);
  expect_neighbours(squares, x, y);
}

}  // namespace
}  // namespace glocal::squares_test
