#include "clustering/hierarchical_kmeans.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <vector>

#include "files.hpp"
#include "glocal/yaml.hpp"

namespace glocal::clustering::hierarchical_kmeans_test {
namespace {

constexpr double pi = std::numbers::pi;

Hypothesis at(double x, double y, double theta) {
  return {{}, Pose2{x, y, theta}, 0.7};
}

std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses,
                             const HierarchicalKmeans::Params& params = {}) {
  Rng rng(1);
  return HierarchicalKmeans(params).cluster(hypotheses, rng);
}

Hypothesis turned(const Vector3& turn) {
  return {{}, Pose3(exponential(turn)), 0.7};
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

TEST(HierarchicalKmeans, LimitsBelowRoundingComeToAnEnd) {
  const std::vector<Hypothesis> alike(3, at(1e5 / 3.0, 7e5 / 3.0, 0.1));
  std::vector<Hypothesis> two = alike;
  two.push_back(at(0.0, 0.0, 0.0));
  EXPECT_EQ(cluster(two, {.max_variance_translation = 1e-300, .max_variance_rotation_deg2 = 1e-300}).size(),
            2U);
}

TEST(HierarchicalKmeans, LimitsThatCannotBeDividedByAreRefused) {
  const test::TemporaryFolder folder;
  const auto fault = [&](const std::string& yaml) {
    return test::config_error(folder.path(), [&] {
      ParamsOf<HierarchicalKmeans::Params> params;
      read_yaml(folder.write("params.yaml", yaml), params);
    });
  };
  EXPECT_EQ(fault("max_variance_translation: 1e-12\nmax_variance_rotation_deg2: 1e-12\n"), "");
  EXPECT_EQ(
      fault("max_variance_translation: 1e-309\n"),
      "params.yaml:1:27: error: max_variance_translation: 1e-309 is out of range, must be >= 1e-12 m^2");
  EXPECT_EQ(
      fault("max_variance_rotation_deg2: 1e-306\n"),
      "params.yaml:1:29: error: max_variance_rotation_deg2: 1e-306 is out of range, must be >= 1e-12 deg^2");
  // The least ones are those with which poses can still be told apart, also where they only differ in one.
  const HierarchicalKmeans::Params least{.max_variance_translation = 1e-12,
                                         .max_variance_rotation_deg2 = 1e-12};
  EXPECT_EQ(cluster({at(0, 0, 0), at(1, 0, 0), at(1, 0, 0.1)}, least).size(), 3U);
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

TEST(HierarchicalKmeans, SplitsInSpaceExactlyWhereAVarianceIsTooLarge) {
  const auto raised = [](double z) { return Hypothesis{{}, Pose3(Vector3{0, 0, z}), 0.7}; };
  EXPECT_EQ(cluster({raised(-0.0547), raised(0.0547)}).size(), 1U);
  EXPECT_EQ(cluster({raised(-0.0548), raised(0.0548)}).size(), 2U);
  for (const Vector3& axis : {Vector3{1, 0, 0}, Vector3{0, 1, 0}}) {
    EXPECT_EQ(cluster({turned(radians(-7.07) * axis), turned(radians(7.07) * axis)}).size(), 1U);
    EXPECT_EQ(cluster({turned(radians(-7.08) * axis), turned(radians(7.08) * axis)}).size(), 2U);
  }
}

TEST(HierarchicalKmeans, KeepsKnownGroupsInSpaceApart) {
  Rng rng(6);
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 400; ++i) {
    // Eight places of a cube's corners, on each of which the robot leans another way.
    const int corner = i % 8;
    const int layer = corner / 4;
    const Vector3 place{1.0 * (corner % 2), 1.0 * (corner / 2 % 2), 1.0 * layer};
    const Vector3 noise{rng.normal(0.01), rng.normal(0.01), rng.normal(0.01)};
    const Vector3 lean{0.4 * corner - 1.5, 0.2 * corner, -0.3 * corner};
    hypotheses.push_back({{}, Pose3(place + noise, exponential(lean + noise)), 0.7});
  }
  const std::vector<Cluster> clusters = cluster(hypotheses);
  ASSERT_EQ(clusters.size(), 8U);
  for (const Cluster& c : clusters) {
    EXPECT_EQ(c.members.size(), 50U);
    for (const std::size_t i : c.members) EXPECT_EQ(i % 8, c.members.front() % 8);
  }
}

TEST(HierarchicalKmeans, RotationsAllOverSpaceComeToAnEnd) {
  Rng rng(7);
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 500; ++i) {
    const double pitch = rng.uniform(-pi, pi);
    hypotheses.push_back(turned({rng.uniform(-pi, pi), pitch, rng.uniform(-pi, pi)}));
  }
  std::size_t members = 0;
  for (const Cluster& c : cluster(hypotheses)) members += c.members.size();
  EXPECT_EQ(members, 500U);
}

}  // namespace
}  // namespace glocal::clustering::hierarchical_kmeans_test
