#include "matchers/surfel_ransam/surfel_ransam.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <memory>
#include <vector>

#include "boxes.hpp"
#include "files.hpp"
#include "glocal/error.hpp"
#include "matchers/same_answer.hpp"
#include "sources/clouds/cloud_drive.hpp"
#include "sources/clouds/point_cloud_map.hpp"

namespace glocal::surfel_ransam::surfel_ransam_test {
namespace {

using test::Box;
using test::crossing;

const Box hall{{0.0, 0.0, 0.0}, {12.0, 8.0, 3.0}};
const Box cupboard{{5.0, 3.0, 0.0}, {5.5, 5.5, 1.6}};
const std::vector<Box> furniture = {{{0.0, 6.0, 0.0}, {3.0, 8.0, 1.2}},
                                    {{8.5, 0.0, 0.0}, {9.0, 3.0, 3.0}},
                                    {{10.0, 5.0, 0.0}, {11.0, 7.0, 0.8}}};

/// Points of a box's six faces, 0.08 m apart.
void add_faces(Points& points, const Box& box) {
  constexpr double apart = 0.08;
  for (int axis = 0; axis < 3; ++axis) {
    const int u = (axis + 1) % 3;
    const int v = (axis + 2) % 3;
    for (double a = box.least[u]; a <= box.most[u]; a += apart) {
      for (double b = box.least[v]; b <= box.most[v]; b += apart) {
        for (const double side : {box.least[axis], box.most[axis]}) {
          Vector3 p;
          p[axis] = side;
          p[u] = a;
          p[v] = b;
          points.push_back(as_point(p));
        }
      }
    }
  }
}

std::shared_ptr<const GlobalMap> map_of(const std::vector<Box>& boxes) {
  MapData data;
  data.resolution = 0.05;
  add_faces(data.points, hall);
  for (const Box& box : boxes) add_faces(data.points, box);
  return std::make_shared<const GlobalMap>(std::move(data));
}

const std::shared_ptr<const GlobalMap>& furnished() {
  static const auto map = map_of(furniture);
  return map;
}

/// A lidar of 16 beams in the furnished hall, ray by ray.
Points scan_at(const Pose3& map_from_robot) {
  Points hits;
  Rng rng(7);
  for (int ring = 0; ring < 16; ++ring) {
    for (int step = 0; step < 360; ++step) {
      const double up = radians(-15.0 + 2.0 * ring);
      const double turn = radians(step + 0.01);
      const Vector3 ray{std::cos(up) * std::cos(turn), std::cos(up) * std::sin(turn), std::sin(up)};
      const Vector3 in_map = map_from_robot.rotation * ray;
      double range = crossing(hall, map_from_robot.translation(), in_map)[1];
      for (const Box& box : furniture) {
        const auto [enters, leaves] = crossing(box, map_from_robot.translation(), in_map);
        if (enters > 0.0 && enters < leaves) range = std::min(range, enters);
      }
      const Vector3 hit = (range + rng.normal(0.01)) * ray;
      hits.push_back(as_point(hit));
    }
  }
  return hits;
}

/// A scan as it came, and a local map of it, whose frame is that of the robot.
struct Seen {
  explicit Seen(const Pose3& map_from_robot) {
    latest.scan.hits = scan_at(map_from_robot);
    local.points = latest.scan.hits;
    local.ends = {local.points.size()};
  }
  Observation latest;
  LocalMap local;
};

Pose3 somewhere(Rng& rng, bool upright) {
  const Vector3 place{rng.uniform(1.0, 7.5), rng.uniform(1.0, 5.0), rng.uniform(0.8, 1.5)};
  const Quaternion turn = turn_about_z(rng.uniform(-3.1, 3.1));
  if (upright) return {place, turn};
  return {place, turn * exponential({rng.uniform(-2.0, 2.0), rng.uniform(-2.0, 2.0), 0.0})};
}

SurfelRansam matcher(Motion motion, const SurfelRansam::Params& params = {.pairs = 100000},
                     const std::shared_ptr<const GlobalMap>& map = furnished()) {
  return {params, {.map = map, .motion = motion}};
}

bool is_near(const Pose3& a, const Pose3& b) {
  return distance(a, b) < 0.1 && rotation_between(a, b) < radians(2.0);
}

/// A sensor that lies on its side may see floor, ceiling and two walls alone: these leave it free to slide.
TEST(SurfelRansam, FindsASensorThatIsHeldAnyWayUnlessItMaySlide) {
  Rng rng(1);
  int right = 0;
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Pose3 truth = somewhere(rng, false);
    const Seen seen(truth);
    Rng draws(i);
    const auto found = matcher(Motion::free).match({seen.local, seen.latest, 0.1}, draws).hypotheses;
    ASSERT_GE(found.size(), 2U);
    const bool may_slide = found[1].score > found[0].score - 0.005;
    const bool is_right = is_near(found[0].map_from_local, truth);
    EXPECT_TRUE(is_right || may_slide) << "pose " << i;
    if (is_right) ++right;
  }
  EXPECT_GE(right, 8);
}

TEST(SurfelRansam, ASingleHitFarAwayDoesNoHarm) {
  const Pose3 truth({3.0, 2.0, 1.0}, turn_about_z(0.5));
  Seen seen(truth);
  for (Points* points : {&seen.local.points, &seen.latest.scan.hits})
    points->push_back({2500.0F, 2500.0F, 400.0F});
  seen.local.ends = {seen.local.points.size()};
  Rng draws(1);
  const auto found = matcher(Motion::upright).match({seen.local, seen.latest, 0.1}, draws).hypotheses;
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(is_near(found[0].map_from_local, truth));
}

TEST(SurfelRansam, UprightPosesTurnAboutZAlone) {
  Rng rng(2);
  int right = 0;
  for (std::uint64_t i = 0; i < 10; ++i) {
    const Pose3 truth = somewhere(rng, true);
    const Seen seen(truth);
    Rng draws(i);
    const auto found = matcher(Motion::upright).match({seen.local, seen.latest, 0.0}, draws).hypotheses;
    ASSERT_FALSE(found.empty());
    for (const Hypothesis& h : found) {
      EXPECT_EQ(h.map_from_local.rotation.x(), 0.0);
      EXPECT_EQ(h.map_from_local.rotation.y(), 0.0);
    }
    if (is_near(found.front().map_from_local, truth)) ++right;
  }
  EXPECT_GE(right, 9);
}

// Up to what a contact index may be wrong by.
TEST(SurfelRansam, TheQualityIsTheContactOfTheLocalMap) {
  const Seen seen({{3.0, 2.5, 1.0}, exponential({0.3, 0.2, 1.0})});
  const KdTreeContact surely(furnished()->points(), 0.8 * 0.1);
  const KdTreeContact perhaps(furnished()->points(), 1.2 * 0.1);
  Rng rng(1);
  const auto found = matcher(Motion::free).match({seen.local, seen.latest, 0.0}, rng).hypotheses;
  ASSERT_FALSE(found.empty());
  double last = 1.0;
  for (const Hypothesis& h : found) {
    const Points in_map = moved(seen.local.points, h.map_from_local);
    EXPECT_GE(h.quality, surely.share(in_map, Transform(Pose2{})));
    EXPECT_LE(h.quality, perhaps.share(in_map, Transform(Pose2{})));
    EXPECT_LE(h.score, last);
    last = h.score;
  }
  EXPECT_GT(found.front().quality, 0.95);
}

TEST(SurfelRansam, FindsTheRobotInWhateverFrameTheLocalMapIs) {
  const Pose3 truth{{6.5, 2.0, 1.2}, exponential({0.1, -0.2, 2.0})};
  Seen seen(truth);
  seen.local.local_from_robot = {{4.0, -7.0, 1.0}, exponential({0.5, 0.1, -1.0})};
  seen.local.points = moved(seen.local.points, seen.local.local_from_robot);
  Rng rng(3);
  const auto found = matcher(Motion::free).match({seen.local, seen.latest, 0.1}, rng).hypotheses;
  ASSERT_FALSE(found.empty());
  EXPECT_TRUE(is_near(found.front().map_from_local * seen.local.local_from_robot, truth));
}

// Turned half about its middle, an empty hall is the same.
TEST(SurfelRansam, OfTwoPosesThatAreAlikeItFindsTheOneThatThePriorAllows) {
  const auto empty = map_of({});
  const Pose3 truth({3.0, 2.5, 1.0}, turn_about_z(0.4));
  const Pose3 alike = Pose3({12.0, 8.0, 0.0}, turn_about_z(radians(180.0))) * truth;
  Seen seen(truth);
  seen.local.points = {};
  seen.latest = {};
  const Points walls = moved(empty->points(), inverse(truth));
  for (std::size_t i = 0; i < walls.size(); i += 7) seen.local.points.push_back(walls[i]);
  seen.local.ends = {seen.local.points.size()};
  for (const Pose3& wanted : {truth, alike}) {
    const PoseGate gate({.region = {wanted.x + 1.0, wanted.y, 2.0}, .heading = {}}, {});
    SurfelRansam one({.best = 1, .carried = 1, .pairs = 100000}, {.map = empty, .motion = Motion::upright});
    Rng rng(5);
    for (int step = 0; step < 2; ++step) {
      const auto found = one.match({seen.local, seen.latest, 0.1, gate}, rng).hypotheses;
      ASSERT_EQ(found.size(), 1U);
      EXPECT_TRUE(is_near(found.front().map_from_local, wanted)) << step;
    }
  }
}

TEST(SurfelRansam, WhatTheLatestScanLookedThroughSpeaksAgainstAPose) {
  // A cupboard of the map that is gone.
  std::vector<Box> before = furniture;
  before.push_back(cupboard);
  const auto outdated = map_of(before);
  const Pose3 truth{{3.0, 3.5, 1.0}, turn_about_z(0.4)};
  const Seen seen(truth);
  const auto loss = [&](const std::shared_ptr<const GlobalMap>& map) {
    std::array<double, 2> scores{};
    for (std::size_t i = 0; i < 2; ++i) {
      Rng rng(1);
      const Observation latest = i == 0 ? Observation{} : seen.latest;
      const auto found =
          matcher(Motion::upright, {.pairs = 100000}, map).match({seen.local, latest, 0.1}, rng).hypotheses;
      EXPECT_TRUE(is_near(found.at(0).map_from_local, truth));
      scores[i] = found.at(0).score;
    }
    return scores[0] - scores[1];
  };
  EXPECT_LT(loss(furnished()), 0.02);
  EXPECT_GT(loss(outdated), 0.05);
}

constexpr double voxel_side = 0.1;

bool is_inside(const Box& box, const Vector3& p) {
  return (p.array() >= box.least.array()).all() && (p.array() <= box.most.array()).all();
}

/// All voxels in the hall whose middle is in none of the boxes.
FreeVoxels free_around(const std::vector<Box>& boxes) {
  FreeVoxels free({}, voxel_side);
  for (int i = 0; i < 120; ++i) {
    for (int j = 0; j < 80; ++j) {
      for (int k = 0; k < 30; ++k) {
        const Vector3 middle{voxel_side * (i + 0.5), voxel_side * (j + 0.5), voxel_side * (k + 0.5)};
        if (std::none_of(boxes.begin(), boxes.end(), [&](const Box& box) { return is_inside(box, middle); }))
          free.add(i, j, k);
      }
    }
  }
  return free;
}

/// The hall before its furniture came but for the first piece, and whether it is known to be empty.
std::shared_ptr<const GlobalMap> before_the_furniture(bool is_known) {
  const std::vector<Box> first = {furniture[0]};
  MapData data = map_of(first)->data();
  if (is_known) data.free_voxels = free_around(first);
  return std::make_shared<const GlobalMap>(std::move(data));
}

TEST(SurfelRansam, PointsWhereTheMapIsFreeSpeakAgainstAPose) {
  const Pose3 truth{{5.0, 3.5, 1.0}, turn_about_z(0.4)};
  const Seen seen(truth);
  const auto best = [&](bool is_known, double weight) {
    Rng rng(1);
    const SurfelRansam::Params params{.pairs = 100000, .free_space_weight = weight};
    SurfelRansam made = matcher(Motion::upright, params, before_the_furniture(is_known));
    return made.match({seen.local, seen.latest, 0.0}, rng).hypotheses.at(0);
  };
  const Hypothesis unknown = best(false, 1.0);
  EXPECT_FALSE(unknown.free_space_violation);
  EXPECT_EQ(unknown.score, best(false, 0.0).score);
  const Hypothesis unweighted = best(true, 0.0);
  EXPECT_EQ(unweighted.score, unknown.score);
  const Hypothesis known = best(true, 1.0);
  ASSERT_TRUE(is_near(known.map_from_local, truth));
  ASSERT_TRUE(is_near(unweighted.map_from_local, truth));
  EXPECT_NEAR(known.score, unweighted.score - known.free_space_violation.value(), 0.01);

  // The points one by one: in the hall, outside of its first piece of furniture, and away from both.
  const Points in_map = moved(seen.local.points, known.map_from_local);
  std::size_t violating = 0;
  for (std::size_t i = 0; i < in_map.size(); ++i) {
    const Vector3 at = as_vector(in_map[i]);
    Box smaller = hall;
    Box larger = furniture[0];
    smaller.least.array() += 0.1;
    smaller.most.array() -= 0.1;
    larger.least.array() -= 0.1;
    larger.most.array() += 0.1;
    if (is_inside(smaller, at) && !is_inside(larger, at)) ++violating;
  }
  const double share = static_cast<double>(violating) / static_cast<double>(in_map.size());
  EXPECT_GT(share, 0.05);
  EXPECT_NEAR(known.free_space_violation.value(), share, 0.02);
}

TEST(SurfelRansam, OfTwoHallsThatLookAlikeItTakesTheOneWhereNothingIsKnownToBeFree) {
  // Both lack what the robot sees; the second is 20 m farther on.
  const Vector3 farther{20.0, 0.0, 0.0};
  const std::vector<Box> first = {furniture[0]};
  MapData data = map_of(first)->data();
  const Points once = data.points;
  for (std::size_t i = 0; i < once.size(); ++i) {
    const Point p = once[i];
    data.points.push_back({p.x + static_cast<float>(farther.x()), p.y, p.z});
  }
  data.free_voxels = free_around(first);
  const auto map = std::make_shared<const GlobalMap>(std::move(data));
  const Pose3 truth{{5.0, 3.5, 1.0}, turn_about_z(0.4)};
  const Pose3 other{truth.translation() + farther, truth.rotation};
  const Seen seen(truth);
  const auto scores = [&](double weight) {
    Rng rng(1);
    SurfelRansam made = matcher(Motion::upright, {.pairs = 100000, .free_space_weight = weight}, map);
    std::array<double, 2> found{};
    for (const Hypothesis& h : made.match({seen.local, seen.latest, 0.0}, rng).hypotheses) {
      if (is_near(h.map_from_local, truth)) found[0] = h.score;
      if (is_near(h.map_from_local, other)) found[1] = h.score;
    }
    return found;
  };
  const auto [same_here, same_there] = scores(0.0);
  EXPECT_GT(same_here, 0.5);
  EXPECT_NEAR(same_here, same_there, 0.02);
  const auto [here, there] = scores(1.0);
  EXPECT_GT(there, here + 0.05);
}

TEST(SurfelRansam, TheBestPosesAreCarriedToTheNextStep) {
  const Pose3 truth{{3.0, 2.5, 1.0}, turn_about_z(-2.0)};
  Seen seen(truth);
  SurfelRansam carrying = matcher(Motion::upright, {.pairs = 100000, .rounds = 0});
  Rng rng(1);
  EXPECT_GT(carrying.match({seen.local, seen.latest, 0.1}, rng).proposals, 0U);
  const MatchResult second = carrying.match({seen.local, seen.latest, 0.1}, rng);
  EXPECT_EQ(second.proposals, 0U);
  ASSERT_FALSE(second.hypotheses.empty());
  EXPECT_TRUE(is_near(second.hypotheses.front().map_from_local, truth));
  // Poses in another local frame mean nothing, nor do they after a reset.
  seen.local.epoch = 1;
  EXPECT_GT(carrying.match({seen.local, seen.latest, 0.1}, rng).proposals, 0U);
  carrying.reset();
  EXPECT_GT(carrying.match({seen.local, seen.latest, 0.1}, rng).proposals, 0U);
}

TEST(SurfelRansam, AMatchInPiecesComesToTheSameEnd) {
  const Seen seen({{3.0, 2.5, 1.0}, turn_about_z(-2.0)});
  const SurfelRansam::Params params{.pairs = 100000};
  Rng rng(1);
  const MatchResult wanted = matcher(Motion::free, params).match({seen.local, seen.latest, 0.1}, rng);
  EXPECT_FALSE(wanted.goes_on);
  for (const std::size_t looks : {1U, 10U, 1'000'000'000U}) {
    SurfelRansam in_pieces(params, {.map = furnished(), .motion = Motion::free, .looks_per_step = looks});
    Rng same(1);
    MatchResult found = in_pieces.match({seen.local, seen.latest, 0.1}, same);
    EXPECT_EQ(found.goes_on, looks < 1000);
    EXPECT_FALSE(found.hypotheses.empty()) << "of what was found so far";
    while (found.goes_on) found = in_pieces.go_on(seen.local, looks);
    test::expect_same_answer(found, wanted);
  }
}

TEST(SurfelRansam, AStepMakesUpForWhatTheOneBeforeHasLeft) {
  const Seen seen({{3.0, 2.5, 1.0}, turn_about_z(-2.0)});
  SurfelRansam hurried({.pairs = 100000, .rounds = 0},
                       {.map = furnished(), .motion = Motion::upright, .looks_per_step = 1});
  Rng rng(1);
  const auto match = [&] { return hurried.match({seen.local, seen.latest, 0.1}, rng); };
  ASSERT_TRUE(match().goes_on);
  EXPECT_GT(match().proposals, 0U);
  for (int i = 0; i < 24; ++i) (void)match();
  EXPECT_EQ(match().proposals, 0U) << "no step has rounds of its own but the first";
}

TEST(SurfelRansam, PosesThatAVerifierHasFoundAreJudgedAsItsOwnAndCarriedOn) {
  const Pose3 truth{{3.0, 2.5, 1.0}, turn_about_z(-2.0)};
  const Seen seen(truth);
  Rng rng(1);
  const MatchResult own = matcher(Motion::upright).match({seen.local, seen.latest, 0.1}, rng);
  ASSERT_TRUE(is_near(own.hypotheses.at(0).map_from_local, truth));

  // One that has looked elsewhere.
  SurfelRansam misled = matcher(Motion::upright, {.pairs = 100000, .rounds = 0});
  const PoseGate elsewhere({.region = {9.0, 6.0, 1.5}, .heading = {}}, {});
  (void)misled.match({seen.local, seen.latest, 0.0, elsewhere}, rng);
  const Pose3 beside{truth.translation() + Vector3{0.08, -0.06, 0.05}, turn_about_z(0.03) * truth.rotation};
  const Pose3 wrong{{6.0, 4.0, 1.0}, turn_about_z(0.5)};
  const auto taken_up =
      misled.rescore({Hypothesis::by_contact(beside, 0.9), Hypothesis::by_contact(wrong, 0.8)}, seen.local);
  ASSERT_EQ(taken_up.size(), 2U);
  EXPECT_TRUE(is_near(taken_up[0].map_from_local, truth));
  EXPECT_NEAR(taken_up[0].score, own.hypotheses.front().score, 0.02);
  EXPECT_NEAR(taken_up[0].quality, own.hypotheses.front().quality, 0.02);
  EXPECT_GE(taken_up[1].score, 0.0);
  EXPECT_LT(taken_up[1].score, taken_up[0].score - 0.2);
  const MatchResult next = misled.match({seen.local, seen.latest, 0.1}, rng);
  EXPECT_EQ(next.proposals, 0U);
  ASSERT_FALSE(next.hypotheses.empty());
  EXPECT_TRUE(is_near(next.hypotheses.front().map_from_local, truth));
}

TEST(SurfelRansam, AnswersAlikeAfterAReset) {
  const Seen seen({{7.0, 5.0, 1.3}, exponential({1.0, 0.2, 1.0})});
  SurfelRansam same = matcher(Motion::free);
  const auto answer = [&] {
    same.reset();
    Rng rng(4);
    return same.match({seen.local, seen.latest, 0.0}, rng);
  };
  const MatchResult first = answer();
  const MatchResult again = answer();
  ASSERT_EQ(first.hypotheses.size(), again.hypotheses.size());
  for (std::size_t i = 0; i < first.hypotheses.size(); ++i) {
    EXPECT_EQ(first.hypotheses[i].map_from_local, again.hypotheses[i].map_from_local);
    EXPECT_EQ(first.hypotheses[i].score, again.hypotheses[i].score);
  }
  EXPECT_EQ(first.proposals, again.proposals);
  EXPECT_EQ(first.points_tested, again.points_tested);
}

TEST(SurfelRansam, FindsNothingForAnEmptyLocalMap) {
  Rng rng(1);
  EXPECT_TRUE(matcher(Motion::free).match({{}, {}, 0.0}, rng).hypotheses.empty());
}

TEST(SurfelRansam, AMapWithoutSurfacesIsAnError) {
  MapData line;
  for (int i = 0; i < 100; ++i) line.points.push_back({0.1F * static_cast<float>(i), 0.0F, 0.0F});
  const auto map = std::make_shared<const GlobalMap>(std::move(line));
  EXPECT_THROW((void)matcher(Motion::free, {}, map), ConfigError);
}

TEST(SurfelRansam, FindsScansOfABuilding) {
  const std::filesystem::path folder = test::dataset("lidar3d/fr_079");
  if (folder.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  const SourceSetup setup;
  clouds::PointCloudMap::Params map_params;
  map_params.path = test::file_path(folder / "map.pcd");
  const auto map = std::make_shared<const GlobalMap>(clouds::PointCloudMap(map_params, setup).load());
  clouds::CloudDrive::Params scan_params;
  scan_params.folder = test::file_path(folder / "scans");
  scan_params.reference = test::file_path(folder / "scans/poses.tum");
  clouds::CloudDrive scans(scan_params, setup);
  SurfelRansam in_building = matcher(Motion::free, {}, map);
  for (std::uint64_t i = 0; i < 5; ++i) {
    const auto sample = scans.next();
    ASSERT_TRUE(sample && sample->map_from_robot);
    LocalMap local;
    local.points = sample->observation.scan.hits;
    local.ends = {local.points.size()};
    in_building.reset();
    Rng rng(i);
    const auto found = in_building.match({local, sample->observation, 0.1}, rng).hypotheses;
    ASSERT_FALSE(found.empty());
    EXPECT_LT(distance(found.front().map_from_local, *sample->map_from_robot), 0.3);
    EXPECT_LT(rotation_between(found.front().map_from_local, *sample->map_from_robot), radians(3.0));
  }
}

}  // namespace
}  // namespace glocal::surfel_ransam::surfel_ransam_test
