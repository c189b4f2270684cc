// Drives on several maps, one after the other.
#include "sources/several/several_drives.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "framework/pipeline/fakes.hpp"
#include "samples.hpp"

namespace glocal::several::several_drives_test {
namespace {

Sample sample(double stamp, const Pose3& odom_from_robot, int segment) {
  Sample s;
  s.observation.stamp = stamp;
  s.observation.odom_from_robot = odom_from_robot;
  s.map_from_robot = odom_from_robot;
  s.segment = segment;
  return s;
}

std::vector<Sample> driven(bool in_lift, std::vector<std::vector<Sample>> drives) {
  Registry<ObservationSource, SourceSetup> sources{"observation_source"};
  SeveralDrives::Params params{.sources = &sources, .in_lift = in_lift};
  for (std::size_t i = 0; i < drives.size(); ++i) {
    const std::string name = "drive_" + std::to_string(i);
    sources.add<test::ListedSamples>(name, "Given samples.", {}, {std::move(drives[i])});
    params.drives.push_back({&sources, "floor " + std::to_string(i), sources.choose(name)});
  }
  SeveralDrives source(params, SourceSetup{});
  return test::all_of(source);
}

std::vector<std::vector<Sample>> two_drives() {
  return {{sample(1.0, Pose2{}, 0), sample(2.0, Pose2{1, 0, 0}, 0), sample(3.0, Pose2{2, 0, 0}, 1)},
          {sample(100.0, Pose2{5, 5, 1.0}, 4), sample(101.0, Pose2{5, 5, 1.0} * Pose2{1, 0, 0.5}, 4)}};
}

TEST(SeveralDrives, AreSegmentsOfTheirOwnOnMapsOfTheirOwn) {
  const auto samples = driven(false, two_drives());
  ASSERT_EQ(samples.size(), 5U);
  std::vector<int> segments;
  std::string maps;
  for (const Sample& s : samples) {
    segments.push_back(s.segment);
    maps += s.map.back();
  }
  EXPECT_EQ(segments, (std::vector{0, 0, 1, 2, 2}));
  EXPECT_EQ(maps, "00011");
  EXPECT_EQ(samples[3].observation.stamp, 100.0);
  EXPECT_EQ(samples[3].observation.odom_from_robot, Pose3(Pose2{5, 5, 1.0}));
}

/// One sample, whose stamp is the seed.
class Seeded final : public ObservationSource {
 public:
  using Params = NoParams;
  Seeded(const Params& /*params*/, const SourceSetup& setup) : seed_(static_cast<double>(setup.seed)) {}
  std::optional<Sample> next() override {
    if (!std::exchange(is_left_, false)) return std::nullopt;
    return sample(seed_, Pose2{}, 0);
  }

 private:
  double seed_;
  bool is_left_ = true;
};

TEST(SeveralDrives, DrawNumbersOfTheirOwn) {
  Registry<ObservationSource, SourceSetup> sources{"observation_source"};
  sources.add<Seeded>("seeded", "Tells its seed.");
  SeveralDrives::Params params{.sources = &sources};
  for (const char* map : {"a", "b", "c"}) params.drives.push_back({&sources, map, sources.choose("seeded")});
  SourceSetup setup;
  setup.seed = 7;
  SeveralDrives source(params, setup);
  std::set<double> seeds;
  for (const Sample& s : test::all_of(source)) seeds.insert(s.observation.stamp);
  EXPECT_EQ(seeds.size(), 3U);
  EXPECT_TRUE(seeds.contains(7.0)) << "the first draws as it would alone";
}

TEST(SeveralDrives, GoOnInALiftAsIfTheRobotHadStood) {
  const auto samples = driven(true, two_drives());
  ASSERT_EQ(samples.size(), 5U);
  EXPECT_EQ(samples[3].segment, 1);  // That of the last before the lift.
  EXPECT_EQ(samples[3].map, "floor 1");
  EXPECT_EQ(samples[3].observation.stamp, 23.0);
  EXPECT_EQ(samples[4].observation.stamp, 24.0);
  const auto expect_near = [](const Pose3& pose, const Pose2& expected) {
    EXPECT_NEAR(pose.x, expected.x, 1e-12);
    EXPECT_NEAR(pose.y, expected.y, 1e-12);
    EXPECT_NEAR(pose.heading(), expected.theta, 1e-12);
  };
  expect_near(samples[3].observation.odom_from_robot, {2, 0, 0});
  expect_near(samples[4].observation.odom_from_robot, {3, 0, 0.5});
  expect_near(*samples[4].map_from_robot, Pose2{5, 5, 1.0} * Pose2{1, 0, 0.5});  // Where it is.
}

TEST(SeveralDrives, KeepUpUpInALift) {
  const Pose3 tilted(Vector3(1, 2, 3), exponential(Vector3(0.1, 0.2, 0.0)));
  const Pose3 level(Vector3(7, 8, 9), turn_about_z(1.0));
  const auto samples = driven(true, {{sample(0.0, level, 0)}, {sample(0.0, tilted, 0)}});
  EXPECT_NEAR(samples[1].observation.odom_from_robot.tilt(), tilted.tilt(), 1e-12);
  EXPECT_NEAR(samples[1].observation.odom_from_robot.heading(), 1.0, 1e-12);
  EXPECT_NEAR(samples[1].observation.odom_from_robot.z, 9.0, 1e-12);
}

}  // namespace
}  // namespace glocal::several::several_drives_test
