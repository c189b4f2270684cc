// plugins/pcl, as users have it: a plugin's strategies, chosen by name.
#include <gtest/gtest.h>

#include "files.hpp"
#include "glocal/builtin.hpp"
#include "glocal/yaml.hpp"
#include "loading/plugin_loader.hpp"
#include "plugins/feature_search_tests.hpp"
#include "test_world.hpp"

namespace glocal::test::pcl_test {
namespace {

class Pcl : public ::testing::Test {
 protected:
  Pcl() {
    register_builtin_strategies(catalog_);
    PluginLoader(catalog_).load(GLOCAL_PCL_PLUGIN);
  }

  MatchResult match(const std::string& name, const LocalMap& local, std::uint64_t seed = 1) {
    const auto matcher =
        catalog_.matchers.make(catalog_.matchers.choose(name), {glocal::test::small_world(), 1});
    Rng rng(seed);
    return matcher->match({local, {}, 0.7}, rng);
  }

  TemporaryFolder folder_;
  Catalog catalog_;
};

constexpr double reach = 3.5;

TEST_F(Pcl, BothMatchersFindThePose) {
  const Pose2 truth{5.5, 2.5, 0.7};
  for (const char* name : {"pcl_icp", "pcl_prerejective"}) {
    const MatchResult result = match(name, glocal::test::local_map_at(truth, reach));
    ASSERT_FALSE(result.hypotheses.empty()) << name;
    const Pose3& best = result.hypotheses.front().map_from_local;
    EXPECT_LT(distance(best, truth), 0.03) << name;
    EXPECT_LT(rotation_between(best, truth), radians(1.0)) << name;
    EXPECT_GT(result.hypotheses.front().quality, 0.98) << name;
  }
}

TEST_F(Pcl, AnotherOriginOfTheLocalMapChangesNothing) {
  const Pose2 truth{2.0, 6.0, -1.0};
  const Pose2 local_from_robot{3.0, -1.0, 0.5};
  LocalMap local = glocal::test::local_map_at(truth, reach);
  local.points = glocal::test::moved(local.points, local_from_robot);
  local.local_from_robot = local_from_robot;
  const MatchResult result = match("pcl_icp", local);
  ASSERT_FALSE(result.hypotheses.empty());
  EXPECT_LT(distance(result.hypotheses.front().map_from_local * local_from_robot, truth), 0.03);
}

TEST_F(Pcl, MoreCandidatesThanPointsAreAllOfThem) {
  StrategyChoice choice = catalog_.matchers.choose("pcl_prerejective");
  read_yaml(folder_.write("params.yaml", "{candidates: 1000000, iterations: 1000, runs: 1}"), *choice.params);
  const auto matcher = catalog_.matchers.make(choice, {glocal::test::small_world(), 1});
  const LocalMap local = glocal::test::local_map_at({5.5, 2.5, 0.7}, reach);
  Rng rng(1);
  EXPECT_LE(matcher->match({local, {}, 0.0}, rng).proposals, 1U);
}

TEST_F(Pcl, KdTreesOfPclAndOfNanoflannAgreePointByPoint) {
  const auto map = glocal::test::small_world();
  constexpr double epsilon = 0.1;
  const ContactSetup setup{&map->points(), epsilon};
  const auto pcl = catalog_.contact_indexes.make({"pcl_kd_tree"}, setup);
  const auto nanoflann = catalog_.contact_indexes.make({"kd_tree"}, setup);
  Rng rng(3);
  Points points;
  for (int i = 0; i < 2000; ++i) {
    points.push_back({static_cast<float>(rng.uniform(-1.0, 9.0)), static_cast<float>(rng.uniform(-1.0, 10.0)),
                      static_cast<float>(rng.uniform(-0.1, 0.1))});
  }
  const Transform turned(Pose2{0.3, -0.2, 0.1});
  std::size_t both = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    ASSERT_EQ(pcl->count(points, i, 1, turned), nanoflann->count(points, i, 1, turned)) << i;
    both += pcl->count(points, i, 1, turned);
  }
  EXPECT_GT(both, 50U);
}

TEST_F(Pcl, RansamTakesPclsKdTree) {
  StrategyChoice choice = catalog_.matchers.choose("ransam");
  read_yaml(folder_.write("params.yaml", "iterations: 5000\ncontact: pcl_kd_tree\n"), *choice.params);
  const auto matcher = catalog_.matchers.make(choice, {glocal::test::small_world(), 1});
  const Pose2 truth{5.5, 2.5, 0.7};
  Rng rng(1);
  const MatchResult result = matcher->match({glocal::test::local_map_at(truth, reach), {}, 0.8}, rng);
  ASSERT_FALSE(result.hypotheses.empty());
  EXPECT_LT(distance(result.hypotheses.front().map_from_local, truth), 0.1);
}

TEST_F(Pcl, AMapWithoutFreeSpaceIsRefused) {
  MapData data;
  data.points = glocal::test::small_world_points();
  data.grid = {{}, 0.1, 10, 10, PackedCells(100, Cell::unknown)};
  const auto map = std::make_shared<const GlobalMap>(std::move(data));
  EXPECT_NE(config_error(folder_ / "",
                         [&] {
                           (void)catalog_.matchers.make({"pcl_icp"}, {map, 1});
                         })
                .find("no free cell to start from"),
            std::string::npos);
}

}  // namespace
}  // namespace glocal::test::pcl_test

namespace glocal::test::feature_search_tests {

INSTANTIATE_TEST_SUITE_P(Pcl, FeatureSearch,
                         testing::Values(Search{"pcl_cloud_prerejective", "pcl_prerejective",
                                                GLOCAL_PCL_PLUGIN}),
                         [](const auto& search) { return search.param.registrar; });

}  // namespace glocal::test::feature_search_tests
