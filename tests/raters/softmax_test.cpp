#include "raters/softmax.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "raters/two_clusters.hpp"

namespace glocal::raters::softmax_test {
namespace {

using test::qualities;
using test::two_clusters;
using test::with_scores;

TEST(Softmax, ByHand) {
  Softmax rater({.beta = 10.0});
  const auto ratings = rater.rate(two_clusters, with_scores(qualities));
  EXPECT_NEAR(ratings[0].r, std::exp(-3.0), 1e-12);
  EXPECT_NEAR(ratings[1].r, std::exp(-2.0), 1e-12);
  EXPECT_NEAR(ratings[0].r_normalised, 1.0 / (1.0 + std::exp(1.0)), 1e-12);
  EXPECT_NEAR(ratings[1].r_normalised, 1.0 / (1.0 + std::exp(-1.0)), 1e-12);
}

TEST(Softmax, OfMeans) {
  Softmax rater({.beta = 10.0, .quality = "mean"});
  const auto ratings = rater.rate(two_clusters, with_scores(qualities));
  EXPECT_NEAR(ratings[0].r_normalised, 1.0 / (1.0 + std::exp(-1.0)), 1e-12);
}

TEST(Softmax, IsANumberAtItsLimits) {
  Softmax steep({.beta = 500.0});
  const auto ratings = steep.rate(two_clusters, with_scores({0.0, 0.0, 0.0, 0.0, 0.0}));
  EXPECT_GT(ratings[0].r, 0.0);
  EXPECT_DOUBLE_EQ(ratings[0].r_normalised, 0.5);
  Softmax flat({.beta = 0.0});
  EXPECT_DOUBLE_EQ(flat.rate(two_clusters, with_scores(qualities))[0].r_normalised, 0.5);
}

}  // namespace
}  // namespace glocal::raters::softmax_test
