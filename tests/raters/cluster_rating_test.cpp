#include "raters/cluster_rating.hpp"

#include <gtest/gtest.h>

namespace glocal::raters::cluster_rating_test {
namespace {

Hypothesis with_score(double score) {
  return {.map_from_local = {}, .score = score};
}

TEST(ClusterRating, Equation7ByHand) {
  const std::vector<Hypothesis> hypotheses = {with_score(0.9), with_score(0.7), with_score(0.6),
                                              with_score(0.5)};
  // Half the largest variance along y, a fifth of the largest variance of heading.
  const double rotation = 10.0 * radians(1.0) * radians(1.0);
  const std::vector<Cluster> clusters = {{{0, 1, 2}, {}, 0.0003, 0.0015, rotation}, {{3}, {}, 0.0, 0.0, 0.0}};
  ClusterRating rater({});
  const std::vector<Rating> ratings = rater.rate(clusters, hypotheses);
  ASSERT_EQ(ratings.size(), 2U);
  // 0.5 * 3/4 + 0.075 * (1 - 1/2) + 0.075 * (1 - 1/5) + 0.35 * (2.2 / 3)
  EXPECT_NEAR(ratings[0].r, 0.375 + 0.0375 + 0.06 + 0.35 * 2.2 / 3.0, 1e-12);
  // 0.5 * 1/4 + 0.075 + 0.075 + 0.35 * 0.5
  EXPECT_NEAR(ratings[1].r, 0.45, 1e-12);
  const double sum = ratings[0].r + ratings[1].r;
  EXPECT_NEAR(ratings[0].r_normalised, ratings[0].r / sum, 1e-12);  // eq. 8
  EXPECT_NEAR(ratings[1].r_normalised, ratings[1].r / sum, 1e-12);
}

TEST(ClusterRating, InSpaceTheWidestAxisCounts) {
  ClusterRating rater({});
  const auto r_of = [&](Cluster cluster) {
    cluster.members = {0};
    return rater.rate({cluster}, {with_score(0.0)})[0].r;
  };
  const double rotation = 10.0 * radians(1.0) * radians(1.0);
  // 0.5 + 0.075 * (1 - 1/2) + 0.075, and 0.5 + 0.075 + 0.075 * (1 - 1/5).
  EXPECT_NEAR(r_of({.members = {}, .map_from_robot = {}, .variance_x = 0.0003, .variance_z = 0.0015}), 0.6125,
              1e-12);
  EXPECT_NEAR(r_of({.members = {}, .map_from_robot = {}, .variance_about_x = rotation}), 0.635, 1e-12);
  EXPECT_NEAR(r_of({.members = {}, .map_from_robot = {}, .variance_about_y = rotation}), 0.635, 1e-12);
}

TEST(ClusterRating, StaysAboveZeroHoweverWideTheCluster) {
  ClusterRating rater({});
  const auto ratings = rater.rate({{{0}, {}, 100.0, 100.0, 9.0}}, {with_score(0.5)});
  EXPECT_NEAR(ratings[0].r, 0.5 + 0.35 * 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(ratings[0].r_normalised, 1.0);
}

TEST(ClusterRating, SharesAreNumbersWhereNoTermCounts) {
  // Eq. 8 divides by the sum of all.
  ClusterRating rater({.weights = {0.0, 1.0, 0.0, 0.0}});
  const std::vector<Rating> ratings =
      rater.rate({{{0}, {}, 1.0, 1.0, 0.0}, {{1}, {}, 1.0, 1.0, 0.0}}, {with_score(0.9), with_score(0.1)});
  EXPECT_GT(ratings[0].r, 0.0);
  EXPECT_DOUBLE_EQ(ratings[0].r_normalised, 0.5);
}

TEST(ClusterRating, TheBestPossibleIsOne) {
  ClusterRating rater({});
  EXPECT_DOUBLE_EQ(rater.rate({{{0}, {}, 0.0, 0.0, 0.0}}, {with_score(1.0)})[0].r, 1.0);
}

TEST(ClusterRating, IsAtMostOneForWeightsThatAreRounded) {
  ASSERT_GT(0.4 + 0.2 + 0.3 + 0.1, 1.0);
  ClusterRating rater({.weights = {0.4, 0.2, 0.3, 0.1}});
  EXPECT_EQ(rater.rate({{{0}, {}, 0.0, 0.0, 0.0}}, {with_score(1.0)})[0].r, 1.0);
}

TEST(ClusterRating, FirstStepRatingsOfFigure4a) {
  // Some 800 clusters of single hypotheses just over the threshold: "all weights range between 0.2 and 0.45".
  std::vector<Hypothesis> hypotheses;
  std::vector<Cluster> clusters;
  for (std::size_t i = 0; i < 800; ++i) {
    hypotheses.push_back(with_score(0.6 + 0.2 * static_cast<double>(i) / 800.0));
    clusters.push_back({{i}, {}, 0.0, 0.0, 0.0});
  }
  ClusterRating rater({});
  for (const Rating& rating : rater.rate(clusters, hypotheses)) {
    EXPECT_GT(rating.r, 0.2);
    EXPECT_LT(rating.r, 0.45);
  }
}

TEST(ClusterRating, NothingGivesNothing) {
  ClusterRating rater({});
  EXPECT_TRUE(rater.rate({}, {}).empty());
}

}  // namespace
}  // namespace glocal::raters::cluster_rating_test
