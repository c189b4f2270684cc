// Tests of plugins' searches by features (plugins/common), as users have them: chosen by name. Each plugin's
// test program instantiates them.
#pragma once

#include <gmock/gmock.h>

#include "files.hpp"
#include "glocal/builtin.hpp"
#include "loading/plugin_loader.hpp"
#include "matchers/surfels/scanned_hall.hpp"

namespace glocal::test::feature_search_tests {

using testing::HasSubstr;

inline const Pose3 here({5.0, 4.5, 1.2}, turn_about_z(0.3));
inline const Pose3 there({6.5, 3.0, 1.0}, exponential({0.1, -0.2, 2.0}));

/// Three points, m.
inline Points few_points() {
  Points points;
  points.push_back({0.0F, 0.0F, 0.0F});
  points.push_back({1.0F, 1.0F, 0.0F});
  points.push_back({2.0F, 0.0F, 1.0F});
  return points;
}

/// A search as a matcher and as a cloud registrar, and the plugin that has both.
struct Search {
  const char* matcher;
  const char* registrar;
  const char* plugin;
};

class FeatureSearch : public testing::TestWithParam<Search> {
 protected:
  FeatureSearch() {
    register_builtin_strategies(catalog_);
    PluginLoader(catalog_).load(GetParam().plugin);
  }

  Registration registration(const Points& source, const Points& target) {
    RegistrationOptions options;
    options.voxel_size = 0.3;
    return catalog_.cloud_registrars.make({GetParam().registrar}, options)->find(source, target);
  }

  /// In the hall, of which two scans are known.
  std::unique_ptr<Matcher> matcher(Motion motion = Motion::free) {
    MapData data;
    for (const Pose3& pose : {here, Pose3({9.0, 4.5, 1.5}, turn_about_z(-1.0))}) {
      const Points scan = moved(scan_of(hall(), pose), pose);
      for (std::size_t i = 0; i < scan.size(); ++i) data.points.push_back(scan[i]);
    }
    data.resolution = 0.1;
    return matcher_on(std::move(data), motion);
  }

  std::unique_ptr<Matcher> matcher_on(MapData data, Motion motion = Motion::free) {
    StageSetup setup;
    setup.map = std::make_shared<const GlobalMap>(std::move(data));
    setup.contact_epsilon = 0.2;
    setup.motion = motion;
    return catalog_.matchers.make({GetParam().matcher}, setup);
  }

  TemporaryFolder folder_;
  Catalog catalog_;
};

TEST_P(FeatureSearch, RegistersTwoScansOfAHall) {
  const Registration result = registration(scan_of(hall(), there), scan_of(hall(), here));
  ASSERT_TRUE(result.target_from_source);
  const Pose3 truth = inverse(here) * there;
  EXPECT_LT(distance(*result.target_from_source, truth), 0.45);
  EXPECT_LT(degrees(rotation_between(*result.target_from_source, truth)), 5.0);
  EXPECT_TRUE(result.is_match);
  EXPECT_GT(result.overlap, 0.5);
  EXPECT_LT(result.rmse, 0.45);
  EXPECT_EQ(result.voxel_size, 0.3);
}

TEST_P(FeatureSearch, TheSameSeedGivesTheSameBits) {
  const Points source = scan_of(hall(), there);
  const Points target = scan_of(hall(), here);
  EXPECT_EQ(registration(source, target).target_from_source, registration(source, target).target_from_source);
}

TEST_P(FeatureSearch, TooFewPointsAreNoMatch) {
  const Registration result = registration(few_points(), scan_of(hall(), here));
  EXPECT_FALSE(result.is_match);
  EXPECT_FALSE(result.target_from_source);
  EXPECT_THAT(result.why, HasSubstr("no pose"));
  EXPECT_FALSE(registration(scan_of(hall(), here), few_points()).is_match);
}

TEST_P(FeatureSearch, FindsAScanInAMap) {
  const auto matcher = this->matcher();
  ASSERT_TRUE(matcher->map_index());
  EXPECT_GT(matcher->map_index()->entries, 100U);
  LocalMap local;
  local.local_from_robot = Pose3({0.4, -0.3, 0.2}, exponential({0.0, 0.1, 0.2}));
  local.points = moved(scan_of(hall(), here), local.local_from_robot);
  Rng rng(1);
  const MatchResult result = matcher->match({local, {}, 0.3}, rng);
  ASSERT_FALSE(result.hypotheses.empty());
  const Hypothesis& best = result.hypotheses.front();
  EXPECT_LT(distance(best.map_from_local * local.local_from_robot, here), 0.45);
  EXPECT_LT(degrees(rotation_between(best.map_from_local * local.local_from_robot, here)), 5.0);
  EXPECT_GT(best.quality, 0.5);
  EXPECT_EQ(best.score, best.quality);
  EXPECT_EQ(result.proposals, 1U);

  Rng same(1);
  const MatchResult again = matcher->match({local, {}, 0.3}, same);
  ASSERT_FALSE(again.hypotheses.empty());
  EXPECT_EQ(again.hypotheses.front().map_from_local, best.map_from_local);
}

TEST_P(FeatureSearch, WhereTheMotionIsUprightPosesThatTiltAreDropped) {
  LocalMap tilted;
  tilted.points = moved(scan_of(hall(), here), Pose3(exponential({0.6, 0.0, 0.0})));
  Rng rng(1);
  EXPECT_TRUE(matcher(Motion::upright)->match({tilted, {}, 0.0}, rng).hypotheses.empty());
  LocalMap upright;
  upright.points = scan_of(hall(), here);
  EXPECT_FALSE(matcher(Motion::upright)->match({upright, {}, 0.0}, rng).hypotheses.empty());
}

TEST_P(FeatureSearch, ALocalMapWithFewPointsHasNoHypotheses) {
  const auto matcher = this->matcher();
  LocalMap local;
  Rng rng(1);
  EXPECT_TRUE(matcher->match({local, {}, 0.0}, rng).hypotheses.empty());
  local.points = few_points();
  EXPECT_TRUE(matcher->match({local, {}, 0.0}, rng).hypotheses.empty());
}

TEST_P(FeatureSearch, AMapWithFewPointsIsRefused) {
  MapData data;
  data.points = few_points();
  EXPECT_THAT(config_error(folder_ / "", [&] { (void)matcher_on(std::move(data)); }),
              HasSubstr("voxels of 0.10 m with points; features need 10 or more"));
}

}  // namespace glocal::test::feature_search_tests
