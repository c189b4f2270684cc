#include "clustering/hierarchical_kmeans.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

namespace glocal::hierarchical_kmeans_test {
namespace {

constexpr double pi = std::numbers::pi;

Hypothesis at(double x, double y, double theta) {
  return {{}, {x, y, theta}, 0.7};
}

std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses,
                             const HierarchicalKmeans::Params& params = {}) {
  Rng rng(1);
  return HierarchicalKmeans(params).cluster(hypotheses, rng);
}

TEST(MakeCluster, MeanAndVariancesByHand) {
  const Cluster c = make_cluster({at(1.0, 2.0, 0.1), at(9.0, 9.0, 1.0), at(3.0, 2.0, 0.3)}, {0, 2});
  EXPECT_DOUBLE_EQ(c.map_from_robot.x, 2.0);
  EXPECT_DOUBLE_EQ(c.map_from_robot.y, 2.0);
  EXPECT_NEAR(c.map_from_robot.theta, 0.2, 1e-12);
  EXPECT_DOUBLE_EQ(c.variance_x, 1.0);  // ((1 - 2)^2 + (3 - 2)^2) / 2
  EXPECT_DOUBLE_EQ(c.variance_y, 0.0);
  EXPECT_NEAR(c.variance_theta, 0.01, 1e-12);
  EXPECT_EQ(c.members, (std::vector<std::size_t>{0, 2}));
}

TEST(MakeCluster, HeadingsAcrossTheSeam) {
  const Cluster c = make_cluster({at(0, 0, pi - 0.1), at(0, 0, -pi + 0.1)}, {0, 1});
  EXPECT_NEAR(std::abs(c.map_from_robot.theta), pi, 1e-12);
  EXPECT_NEAR(c.variance_theta, 0.01, 1e-12);
}

TEST(HierarchicalKmeans, NothingGivesNothing) {
  EXPECT_TRUE(cluster({}).empty());
}

TEST(HierarchicalKmeans, LooksLikeFigure2) {
  // Many hypotheses around the true pose and one outlier: two clusters, the outlier alone in its own.
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 50; ++i) hypotheses.push_back(at(2.0 + 0.001 * i, 3.0 - 0.001 * i, 0.5 + 0.0005 * i));
  hypotheses.push_back(at(7.0, 1.0, -2.0));
  std::vector<Cluster> clusters = cluster(hypotheses);
  ASSERT_EQ(clusters.size(), 2U);
  std::sort(clusters.begin(), clusters.end(),
            [](const Cluster& a, const Cluster& b) { return a.members.size() < b.members.size(); });
  EXPECT_EQ(clusters[0].members, (std::vector<std::size_t>{50}));
  EXPECT_EQ(clusters[1].members.size(), 50U);
}

TEST(HierarchicalKmeans, SplitsExactlyWhereAVarianceIsTooLarge) {
  // Two poses 2 d apart have the variance d^2: 30 cm^2 is reached at d = 5.477 cm, 50 deg^2 at d = 7.071 deg.
  EXPECT_EQ(cluster({at(-0.0547, 0, 0), at(0.0547, 0, 0)}).size(), 1U);
  EXPECT_EQ(cluster({at(-0.0548, 0, 0), at(0.0548, 0, 0)}).size(), 2U);
  EXPECT_EQ(cluster({at(0, -0.0547, 0), at(0, 0.0547, 0)}).size(), 1U);
  EXPECT_EQ(cluster({at(0, -0.0548, 0), at(0, 0.0548, 0)}).size(), 2U);
  EXPECT_EQ(cluster({at(0, 0, radians(-7.07)), at(0, 0, radians(7.07))}).size(), 1U);
  EXPECT_EQ(cluster({at(0, 0, radians(-7.08)), at(0, 0, radians(7.08))}).size(), 2U);
}

TEST(HierarchicalKmeans, OppositeHeadingsAtOnePlaceAreTwoClusters) {
  EXPECT_EQ(cluster({at(1, 1, 0.0), at(1, 1, pi), at(1, 1, 0.01), at(1, 1, -pi + 0.01)}).size(), 2U);
}

TEST(HierarchicalKmeans, EveryHypothesisInOneCompactCluster) {
  Rng rng(8);
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 3000; ++i) {
    hypotheses.push_back(at(rng.uniform(0, 20), rng.uniform(0, 20), rng.uniform(-pi, pi)));
  }
  const HierarchicalKmeans::Params params;
  std::vector<int> times_seen(hypotheses.size(), 0);
  for (const Cluster& c : cluster(hypotheses, params)) {
    ASSERT_FALSE(c.members.empty());
    EXPECT_TRUE(std::is_sorted(c.members.begin(), c.members.end()));
    EXPECT_LE(std::max(c.variance_x, c.variance_y), params.max_variance_translation);
    EXPECT_LE(c.variance_theta, params.max_variance_rotation_deg2 * radians(1.0) * radians(1.0));
    for (const std::size_t i : c.members) ++times_seen[i];
  }
  EXPECT_EQ(std::count(times_seen.begin(), times_seen.end(), 1), 3000);
}

TEST(HierarchicalKmeans, KeepsKnownGroupsApart) {
  // Groups far tighter than the limits and far more than them apart must come out as they went in.
  Rng rng(5);
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 600; ++i) {
    const int group = i % 12;
    const int row = group / 4;
    hypotheses.push_back(at(2.0 * (group % 4) + rng.normal(0.01), 3.0 * row + rng.normal(0.01),
                            0.5 * group - 2.5 + rng.normal(0.01)));
  }
  const std::vector<Cluster> clusters = cluster(hypotheses);
  ASSERT_EQ(clusters.size(), 12U);
  for (const Cluster& c : clusters) {
    EXPECT_EQ(c.members.size(), 50U);
    for (const std::size_t i : c.members) EXPECT_EQ(i % 12, c.members.front() % 12);
  }
}

}  // namespace
}  // namespace glocal::hierarchical_kmeans_test
