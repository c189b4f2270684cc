#include "report/thinning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace glocal::test::thinning_test {
namespace {

/// 20 x 20 x 20 points, 1 cm apart, in cells of 1 cm whose middles they are.
Points cube(float height) {
  Points points;
  for (int i = 0; i < 8000; ++i) {
    const auto along = [&](int step) { return 0.005F + 0.01F * static_cast<float>(i / step % 20); };
    points.push_back({along(1), along(20), height * along(400)});
  }
  return points;
}

TEST(ThinnedInSpace, AreTheSameInThePlaneAndWhereTheyAreFew) {
  EXPECT_EQ(thinned_in_space(cube(0.0F), 10), cube(0.0F));
  EXPECT_EQ(thinned_in_space(cube(1.0F), 8000), cube(1.0F));
  EXPECT_EQ(thinned_in_space({}, 0), Points{});
}

TEST(ThinnedInSpace, AreTheFirstOfEachVoxelOfTheSmallestSideThatIsEnough) {
  // Voxels of 2 cm hold 8 points each.
  const Points fine = thinned_in_space(cube(1.0F), 1000);
  ASSERT_EQ(fine.size(), 1000U);
  EXPECT_EQ(fine[0], cube(1.0F)[0]);
  EXPECT_EQ(fine[1], cube(1.0F)[2]);
  // Seven of √2 · 2 cm in each direction are enough, and in the end one that holds the whole cube.
  EXPECT_EQ(thinned_in_space(cube(1.0F), 999).size(), 343U);
  EXPECT_EQ(thinned_in_space(cube(1.0F), 1).size(), 1U);
}

TEST(ThinnedInSpace, LieNearAllThatWereThere) {
  const Points all = cube(1.0F);
  const Points thin = thinned_in_space(all, 300);
  EXPECT_LE(thin.size(), 300U);
  for (std::size_t i = 0; i < all.size(); i += 97) {
    float nearest = 1e9F;
    for (std::size_t k = 0; k < thin.size(); ++k)
      nearest =
          std::min(nearest, std::hypot(all.x[i] - thin.x[k], all.y[i] - thin.y[k], all.z[i] - thin.z[k]));
    EXPECT_LE(nearest, 0.04F * std::sqrt(3.0F));
  }
}

}  // namespace
}  // namespace glocal::test::thinning_test
