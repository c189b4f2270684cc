#include "local_mappers/deskew.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "files.hpp"
#include "local_mappers/lidar_odometry.hpp"
#include "samples.hpp"
#include "sources/simulation/lidar_simulation.hpp"
#include "sources/simulation/scene.hpp"

namespace glocal::local_mappers::deskew_test {
namespace {

/// A hall of 14 m x 10 m x 3 m with some things in it.
constexpr const char* hall =
    "size: [14, 10]\n"
    "ceiling: 3\n"
    "walls:\n"
    "  - {points: [[0, 0], [14, 0], [14, 10], [9, 10], [9, 8], [0, 8]], closed: true, height: 3}\n"
    "rectangles:\n"
    "  - {centre: [4, 4], size: [1.5, 0.8], angle_deg: 20, height: 1.2}\n"
    "  - {centre: [11, 1], size: [1, 1.2], height: 2}\n"
    "circles: [{centre: [9.5, 5], radius: 0.3, height: 3}]\n"
    "free_from: [[1, 1]]\n"
    "way_points: [[1, 1], [8, 2], [12, 3], [12, 8], [8, 6.5]]\n";

/// A drive at 2 m/s, of which a scan takes all the time between two observations.
class FastDrive : public testing::Test {
 protected:
  FastDrive() {
    params_.world = test::file_path(folder_.write("world.yaml", hall));
    params_.step_length = 0.2;
    params_.step_turn_deg = 6.0;
    params_.step_seconds = 0.1;
    params_.lidar.beams = 16;
    params_.lidar.azimuth_step_deg = 3.0;
    params_.lidar.scan_time = 0.1;
  }

  [[nodiscard]] std::vector<Sample> samples() const {
    simulation::LidarSimulation source(params_, {});
    return test::all_of(source);
  }

  struct Drift {
    double metres = 0.0;
    double degrees = 0.0;
  };

  /// Root mean square of how far the poses since the first are off.
  [[nodiscard]] static Drift drift(const std::vector<Sample>& samples, const std::string& deskew) {
    LidarOdometry::Params params;
    params.deskew = deskew;
    LidarOdometry mapper(params, {.map = nullptr, .motion = Motion::free});
    Drift squares;
    for (const Sample& sample : samples) {
      mapper.add(sample.observation);
      const Pose3 truth = inverse(*samples.front().map_from_robot) * *sample.map_from_robot;
      squares.metres += std::pow(distance(mapper.map().local_from_robot, truth), 2);
      squares.degrees += std::pow(degrees(rotation_between(mapper.map().local_from_robot, truth)), 2);
    }
    EXPECT_EQ(mapper.map().epoch, 0);
    const auto n = static_cast<double>(samples.size());
    return {std::sqrt(squares.metres / n), std::sqrt(squares.degrees / n)};
  }

  test::TemporaryFolder folder_;
  simulation::LidarDriveParams params_;
};

TEST_F(FastDrive, PointsAreWhereTheyWouldBeSeenFromTheLastPose) {
  params_.lidar.noise = params_.lidar.outliers = params_.lidar.tilt_deg = 0.0;
  simulation::Scene scene(simulation::read_world(params_.world.resolved));
  const auto all = samples();
  std::size_t far_off = 0;
  std::size_t hits = 0;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Pose3& pose = *all[i].map_from_robot;
    const Scan& scan = all[i].observation.scan;
    const auto still = deskewed(scan, {inverse(*all[i - 1].map_from_robot) * pose, 0.1});
    ASSERT_TRUE(still);
    ASSERT_EQ(still->hits.size(), scan.hits.size());
    EXPECT_TRUE(still->times.empty());
    for (std::size_t k = 0; k < scan.hits.size(); ++k) {
      // Seen from where the robot was then, what it has hit is where it is now said to be.
      const double share = 1.0 + scan.times[k] / 0.1;
      const Pose3& last = *all[i - 1].map_from_robot;
      const Pose3 then({last.x + share * (pose.x - last.x), last.y + share * (pose.y - last.y), pose.z},
                       turn_about_z(last.heading() + share * wrap_angle(pose.heading() - last.heading())));
      const Point p = still->hits[k];
      const Point raw = scan.hits[k];
      const Vector3 expected = then * Vector3{raw.x, raw.y, raw.z};
      ASSERT_LT((pose * Vector3{p.x, p.y, p.z} - expected).norm(), 1e-4) << "observation " << i;
      ++hits;
      far_off += (pose * Vector3{raw.x, raw.y, raw.z} - expected).norm() > 0.05 ? 1U : 0U;
    }
  }
  EXPECT_GT(far_off, hits / 2);
}

TEST_F(FastDrive, DriftsFarLessWithDeskewedScans) {
  const auto all = samples();
  const Drift none = drift(all, "none");
  const Drift odometry = drift(all, "odometry");
  const Drift velocity = drift(all, "velocity");
  EXPECT_LT(odometry.metres, 0.6 * none.metres);
  EXPECT_LT(odometry.degrees, 0.3 * none.degrees);
  EXPECT_LT(velocity.metres, 0.6 * none.metres);
  EXPECT_LT(velocity.degrees, 0.5 * none.degrees);
}

TEST_F(FastDrive, DeskewsByTheLastStepWithoutOdometry) {
  auto all = samples();
  for (Sample& sample : all) sample.observation.odom_from_robot = {};
  LidarOdometry::Params params;
  params.prediction = "either";
  LidarOdometry by_default(params, {.map = nullptr, .motion = Motion::free});
  params.deskew = "velocity";
  LidarOdometry by_velocity(params, {.map = nullptr, .motion = Motion::free});
  for (std::size_t i = 0; i < 20; ++i) {
    by_default.add(all[i].observation);
    by_velocity.add(all[i].observation);
  }
  EXPECT_EQ(by_default.map().local_from_robot, by_velocity.map().local_from_robot);
}

TEST(Deskewed, LeavesAloneWhatItKnowsTooLittleOf) {
  Scan scan;
  scan.hits.push_back({1.0F, 0.0F, 0.0F});
  scan.hits.push_back({2.0F, 0.0F, 0.0F});
  const SteadyMotion motion{Pose3(Vector3{1.0, 0.0, 0.0}), 0.2};
  EXPECT_FALSE(deskewed(scan, motion)) << "no times";
  scan.times = {-0.1F, 0.0F};
  EXPECT_FALSE(deskewed(scan, {motion.last_from_now, 0.0})) << "stamps stand still";
  EXPECT_FALSE(deskewed(scan, {motion.last_from_now, -1.0})) << "or run backwards";
  EXPECT_FALSE(deskewed(scan, {motion.last_from_now, 0.04})) << "or are much nearer than the scan is long";
  // Half a metre before the present place, 1 m ahead: half a metre ahead now.
  EXPECT_EQ(deskewed(scan, motion)->hits.x, (std::vector<float>{0.5F, 2.0F}));
  scan.times = {0.0F, 0.1F};
  EXPECT_EQ(deskewed(scan, motion)->hits.x, (std::vector<float>{1.0F, 2.5F})) << "of times to come";
}

}  // namespace
}  // namespace glocal::local_mappers::deskew_test
