// Where on a drive trials start.
#include "evaluation/running/drive.hpp"

#include <gmock/gmock.h>

#include "files.hpp"
#include "framework/pipeline/fakes.hpp"

namespace glocal::test::drive_test {
namespace {

using testing::ElementsAre;

Sample sample_at(const Pose2& odom_from_robot, int segment = 0) {
  Sample sample;
  sample.observation.odom_from_robot = odom_from_robot;
  sample.segment = segment;
  return sample;
}

Drive drive_of(std::vector<Sample> samples) {
  ListedSamples source({std::move(samples)});
  return read_drive(source);
}

/// n samples, a metre apart along x; the reference is where odometry is.
Drive straight(int n, bool with_reference = true) {
  std::vector<Sample> samples;
  for (int i = 0; i < n; ++i) {
    samples.push_back(sample_at({static_cast<double>(i), 0.0, 0.0}));
    if (with_reference) samples.back().map_from_robot = Pose2{static_cast<double>(i), 0.0, 0.0};
  }
  return drive_of(std::move(samples));
}

std::vector<std::size_t> starts(const TrialsConfig& config, const Drive& drive,
                                const GlobalMap& map = *map_of_one_point()) {
  return trial_starts(config, drive, map);
}

std::string fault(const TrialsConfig& config, const Drive& drive,
                  const GlobalMap& map = *map_of_one_point()) {
  return error_of([&] { return starts(config, drive, map); });
}

TEST(Drive, ItsPathIsThatOfOdometry) {
  Drive drive = drive_of({sample_at({0, 0, 0}), sample_at({3, 4, 1}), sample_at({3, 4, 2})});
  EXPECT_THAT(drive.path_m, ElementsAre(0.0, 5.0, 5.0));
  EXPECT_EQ(drive.samples.size(), 3U);
}

TEST(Drive, GapsBetweenSegmentsAreNotDriven) {
  const Drive drive = drive_of(
      {sample_at({0, 0, 0}, 0), sample_at({1, 0, 0}, 0), sample_at({50, 0, 0}, 1), sample_at({50, 2, 0}, 1)});
  EXPECT_THAT(drive.path_m, ElementsAre(0.0, 1.0, 1.0, 3.0));
}

TEST(TrialStarts, WholeStartsAtTheBeginning) {
  EXPECT_THAT(starts({.starts_m = {}, .whole = true}, straight(15)), ElementsAre(0));
}

TEST(TrialStarts, EverySoManyMetres) {
  EXPECT_THAT(starts({.every_m = 6.0, .starts_m = {}}, straight(15)), ElementsAre(0, 6, 12));
  EXPECT_THAT(starts({.every_m = 7.0, .starts_m = {}}, straight(15)), ElementsAre(0, 7, 14));
  // The first sample that has come so far; 0, 2.5, 5, 7.5.
  EXPECT_THAT(starts({.every_m = 2.5, .starts_m = {}}, straight(9)), ElementsAre(0, 3, 5, 8));
  // Several places before one sample are one start.
  EXPECT_THAT(starts({.every_m = 0.4, .starts_m = {}}, straight(3)), ElementsAre(0, 1, 2));
}

TEST(TrialStarts, OnAMapOfPointsAloneLieNearThese) {
  MapData data;
  data.points.push_back({4.0F, 0.0F, 3.0F});
  const GlobalMap map(std::move(data));
  // sqrt(3^2 + 1.5^2) = 3.35 m to the points beside, 3 m straight up.
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 1, .within_map_m = 3.1}, straight(9), map),
              ElementsAre(4));
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 1, .within_map_m = 3.5}, straight(9), map),
              ElementsAre(3, 4, 5));
}

TEST(TrialStarts, AtGivenPlaces) {
  EXPECT_THAT(starts({.starts_m = {3.5, 9.0, 14.0}}, straight(15)), ElementsAre(4, 9, 14));
  EXPECT_THAT(starts({.starts_m = {9.0, 3.5, 9.0}}, straight(15)), ElementsAre(4, 9));
}

TEST(TrialStarts, AtEveryNthObservation) {
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 4}, straight(9)), ElementsAre(0, 4, 8));
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 1}, straight(3)), ElementsAre(0, 1, 2));
}

TEST(TrialStarts, NeedObservationsLeftInTheirSegment) {
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 1, .min_steps = 3}, straight(5)), ElementsAre(0, 1, 2));
  const Drive interrupted = drive_of(
      {sample_at({0, 0, 0}, 0), sample_at({1, 0, 0}, 0), sample_at({2, 0, 0}, 1), sample_at({3, 0, 0}, 1)});
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 1, .min_steps = 2}, interrupted), ElementsAre(0, 2));
}

TEST(TrialStarts, LieNearThePathTheMapWasRecordedFrom) {
  MapData data;
  data.points.push_back({});
  data.path = {Pose2{0, 0, 0}, Pose2{8, 1, 0}};
  const GlobalMap map(std::move(data));
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 1, .within_map_m = 1.0}, straight(11), map),
              ElementsAre(0, 1, 8));
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 5, .within_map_m = 0.0}, straight(11), map),
              ElementsAre(0, 5, 10));
  // Without a reference nobody knows.
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 5, .within_map_m = 1.0}, straight(11, false), map),
              ElementsAre(0, 5, 10));
}

TEST(TrialStarts, LieNearFreeCellsWhereThePathIsNotKnown) {
  MapData data;
  data.points.push_back({});
  // Cells of 1 m from (-0.5, -0.5) on: the third is free, the sixth occupied, all others unknown.
  data.grid = {{-0.5, -0.5, 0.0}, 1.0, 11, 1, PackedCells(11, Cell::unknown)};
  data.grid.cell(2, 0) = Cell::free;
  data.grid.cell(5, 0) = Cell::occupied;
  const GlobalMap map(std::move(data));
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 1, .within_map_m = 0.4}, straight(11), map),
              ElementsAre(2));
  EXPECT_THAT(starts({.starts_m = {}, .every_scan = 1, .within_map_m = 1.0}, straight(11), map),
              ElementsAre(1, 2, 3));
}

TEST(TrialStarts, AreLookedForInTheFrameOfAMapFarAway) {
  Drive drive = straight(11);
  for (Sample& sample : drive.samples)
    sample.map_from_robot = shifted(*sample.map_from_robot, {500'000.0, 4'000'000.0, 0.0});
  const auto starts_on = [&](MapData data) {
    data.origin = {500'000.0, 4'000'000.0, 0.0};
    return starts({.starts_m = {}, .every_scan = 1, .within_map_m = 1.0}, drive, GlobalMap(std::move(data)));
  };
  MapData data;
  data.points.push_back({4.0F, 0.5F, 0.0F});
  EXPECT_THAT(starts_on(data), ElementsAre(4)) << "near points";
  data.grid = {{-0.5, -0.5, 0.0}, 1.0, 11, 1, PackedCells(11, Cell::unknown)};
  data.grid.cell(2, 0) = Cell::free;
  EXPECT_THAT(starts_on(data), ElementsAre(1, 2, 3)) << "near free cells";
  data.path = {Pose2{8, 1, 0}};
  EXPECT_THAT(starts_on(data), ElementsAre(8)) << "near the path";
}

TEST(TrialStarts, SayWhyThereAreNone) {
  EXPECT_EQ(fault({.starts_m = {}, .whole = true}, drive_of({})),
            "error: observations: the drive has no observation; check the source and its segments");
  EXPECT_EQ(
      fault({.every_m = 2.0, .starts_m = {}, .min_steps = 6}, straight(5)),
      "error: trials: none of 3 starts along the drive of 4.0 m lies within 0 m of the mapped area with "
      "at least 6 observations left; use other starts, another segment of the drive, a larger "
      "trials.within_map_m or a smaller trials.min_steps");
  MapData data;
  data.points.push_back({});
  data.path = {Pose2{0, 30, 0}};
  EXPECT_EQ(
      fault({.starts_m = {}, .every_scan = 1, .within_map_m = 2.5}, straight(2), GlobalMap(std::move(data))),
      "error: trials: none of 2 starts along the drive of 1.0 m lies within 2.5 m of the mapped area "
      "with at least 1 observations left; use other starts, another segment of the drive, a larger "
      "trials.within_map_m or a smaller trials.min_steps");
  EXPECT_EQ(fault({.starts_m = {1.0, 99.0}}, straight(5)),
            "error: trials: starts_m: 99 m is beyond the drive, which ends after 4.0 m; leave it out");
}

TEST(TrialStarts, MoreThanAMillionAreRefused) {
  EXPECT_EQ(
      fault({.every_m = 1e-9, .starts_m = {}}, straight(15)),
      "error: trials: every_m 1e-09 m makes 1.4e+10 starts along the drive of 14.0 m, at most a million "
      "are allowed; raise it");
}

TEST(TrialStarts, AreFoundQuicklyInALongDrive) {
  EXPECT_EQ(starts({.starts_m = {}, .every_scan = 1}, straight(200000)).size(), 200000U);
}

TEST(ChosenStarts, AreThoseThatAreNamedAndKeepTheirNumbers) {
  const std::vector<std::size_t> all = {0, 4, 9, 15};
  TrialsConfig config;
  EXPECT_EQ(chosen_starts(config, all), all);
  EXPECT_EQ(start_number(config, 2), 2U);
  config.only = {1.0, 3.0};
  EXPECT_THAT(chosen_starts(config, all), ElementsAre(4, 15));
  EXPECT_EQ(start_number(config, 1), 3U);
  config.only = {4.0};
  EXPECT_EQ(error_of([&] { return chosen_starts(config, all); }),
            "error: trials.only: there is no start 4; the starts are 0 to 3");
}

}  // namespace
}  // namespace glocal::test::drive_test
