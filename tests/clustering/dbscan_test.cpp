#include "clustering/dbscan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "clustering/poses.hpp"

namespace glocal::clustering::dbscan_test {
namespace {

using test::at;
using test::Groups;
using ::testing::ElementsAre;

constexpr auto cluster = test::clustered<Dbscan>;

/// DBSCAN as Ester et al. write it down: poses are taken one after the other, and a core's cluster is
/// expanded seed by seed.
class AsPublished {
 public:
  AsPublished(const std::vector<Hypothesis>& hypotheses, const Dbscan::Params& params)
      : hypotheses_(hypotheses), params_(params), cluster_(hypotheses.size()) {}

  Groups find() {
    Groups groups;
    for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
      if (!cluster_[i] && expand(i, groups.size())) groups.emplace_back();
    }
    for (std::size_t i = 0; i < hypotheses_.size(); ++i) {
      if (cluster_[i]) {
        groups[*cluster_[i]].push_back(i);
      } else {
        groups.push_back({i});  // noise
      }
    }
    std::sort(groups.begin(), groups.end());
    return groups;
  }

 private:
  [[nodiscard]] std::vector<std::size_t> region(std::size_t i) const {
    std::vector<std::size_t> near;
    for (std::size_t j = 0; j < hypotheses_.size(); ++j) {
      const Pose3& a = hypotheses_[i].map_from_robot;
      const Pose3& b = hypotheses_[j].map_from_robot;
      const double cosine = std::abs(a.rotation.dot(b.rotation));
      const double turn = 2.0 * std::acos(std::min(1.0, cosine));
      if (std::hypot(a.x - b.x, a.y - b.y, a.z - b.z) <= params_.radius &&
          turn <= params_.radius_rotation_deg * std::numbers::pi / 180.0) {
        near.push_back(j);
      }
    }
    return near;
  }
  [[nodiscard]] bool is_core(const std::vector<std::size_t>& region) const {
    std::size_t support = 0;
    for (const std::size_t j : region) support += hypotheses_[j].support;
    return support >= static_cast<std::size_t>(params_.min_support);
  }
  bool expand(std::size_t start, std::size_t id) {
    std::vector<std::size_t> seeds = region(start);
    if (!is_core(seeds)) return false;
    for (const std::size_t j : seeds) {
      if (!cluster_[j]) cluster_[j] = id;
    }
    for (std::size_t k = 0; k < seeds.size(); ++k) {
      if (cluster_[seeds[k]] != id) continue;  // another cluster's, at the border of both
      const std::vector<std::size_t> more = region(seeds[k]);
      if (!is_core(more)) continue;
      for (const std::size_t j : more) {
        if (cluster_[j]) continue;
        cluster_[j] = id;
        seeds.push_back(j);
      }
    }
    return true;
  }

  const std::vector<Hypothesis>& hypotheses_;
  Dbscan::Params params_;
  std::vector<std::optional<std::size_t>> cluster_;
};

void expect_what_the_paper_writes_down(const std::vector<Hypothesis>& hypotheses, std::uint64_t seed) {
  for (const double radius : {0.03, 0.1, 0.3}) {
    for (const double rotation : {2.0, 7.0, 100.0, 180.0}) {
      for (const int support : {1, 3, 8, 40}) {
        const Dbscan::Params params{radius, rotation, support};
        ASSERT_EQ(cluster(hypotheses, params), AsPublished(hypotheses, params).find())
            << seed << ": " << radius << " m, " << rotation << " deg, " << support;
      }
    }
  }
}

TEST(Dbscan, IsWhatThePaperWritesDown) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Rng rng(seed);
    expect_what_the_paper_writes_down(test::crowded(400, rng), seed);
  }
}

TEST(Dbscan, IsWhatThePaperWritesDownInSpace) {
  for (const std::uint64_t seed : {1U, 2U, 3U}) {
    Rng rng(seed);
    expect_what_the_paper_writes_down(test::in_space(test::crowded(400, rng), rng), seed);
  }
}

TEST(Dbscan, ByHand) {
  // Four in a row 0.09 m apart, one at the border, one alone, and one that is turned too much.
  const std::vector<Hypothesis> row = {at(0.00, 0, 0), at(0.09, 0, 0), at(0.18, 0, 0), at(0.27, 0, 0),
                                       at(0.35, 0, 3), at(0.60, 0, 0), at(0.09, 0, 20)};
  EXPECT_THAT(cluster(row, {.radius = 0.1, .radius_rotation_deg = 5.0, .min_support = 3}),
              ElementsAre(ElementsAre(0U, 1U, 2U, 3U, 4U), ElementsAre(5U), ElementsAre(6U)));
}

TEST(Dbscan, ABorderGoesToTheClusterThatBeganFirst) {
  // Two crowds, and one pose 0.2 m from the nearer members of both, which are cores: it is none itself.
  std::vector<Hypothesis> poses = {at(0.2, 0, 0), at(0.4, 0, 0, 3), at(0.5, 0, 0, 7), at(0, 0, 0, 3),
                                   at(-0.1, 0, 0, 7)};
  const Dbscan::Params params{.radius = 0.21, .radius_rotation_deg = 5.0, .min_support = 10};
  EXPECT_THAT(cluster(poses, params), ElementsAre(ElementsAre(0U, 1U, 2U), ElementsAre(3U, 4U)));
  std::swap(poses[1], poses[3]);
  std::swap(poses[2], poses[4]);
  EXPECT_THAT(cluster(poses, params), ElementsAre(ElementsAre(0U, 1U, 2U), ElementsAre(3U, 4U)));
}

TEST(Dbscan, SupportCounts) {
  const std::vector<Hypothesis> pair = {at(0, 0, 0, 3), at(0.05, 0, 0)};
  EXPECT_EQ(cluster(pair, {.min_support = 4}).size(), 1U);
  EXPECT_EQ(cluster(pair, {.min_support = 5}).size(), 2U);
}

TEST(Dbscan, HeadingsAcrossTheSeamAreNear) {
  const std::vector<Hypothesis> seam = {at(0, 0, 179), at(0, 0, -179), at(0, 0, 177), at(0, 0, 0)};
  EXPECT_THAT(cluster(seam, {.radius_rotation_deg = 3.0, .min_support = 2}),
              ElementsAre(ElementsAre(0U, 1U, 2U), ElementsAre(3U)));
}

TEST(Dbscan, ManyAtOnePlaceAreOneCluster) {
  const std::vector<Hypothesis> crowd(100'000, at(3, 4, 180));
  EXPECT_EQ(cluster(crowd, {}).size(), 1U);
}

}  // namespace
}  // namespace glocal::clustering::dbscan_test
