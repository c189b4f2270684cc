#include "evaluation/results/map_changes.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace glocal::map_changes_test {
namespace {

/// A room of 8 m x 6 m in cells of 0.05 m, with walls around it and, if asked for, a box of 0.4 m around a
/// place.
class Room {
 public:
  Room() {
    data_.grid = {.map_from_grid = {}, .resolution = 0.05, .width = 160, .height = 120, .cells = {}};
    data_.grid.cells = PackedCells(std::size_t{160} * 120, Cell::free);
    fill(0, 160, 0, 1);
    fill(0, 160, 119, 120);
    fill(0, 1, 0, 120);
    fill(159, 160, 0, 120);
  }
  Room& with_box(double x, double y) {
    const int column = static_cast<int>(std::lround(x / 0.05)), row = static_cast<int>(std::lround(y / 0.05));
    fill(column - 4, column + 4, row - 4, row + 4);
    return *this;
  }
  [[nodiscard]] GlobalMap map() const {
    MapData data = data_;
    data.points = occupied_centres(data.grid);
    return GlobalMap(std::move(data));
  }
  /// What a sensor sees of it, with a beam each degree, all around.
  [[nodiscard]] Scan scan_from(const Pose2& pose) const {
    Scan scan;
    for (int i = 0; i < 360; ++i) {
      const double angle = radians(i);
      const Pose2 direction = pose * Pose2{std::cos(angle), std::sin(angle), 0.0};
      double range = 0.0;
      while (data_.grid.at(pose.x + range * (direction.x - pose.x),
                           pose.y + range * (direction.y - pose.y)) == Cell::free)
        range += 0.01;
      scan.hits.push_back(
          {static_cast<float>(range * std::cos(angle)), static_cast<float>(range * std::sin(angle)), 0.0F});
    }
    return scan;
  }

 private:
  void fill(int west, int east, int south, int north) {
    for (int row = south; row < north; ++row) {
      for (int column = west; column < east; ++column) data_.grid.cell(column, row) = Cell::occupied;
    }
  }
  MapData data_;
};

/// A robot that goes along the room, 2 m from its lower wall.
std::vector<Pose2> way(int steps) {
  std::vector<Pose2> poses;
  for (int i = 0; i < steps; ++i) poses.push_back({2.0 + 0.3 * i, 2.0, 0.1 * i});
  return poses;
}

TEST(MapChanges, AreNoneWhereNothingHasChanged) {
  const Room room = Room().with_box(4, 4);
  const GlobalMap map = room.map();
  MapChanges changes(map);
  // However the poses are off by what localization leaves.
  for (const Pose2& pose : way(12)) changes.add(room.scan_from(pose), pose * Pose2{0.03, -0.03, 0.005});
  EXPECT_TRUE(changes.brought().empty());
  EXPECT_TRUE(changes.taken().empty());
}

TEST(MapChanges, ABoxWasMoved) {
  const GlobalMap map = Room().with_box(4, 4).map();
  const Room room = Room().with_box(5.5, 3.5);
  MapChanges changes(map);
  for (const Pose2& pose : way(12)) changes.add(room.scan_from(pose), pose);
  const auto brought = changes.brought();
  ASSERT_EQ(brought.size(), 1U);
  // It has been seen from below and from both sides: its middle is off by less than half of its width.
  EXPECT_NEAR(brought[0].x, 5.5, 0.2);
  EXPECT_NEAR(brought[0].y, 3.5, 0.2);
  EXPECT_GE(brought[0].views, 3U);
  const auto taken = changes.taken();
  ASSERT_EQ(taken.size(), 1U);
  EXPECT_NEAR(taken[0].x, 4.0, 0.05);
  EXPECT_NEAR(taken[0].y, 4.0, 0.05);
  EXPECT_NEAR(taken[0].width, 0.4, 0.06);
}

TEST(MapChanges, WhatIsSeenTwiceOrFromOnePlaceIsNoChange) {
  const GlobalMap map = Room().map();
  MapChanges changes(map);
  // Somebody is somewhere else in each scan.
  for (const Pose2& pose : way(12)) changes.add(Room().with_box(pose.x + 1.0, 4.0).scan_from(pose), pose);
  EXPECT_TRUE(changes.brought().empty());
  MapChanges standing(map);
  for (int i = 0; i < 20; ++i) standing.add(Room().with_box(4.0, 4.0).scan_from({2, 2, 0}), {2, 2, 0});
  EXPECT_TRUE(standing.brought().empty());
}

/// A trial of which the first three steps are in one local map, the third declares, and all later ones do
/// too.
TEST(MapChanges, OfATrialAreSeenFromItsDeclaredPoses) {
  const GlobalMap map = Room().with_box(4, 4).map();
  const Room room = Room().with_box(5.5, 3.5);
  TrialRecord trial;
  trial.start_sample = 1;
  Drive drive;
  drive.samples.resize(13);
  const auto poses = way(12);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    drive.samples[i + 1].observation.scan = room.scan_from(poses[i]);
    StepRecord record;
    record.result.local_from_robot = inverse(poses[0]) * poses[i];
    if (i >= 2) record.result.verdict.map_from_robot = poses[i];
    trial.records.push_back(record);
  }
  EXPECT_FALSE(changes_json(trial, drive, map)) << "nothing is declared yet";
  trial.steps = 3;
  trial.pose = poses[2];
  const auto json = nlohmann::json::parse(changes_json(trial, drive, map).value());
  ASSERT_EQ(json.at("new").size(), 1U);
  EXPECT_NEAR(json.at("new")[0].at("x").get<double>(), 5.5, 0.2);
  ASSERT_EQ(json.at("gone").size(), 1U);
  EXPECT_NEAR(json.at("gone")[0].at("y").get<double>(), 4.0, 0.05);
  EXPECT_EQ(changes_file(3), "maps/trial_0003/changes.json");
  trial.motion = Motion::upright;
  EXPECT_FALSE(changes_json(trial, drive, map));
}

}  // namespace
}  // namespace glocal::map_changes_test
