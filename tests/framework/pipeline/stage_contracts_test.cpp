// Answers that break a stage's contract are refused; whole ones are not.
#include "pipeline/stage_contracts.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <limits>

#include "files.hpp"

namespace glocal::test::stage_contracts_test {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

LocalMap local_map() {
  LocalMap local;
  for (int i = 0; i < 3; ++i) {
    local.points.push_back({1.0F, 2.0F, 0.0F});
    local.normals.push_back({0.0F, 1.0F, 0.0F});
  }
  local.ends = {1, 3};
  return local;
}

TEST(StageContracts, PointsArePlaces) {
  EXPECT_NO_THROW(check_local_map({}, Motion::planar));
  EXPECT_NO_THROW(check_local_map(local_map(), Motion::planar));
  for (const float odd :
       {std::numeric_limits<float>::quiet_NaN(), -std::numeric_limits<float>::quiet_NaN(),
        std::numeric_limits<float>::infinity(), -std::numeric_limits<float>::infinity(), 1.1e7F, -1.1e7F}) {
    LocalMap local = local_map();
    local.points.set(2, {0.0F, odd, 0.0F});
    EXPECT_THROW(check_local_map(local, Motion::planar), BrokenContract) << odd;
    local = local_map();
    local.normals.set(0, {odd, 0.0F, 0.0F});
    EXPECT_THROW(check_local_map(local, Motion::planar), BrokenContract) << odd;
  }
  LocalMap far = local_map();
  far.points.set(0, {-1e7F, 1e7F, 0.0F});
  EXPECT_NO_THROW(check_local_map(far, Motion::planar));
}

TEST(StageContracts, LocalMapsAreWhole) {
  LocalMap uneven = local_map();
  uneven.points.z.pop_back();
  EXPECT_THROW(check_local_map(uneven, Motion::planar), BrokenContract);
  LocalMap few_normals = local_map();
  few_normals.normals = {};
  EXPECT_NO_THROW(check_local_map(few_normals, Motion::planar));
  few_normals.normals.push_back({1.0F, 0.0F, 0.0F});
  EXPECT_THROW(check_local_map(few_normals, Motion::planar), BrokenContract);
  LocalMap falling = local_map();
  falling.ends = {2, 1};
  EXPECT_THROW(check_local_map(falling, Motion::planar), BrokenContract);
  LocalMap beyond = local_map();
  beyond.ends = {1, 4};
  EXPECT_THROW(check_local_map(beyond, Motion::planar), BrokenContract);
  LocalMap nowhere = local_map();
  nowhere.local_from_robot = Pose2{0, 0, infinite};
  EXPECT_THROW(check_local_map(nowhere, Motion::planar), BrokenContract);
}

TEST(StageContracts, MapsHavePointsAndAWholeGrid) {
  MapData good;
  good.points.push_back({1.0F, 2.0F, 0.0F});
  good.grid = {{0, 0, 0}, 0.5, 2, 1, {Cell::free, Cell::occupied}};
  good.path = {Pose2{1, 2, 3}};
  EXPECT_NO_THROW(check_map(good, Motion::planar));
  const auto expect_broken = [&](const std::function<void(MapData&)>& break_it) {
    MapData map = good;
    break_it(map);
    EXPECT_THROW(check_map(map, Motion::planar), BrokenContract);
  };
  expect_broken([](MapData& map) { map.points = {}; });
  expect_broken([](MapData& map) { map.points.x[0] = std::numeric_limits<float>::quiet_NaN(); });
  expect_broken([](MapData& map) { map.normals.push_back({1, 0, 0}), map.normals.push_back({1, 0, 0}); });
  expect_broken([](MapData& map) { map.grid.cells = PackedCells(1); });
  expect_broken([](MapData& map) { map.grid.width = map.grid.height = -1; });
  expect_broken([](MapData& map) { map.grid.resolution = not_a_number; });
  expect_broken([](MapData& map) { map.resolution = not_a_number; });
  expect_broken([](MapData& map) { map.resolution = -0.1; });
  expect_broken([](MapData& map) { map.grid.map_from_grid.x = infinite; });
  expect_broken([](MapData& map) { map.path[0] = Pose2{0, 0, not_a_number}; });
  expect_broken([](MapData& map) { map.origin.y() = not_a_number; });
  expect_broken([](MapData& map) { map.origin.x() = 2e7; });
  expect_broken([](MapData& map) { map.origin.z() = 2000.0; });
  good.origin = {5e5, 4.6e6, 2000.0};
  EXPECT_NO_THROW(check_map(good, Motion::upright));
}

TEST(StageContracts, SamplesArePlaces) {
  Sample good;
  good.observation.scan.hits.push_back({1.0F, 2.0F, 0.0F});
  good.map_from_robot = Pose2{1, 2, 3};
  EXPECT_NO_THROW(check_sample({}, Motion::planar));
  EXPECT_NO_THROW(check_sample(good, Motion::planar));
  const auto expect_broken = [&](const std::function<void(Sample&)>& break_it) {
    Sample sample = good;
    break_it(sample);
    EXPECT_THROW(check_sample(sample, Motion::planar), BrokenContract);
  };
  expect_broken([](Sample& s) { s.observation.stamp = not_a_number; });
  expect_broken([](Sample& s) { s.observation.scan.hits.y[0] = std::numeric_limits<float>::infinity(); });
  expect_broken([](Sample& s) { s.observation.scan.free_ends.push_back({1e8F, 0, 0}); });
  expect_broken([](Sample& s) { s.observation.scan.times = {0.0F, 0.1F}; });
  expect_broken([](Sample& s) { s.observation.scan.times = {std::numeric_limits<float>::infinity()}; });
  expect_broken([](Sample& s) { s.observation.scan.origin.z = std::numeric_limits<float>::quiet_NaN(); });
  expect_broken([](Sample& s) { s.observation.odom_from_robot.x = infinite; });
  expect_broken([](Sample& s) { s.map_from_robot->y = not_a_number; });
}

TEST(StageContracts, ThresholdsAreShares) {
  for (const double share : {0.0, 0.5, 1.0}) EXPECT_NO_THROW(check_threshold(share));
  for (const double odd : {-0.1, 1.1, not_a_number, infinite})
    EXPECT_THROW(check_threshold(odd), BrokenContract);
}

TEST(StageContracts, HypothesesHavePlacesAndFallingScoresAboveTheThreshold) {
  const auto check = [](const std::vector<Hypothesis>& hypotheses) {
    check_hypotheses(hypotheses, 0.5, Motion::planar);
  };
  const Hypothesis good = Hypothesis::by_contact(Pose2{1, 2, 3}, 0.8);
  EXPECT_NO_THROW(check({}));
  EXPECT_NO_THROW(check({good, good, Hypothesis::by_contact(Pose2{1, 2, 3}, 0.5)}));
  EXPECT_THROW(check({Hypothesis::by_contact(Pose2{1, 2, 3}, 0.49)}), BrokenContract);
  EXPECT_THROW(check({Hypothesis::by_contact(Pose2{1, 2, 3}, 1.01)}), BrokenContract);
  EXPECT_THROW(check({good, Hypothesis::by_contact(Pose2{1, 2, 3}, 0.9)}), BrokenContract);
  for (const Pose2& nowhere : {Pose2{not_a_number, 0, 0}, Pose2{0, infinite, 0}, Pose2{0, 0, not_a_number},
                               Pose2{1e300, 0, 0}, Pose2{0, -1.1e7, 0}})
    EXPECT_THROW(check({Hypothesis::by_contact(nowhere, 0.8)}), BrokenContract);
  Hypothesis odd = good;
  odd.quality = not_a_number;
  EXPECT_THROW(check({odd}), BrokenContract);
  odd = good;
  odd.score = not_a_number;
  EXPECT_THROW(check({odd}), BrokenContract);
  odd = good;
  odd.support = 0;
  EXPECT_THROW(check({odd}), BrokenContract);
}

TEST(StageContracts, EveryHypothesisIsInOneCluster) {
  const auto check = [](const std::vector<std::vector<std::size_t>>& members) {
    std::vector<Cluster> clusters;
    for (const auto& some : members) clusters.push_back({some, Pose2{1, 2, 3}});
    check_clusters(clusters, 3, Motion::planar);
  };
  EXPECT_NO_THROW(check({{0, 2}, {1}}));
  EXPECT_NO_THROW(check_clusters({}, 0, Motion::planar));
  EXPECT_THROW(check({}), BrokenContract);
  EXPECT_THROW(check({{0, 2}}), BrokenContract);
  EXPECT_THROW(check({{0, 2}, {1}, {}}), BrokenContract);
  EXPECT_THROW(check({{0, 2}, {1, 2}}), BrokenContract);
  EXPECT_THROW(check({{0, 0, 2}, {1}}), BrokenContract);
  EXPECT_THROW(check({{0, 2}, {1, 3}}), BrokenContract);
  EXPECT_THROW(check_clusters({{{0}, Pose2{not_a_number, 0, 0}}}, 1, Motion::planar), BrokenContract);
}

TEST(StageContracts, RatingsAreOneForEachClusterAndAddUp) {
  EXPECT_NO_THROW(check_ratings({}, 0));
  EXPECT_NO_THROW(check_ratings({{0.2, 0.25}, {0.6, 0.75}}, 2));
  EXPECT_THROW(check_ratings({{0.2, 1.0}}, 2), BrokenContract);
  EXPECT_THROW(check_ratings({{0.2, 0.2}, {0.6, 0.6}}, 2), BrokenContract);
  EXPECT_THROW(check_ratings({{0.2, -0.25}, {0.6, 1.25}}, 2), BrokenContract);
  EXPECT_THROW(check_ratings({{not_a_number, 1.0}}, 1), BrokenContract);
  EXPECT_THROW(check_ratings({{0.5, not_a_number}}, 1), BrokenContract);
}

TEST(StageContracts, VerdictsHaveWhatTheySay) {
  const Pose2 pose{1, 2, 3};
  EXPECT_NO_THROW(check_verdict({}, Motion::planar));
  EXPECT_NO_THROW(check_verdict({VerdictKind::localized, pose, {}, "sure"}, Motion::planar));
  EXPECT_NO_THROW(check_verdict({VerdictKind::ambiguous, {}, {pose, pose}, "two"}, Motion::planar));
  EXPECT_THROW(check_verdict({VerdictKind::localized, {}, {}, "sure"}, Motion::planar), BrokenContract);
  EXPECT_THROW(check_verdict({VerdictKind::searching, pose, {}, ""}, Motion::planar), BrokenContract);
  EXPECT_THROW(check_verdict({VerdictKind::ambiguous, {}, {}, "two"}, Motion::planar), BrokenContract);
  EXPECT_THROW(check_verdict({VerdictKind::unknown_place, {}, {}, ""}, Motion::planar), BrokenContract);
  EXPECT_THROW(check_verdict({VerdictKind::localized, Pose2{infinite, 0, 0}, {}, ""}, Motion::planar),
               BrokenContract);
  EXPECT_THROW(check_verdict({VerdictKind::ambiguous, {}, {Pose2{0, not_a_number, 0}}, ""}, Motion::planar),
               BrokenContract);
  Verdict sure{VerdictKind::localized, pose, {}, "sure", PoseEstimate{pose, 0.9}};
  EXPECT_NO_THROW(check_verdict(sure, Motion::planar));
  sure.estimate->confidence = 1.1;
  EXPECT_THROW(check_verdict(sure, Motion::planar), BrokenContract);
  sure.estimate = PoseEstimate{Pose2{not_a_number, 0, 0}, 0.9};
  EXPECT_THROW(check_verdict(sure, Motion::planar), BrokenContract);
}

TEST(StageContracts, PosesInSpaceHavePlacesAndRotations) {
  const auto check = [](const Pose3& pose, Motion motion = Motion::free) {
    check_hypotheses({Hypothesis::by_contact(pose, 0.8)}, 0.5, motion);
  };
  const Pose3 tilted({1, 2, 3}, exponential({0.1, -0.2, 0.3}));
  EXPECT_NO_THROW(check(tilted));
  EXPECT_THROW(check(Pose3(Vector3{1, 2, not_a_number})), BrokenContract);
  EXPECT_THROW(check(Pose3(Vector3{1, 2, 1.1e7})), BrokenContract);
  EXPECT_NO_THROW(check(Pose3(Vector3{1, 2, -1e7})));
  EXPECT_NO_THROW(check(Pose3(Quaternion{1.0 + 0.9e-6, 0, 0, 0})));
  EXPECT_THROW(check(Pose3(Quaternion{1.0 + 1.1e-6, 0, 0, 0})), BrokenContract);
  EXPECT_THROW(check(Pose3(Quaternion{0, 0, 0, 0})), BrokenContract);
  EXPECT_THROW(check(Pose3(Quaternion{1, 0, not_a_number, 0})), BrokenContract);
}

TEST(StageContracts, WhereTheMotionIsPlanarSoAreAllPoses) {
  const auto broken = [](const Pose3& pose, Motion motion) {
    return error_of<BrokenContract>(
        [&] { check_hypotheses({Hypothesis::by_contact(pose, 0.8)}, 0.5, motion); });
  };
  const Pose3 raised(Vector3{1, 2, 0.5});
  const Pose3 tilted({1, 2, 0}, exponential({0, 0.1, 0}));
  EXPECT_EQ(
      broken(raised, Motion::planar),
      "hypothesis 0 has the pose (1, 2, 0.5; 0, 0, 0, 1); where the motion is planar, z is 0 and nothing "
      "tilts");
  EXPECT_THAT(broken(tilted, Motion::planar), testing::HasSubstr("nothing tilts"));
  for (const Motion motion : {Motion::upright, Motion::free}) {
    EXPECT_EQ(broken(raised, motion), "");
    EXPECT_EQ(broken(tilted, motion), "");
  }
  MapData map;
  map.points.push_back({1.0F, 2.0F, 0.0F});
  map.path = {raised};
  EXPECT_THROW(check_map(map, Motion::planar), BrokenContract);
  EXPECT_NO_THROW(check_map(map, Motion::free));
  Sample sample;
  sample.observation.odom_from_robot = tilted;
  EXPECT_THROW(check_sample(sample, Motion::planar), BrokenContract);
  EXPECT_NO_THROW(check_sample(sample, Motion::upright));
  LocalMap local = local_map();
  local.local_from_robot = tilted;
  EXPECT_THROW(check_local_map(local, Motion::planar), BrokenContract);
  EXPECT_THROW(check_clusters({{{0}, raised}}, 1, Motion::planar), BrokenContract);
  EXPECT_THROW(check_verdict({VerdictKind::localized, raised, {}, "sure"}, Motion::planar), BrokenContract);
  EXPECT_NO_THROW(check_verdict({VerdictKind::localized, raised, {}, "sure"}, Motion::free));
}

TEST(StageContracts, WhatThereIsOnlyOneOfHasNoNumber) {
  MapData map;
  map.points.push_back({1.0F, 2.0F, 0.0F});
  map.grid.map_from_grid.x = 2e7;
  EXPECT_EQ(error_of<BrokenContract>([&] { check_map(map, Motion::planar); }),
            "the grid has the pose (20000000, 0, 0); poses are finite, and at most 10000000 m from the "
            "origin along x, y and z");
}

}  // namespace
}  // namespace glocal::test::stage_contracts_test
