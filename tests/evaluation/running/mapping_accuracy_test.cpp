#include "evaluation/running/mapping_accuracy.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numbers>

#include "files.hpp"

namespace glocal::mapping_accuracy_test {
namespace {

using ::testing::Each;
using ::testing::SizeIs;

/// Believes odometry, and gives up its map after so many observations.
class OdometryMapper final : public LocalMapper {
 public:
  explicit OdometryMapper(std::size_t new_map_after = 1'000'000) : new_map_after_(new_map_after) {}

  void add(const Observation& observation) override {
    if (seen_++ == 0) first_ = observation.odom_from_robot;
    if (seen_ > new_map_after_) map_.epoch = 1;
    map_.local_from_robot = inverse(first_) * observation.odom_from_robot;
  }
  [[nodiscard]] const LocalMap& map() const override { return map_; }
  void reset() override { *this = OdometryMapper(new_map_after_); }

 private:
  std::size_t new_map_after_;
  std::size_t seen_ = 0;
  Pose3 first_;
  LocalMap map_;
};

/// Straight ahead in steps of 0.5 m, with odometry that is `scale` times too long. Each scan is one hit 1 m
/// ahead.
Drive straight(int samples, double scale) {
  Drive drive;
  for (int i = 0; i < samples; ++i) {
    Sample sample;
    sample.map_from_robot = Pose2{5.0, 0.5 * i, radians(90)};
    sample.observation.odom_from_robot = Pose2{0.5 * i * scale, 0.0, 0.0};
    sample.observation.scan.hits.push_back({1.01F, 0.01F, 0.0F});
    drive.samples.push_back(sample);
    drive.path_m.push_back(0.5 * i);
  }
  return drive;
}

TEST(MappingAccuracy, TakesTheErrorOfEachStartByHand) {
  OdometryMapper mapper;
  // 40 m: starts at 0, 5, …, 30 m have 10 m before them; those at 0, 5 and 10 m have 30 m.
  const MappingAccuracy accuracy = measure_mapping(straight(81, 1.01), mapper, {});
  ASSERT_THAT(accuracy.windows, SizeIs(7));
  for (std::size_t i = 0; i < 7; ++i) {
    const MappingWindow& window = accuracy.windows[i];
    EXPECT_EQ(window.first, 10 * i);
    EXPECT_NEAR(window.error.translation_m, 0.1, 1e-9);
    EXPECT_NEAR(window.error.rotation_rad, 0.0, 1e-9);
    // One cell for each of 21 observations, 0.505 m apart.
    EXPECT_EQ(window.occupied_cells, 21U);
    EXPECT_EQ(window.failed.has_value(), i < 3);
    // 0.3 m after 30 m is within 0.5 m.
    EXPECT_FALSE(window.failed.value_or(false));
  }
  // Each start goes on to 30 m where there are as many, else to 10 m.
  EXPECT_THAT(accuracy.add_ms, SizeIs(3 * 61 + 4 * 21));
  EXPECT_THAT(accuracy.add_ms, Each(::testing::Ge(0.0)));
}

TEST(MappingAccuracy, CountsFailuresByTranslationAndByRotation) {
  OdometryMapper mapper;
  const auto all_failed = [&](const Drive& drive) {
    for (const MappingWindow& window : measure_mapping(drive, mapper, {}).windows) {
      if (window.failed.has_value() && !*window.failed) return false;
    }
    return true;
  };
  EXPECT_TRUE(all_failed(straight(81, 1.02)));    // 0.6 m after 30 m
  EXPECT_FALSE(all_failed(straight(81, 1.015)));  // 0.45 m
  Drive turning = straight(81, 1.0);
  // The reference turns by 0.1 degree per sample, 6 degrees in 30 m, and odometry does not notice.
  for (std::size_t i = 0; i < turning.samples.size(); ++i) {
    Pose3& map_from_robot = *turning.samples[i].map_from_robot;
    map_from_robot = map_from_robot * Pose2{0.0, 0.0, radians(0.1) * static_cast<double>(i)};
  }
  EXPECT_TRUE(all_failed(turning));
}

TEST(MappingAccuracy, ANewMapIsAnErrorOfTheWholeWay) {
  OdometryMapper mapper(15);
  const MappingAccuracy accuracy = measure_mapping(straight(61, 1.0), mapper, {});
  ASSERT_THAT(accuracy.windows, SizeIs(5));
  EXPECT_NEAR(accuracy.windows[0].error.translation_m, 10.0, 1e-9);
  EXPECT_NEAR(accuracy.windows[0].error.rotation_rad, std::numbers::pi, 1e-9);
  EXPECT_TRUE(accuracy.windows[0].failed.value());
}

TEST(MappingAccuracy, NoWindowRunsAcrossAnInterruption) {
  Drive drive = straight(81, 1.0);
  for (std::size_t i = 50; i < 81; ++i) drive.samples[i].segment = 1;
  // The way does not grow across the gap.
  for (std::size_t i = 50; i < 81; ++i) drive.path_m[i] -= 0.5;
  OdometryMapper mapper;
  const MappingAccuracy accuracy = measure_mapping(drive, mapper, {});
  for (const MappingWindow& window : accuracy.windows) {
    EXPECT_EQ(drive.samples[window.first].segment, drive.samples[window.first + 20].segment);
    EXPECT_NEAR(window.error.translation_m, 0.0, 1e-9);
    EXPECT_FALSE(window.failed.has_value());
  }
  // The first 24.5 m have starts at 0, 5 and 10 m with 10 m before them; the 15 m after the gap have one at
  // 25 m.
  EXPECT_THAT(accuracy.windows, SizeIs(4));
}

TEST(MappingAccuracy, TakesTheWholeDriveUpToAnInterruption) {
  Drive drive = straight(81, 1.01);
  for (std::size_t i = 61; i < 81; ++i) drive.samples[i].segment = 1;
  OdometryMapper mapper;
  const MappingAccuracy accuracy = measure_mapping(drive, mapper, {.whole = true});
  ASSERT_THAT(accuracy.windows, SizeIs(1));
  EXPECT_NEAR(accuracy.windows[0].error.translation_m, 0.3, 1e-9);
  EXPECT_EQ(accuracy.windows[0].failed, std::nullopt);
  EXPECT_THAT(accuracy.add_ms, SizeIs(61));
}

/// Believes odometry, and keeps its tilt at the start.
class UprightMapper final : public LocalMapper {
 public:
  void add(const Observation& observation) override { map_.local_from_robot = observation.odom_from_robot; }
  [[nodiscard]] const LocalMap& map() const override { return map_; }
  void reset() override { map_ = {}; }

 private:
  LocalMap map_;
};

TEST(MappingAccuracy, WorksInSpace) {
  const Pose3 step({0.5, 0.1, 0.2}, exponential({0.01, 0.02, 0.1}));
  const Pose3 fault({0.0, 0.0, 0.3}, exponential({0.0, 0.1, 0.0}));
  Drive drive;
  Pose3 pose({3.0, 4.0, 5.0}, exponential({0.3, 0.2, 0.1}));
  for (int i = 0; i < 10; ++i) {
    Sample sample;
    sample.map_from_robot = pose;
    sample.observation.odom_from_robot = i < 9 ? pose : pose * fault;
    drive.samples.push_back(sample);
    drive.path_m.push_back(i);
    pose = pose * step;
  }
  UprightMapper mapper;
  const MappingAccuracy accuracy = measure_mapping(drive, mapper, {.whole = true});
  ASSERT_THAT(accuracy.windows, SizeIs(1));
  EXPECT_NEAR(accuracy.windows[0].error.translation_m, 0.3, 1e-9);
  EXPECT_NEAR(accuracy.windows[0].error.rotation_rad, 0.1, 1e-9);
}

TEST(MappingAccuracy, NeedsReferencePoses) {
  Drive drive = straight(81, 1.0);
  drive.samples[7].map_from_robot.reset();
  OdometryMapper mapper;
  EXPECT_THAT(test::error_of([&] { return measure_mapping(drive, mapper, {}); }),
              ::testing::HasSubstr("number 8 has no reference pose"));
}

}  // namespace
}  // namespace glocal::mapping_accuracy_test
