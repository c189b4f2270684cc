#include "sources/conversion/reference_check.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "glocal/error.hpp"
#include "sources/conversion/map_split.hpp"
#include "temporary_folder.hpp"

namespace glocal::conversion::reference_check_test {
namespace {

constexpr std::int64_t second = 1'000'000'000;

/// A drive on a winding way at changing speed.
Pose2 winding(double t) {
  return {2.0 * t + std::sin(t), std::cos(0.7 * t), std::sin(1.3 * t)};
}

DriveTrack winding_drive(double step_s = 0.2, int scans = 200) {
  DriveTrack drive;
  for (int i = 0; i < scans; ++i) {
    const auto stamp = static_cast<std::int64_t>(i * step_s * 1e9);
    drive.scans.push_back({stamp, winding(i * step_s), {}, Pose3(winding(i * step_s))});
  }
  return drive;
}

TEST(ReferenceCheck, FindsHowLateTheReferenceIs) {
  for (const double late_s : {-0.35, 0.0, 0.5}) {
    ReferencePoses references;
    for (int i = -100; i < 1000; ++i)
      references.track.add(std::llround((i * 0.05 + late_s) * 1e9), winding(i * 0.05));
    references.track.settle();
    const auto shift = time_shift_of(winding_drive(), references);
    ASSERT_TRUE(shift);
    EXPECT_NEAR(shift->shift_s, -late_s, 0.01);
    EXPECT_GT(shift->correlation, 0.98);
  }
}

TEST(ReferenceCheck, SaysNothingOfShiftsThatCannotBeTold) {
  DriveTrack even;
  ReferencePoses references;
  for (int i = 0; i < 100; ++i) {
    even.scans.push_back({i * second / 5, Pose2{0.1 * i, 0.0, 0.0}, {}, std::nullopt});
    references.track.add(i * second / 5, Pose2{0.1 * i, 0.0, 0.0});
  }
  references.track.settle();
  EXPECT_FALSE(time_shift_of(even, references)) << "a straight way at one speed";
  EXPECT_FALSE(time_shift_of(winding_drive(0.2, 15), references)) << "too few scans";
  EXPECT_FALSE(time_shift_of(winding_drive(3.0), references)) << "too far apart";
}

TEST(ReferenceCheck, FindsJumps) {
  DriveTrack drive = winding_drive();
  EXPECT_TRUE(reference_jumps(drive.scans).empty());
  drive.scans[10].map_from_robot.reset();
  for (std::size_t i = 50; i < drive.scans.size(); ++i)
    drive.scans[i].map_from_robot = Pose3(Pose2{0.0, 1.0, 0.0}) * *drive.scans[i].map_from_robot;
  const auto jumps = reference_jumps(drive.scans);
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_EQ(jumps[0].stamp_ns, drive.scans[50].stamp_ns);
  EXPECT_NEAR(jumps[0].distance_m, 1.0, 1e-9);
}

TEST(ReferenceCheck, ComparesRelations) {
  test::TemporaryFolder folder;
  const auto file = folder.write("a.relations",
                                 "# t1 t2 x y z roll pitch yaw\n"
                                 "0 1 1 0 0 0 0 0.5\n"
                                 "1 2 1 0.3 0 0 0 0\n"
                                 "2 90 0 0 0 0 0 0\n");
  const auto relations = read_relations(file);
  ASSERT_EQ(relations.size(), 3U);
  std::vector<TrackedScan> scans;
  Pose3 pose;
  for (int i = 0; i < 3; ++i) {
    scans.push_back({i * second, {}, {}, pose});
    pose = pose * Pose3(Pose2{1.0, 0.0, i == 0 ? 0.5 : 0.0});
  }
  const auto errors = relation_errors(relations, scans, second);
  ASSERT_TRUE(errors);
  EXPECT_EQ(errors->relations, 2U);
  EXPECT_NEAR(errors->mean_m, 0.15, 1e-9);
  EXPECT_NEAR(errors->mean_rad, 0.0, 1e-7);
  EXPECT_FALSE(relation_errors(relations, {}, second));
  EXPECT_THROW(static_cast<void>(read_relations(folder.write("b", "1 2 3\n"))), ConfigError);
  EXPECT_THROW(static_cast<void>(read_relations(folder.write("c", "1 2 3 4 5 6 7 nan\n"))), ConfigError);
  EXPECT_THROW(static_cast<void>(read_relations(folder.write("d", "# none\n"))), ConfigError);
}

TEST(MapSplit, TakesTheLeastThatTheRestComesBackTo) {
  std::vector<TrackedScan> scans;
  for (int i = 0; i <= 100; ++i) {
    const double x = i <= 40 ? i : 80 - i;  // to 40 m, and back by 60 m
    scans.push_back({i * second, Pose2{x, 0.0, 0.0}, {}, Pose3(Pose2{x, 0.0, 0.0})});
  }
  const MapSplit there_and_back = choose_split(scans);
  EXPECT_EQ(segments_yaml(there_and_back.map), "[[0, 0.3]]");
  EXPECT_EQ(segments_yaml(there_and_back.run), "[[0.3, 1]]");
  EXPECT_EQ(segments_yaml(choose_split(scans, 2).map), "[[0, 0.15], [0.5, 0.65]]");
  scans.resize(41);
  const MapSplit one_way = choose_split(scans);
  EXPECT_EQ(segments_yaml(one_way.map), "[[0, 0.1], [0.2, 0.3], [0.4, 0.5], [0.6, 0.7], [0.8, 0.9]]");
  EXPECT_EQ(segments_yaml(one_way.run), "[[0.1, 0.2], [0.3, 0.4], [0.5, 0.6], [0.7, 0.8], [0.9, 1]]");
  EXPECT_EQ(segments_yaml(choose_split(scans, 1).map), "[[0, 0.5]]");
  EXPECT_EQ(segments_yaml(split_drive(scans, 3, 0.5).run), "[[0.1667, 0.3333], [0.5, 0.6667], [0.8333, 1]]");
}

}  // namespace
}  // namespace glocal::conversion::reference_check_test
