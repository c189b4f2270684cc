#include "raters/quality_only.hpp"

#include <gtest/gtest.h>

#include "raters/two_clusters.hpp"

namespace glocal::raters::quality_only_test {
namespace {

using test::qualities;
using test::two_clusters;
using test::with_scores;

TEST(QualityOnly, RatesByTheBestHypothesis) {
  QualityOnly rater({.quality = "best"});
  const auto ratings = rater.rate(two_clusters, with_scores(qualities));
  ASSERT_EQ(ratings.size(), 2U);
  EXPECT_DOUBLE_EQ(ratings[0].r, 0.7);
  EXPECT_DOUBLE_EQ(ratings[1].r, 0.8);
  EXPECT_NEAR(ratings[0].r_normalised, 0.7 / 1.5, 1e-12);
  EXPECT_NEAR(ratings[1].r_normalised, 0.8 / 1.5, 1e-12);
}

TEST(QualityOnly, RatesByTheMean) {
  QualityOnly rater({.quality = "mean"});
  auto hypotheses = with_scores(qualities);
  EXPECT_NEAR(rater.rate(two_clusters, hypotheses)[0].r, 0.6, 1e-12);
  EXPECT_NEAR(rater.rate(two_clusters, hypotheses)[1].r, 0.5, 1e-12);
  hypotheses[2].support = 3;  // (0.7 + 3 * 0.5) / 4
  EXPECT_NEAR(rater.rate(two_clusters, hypotheses)[0].r, 0.55, 1e-12);
}

TEST(QualityOnly, StaysAboveZero) {
  QualityOnly rater({});
  const auto ratings = rater.rate(two_clusters, with_scores({0, 0, 0, 0, 0}));
  EXPECT_GT(ratings[0].r, 0.0);
  EXPECT_DOUBLE_EQ(ratings[0].r_normalised, 0.5);
}

}  // namespace
}  // namespace glocal::raters::quality_only_test
