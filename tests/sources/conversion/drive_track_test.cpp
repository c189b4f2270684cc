#include "sources/conversion/drive_track.hpp"

#include <gmock/gmock.h>

#include "files.hpp"
#include "sources/conversion/carmen_drive.hpp"

namespace glocal::conversion::drive_track_test {
namespace {

using testing::HasSubstr;

const std::string raw =
    "FLASER 3 1 2 3 0 0 0 0 0 0 1.5 host 1.5\n"
    "RLASER 3 1 2 3 0 0 0 0 0 0 1.6 host 1.6\n"
    "FLASER 3 1 2 3 1.5 0 0 1 0 0 2.5 host 2.5\n"
    "FLASER 3 1 2 3 1.5 0 0 1 0 0 2.5 host 2.5\n"
    "FLASER 3 1 2 3 2.5 0 0 2 0 0 3.5 host 3.5\n";

class DriveTracks : public testing::Test {
 protected:
  [[nodiscard]] DriveTrack raw_track() const {
    CarmenDriveReader reader(folder_.write("raw.log", raw));
    return track_of(reader);
  }
  [[nodiscard]] std::optional<Pose3> pose_at(const std::string& corrected, double stamp) const {
    ReferencePoses references;
    references.track = read_corrected(folder_.write("corrected", corrected), raw_track());
    return references.map_from_robot(nanoseconds_of(stamp), {});
  }
  [[nodiscard]] std::string fault_of(const std::string& corrected) const {
    return test::error_of([&] { return pose_at(corrected, 1.5); });
  }

  test::TemporaryFolder folder_;
};

TEST_F(DriveTracks, HasTheScansOfTheFirstSensor) {
  const DriveTrack track = raw_track();
  ASSERT_EQ(track.scans.size(), 3U);
  EXPECT_EQ(track.scans[1].odom_from_robot, Pose3(Pose2{1.0, 0.0, 0.0}));
  EXPECT_EQ(track.scans[1].robot_from_sensor.x, 0.5);
  EXPECT_EQ(track.backwards, 1U);
  EXPECT_EQ(track.of_other_sensors, 1U);
}

TEST_F(DriveTracks, ReadsTrajectoriesOfAllKinds) {
  const Pose3 second(Pose2{7.0, 8.0, 0.0});
  EXPECT_EQ(pose_at("# tum\n1.5 0 0 0 0 0 0 1\n2.5 7 8 0 0 0 0 1\n", 2.5), second);
  EXPECT_EQ(pose_at("1 0 0 0 0 1 0 0 0 0 1 0\n1 0 0 7 0 1 0 8 0 0 1 0\n1 0 0 9 0 1 0 9 0 0 1 0\n", 2.5),
            second)
      << "KITTI";
  EXPECT_EQ(pose_at("FLASER 3 1 2 3 0 0 0 0 0 0 1.5 host 1.5\n"
                    "FLASER 3 1 2 3 7 8 0 7 8 0 2.5 host 2.5\n",
                    2.5),
            second)
      << "corrected poses in the place of odometry";
  EXPECT_EQ(pose_at("# CARMEN\nTRUEPOS 1 1 0 0 0 0 1.5 host 1.5\n"
                    "FLASER 3 1 2 3 0 0 0 0 0 0 1.5 host 1.5\n"
                    "TRUEPOS 7 8 0 0 0 0 2.5 host 2.5\n"
                    "FLASER 3 1 2 3 0 0 0 0 0 0 2.5 host 2.5\n",
                    2.5),
            second);
}

TEST_F(DriveTracks, PosesFarApartAreThoseOfTheirScansOnly) {
  const std::string tum = "1.5 1 0 0 0 0 0 1\n2.5004 7 8 0 0 0 0 1\n2.9 7 9 0 0 0 0 1\n";
  EXPECT_TRUE(pose_at(tum, 1.5));
  EXPECT_FALSE(pose_at(tum, 2.0)) << "a second between poses";
  EXPECT_EQ(pose_at(tum, 2.5)->x, 7.0) << "but for rounded stamps";
  EXPECT_TRUE(pose_at(tum, 2.7));
  EXPECT_FALSE(pose_at(tum, 3.5));
}

TEST_F(DriveTracks, SaysWhatIsWrong) {
  EXPECT_THAT(fault_of("1.5 0 0 0 0 0 0 1\n"), HasSubstr("has a single pose"));
  EXPECT_THAT(fault_of("1 0 0 0 0 1 0 0 0 0 1 0\n"),
              HasSubstr("has 1 poses without stamps, and there are 3"));
  EXPECT_THAT(fault_of("-1 0 0 0 0 0 0 1\n"), HasSubstr("is not of the years 1970 to 2037"));
  EXPECT_THAT(fault_of(""), HasSubstr("has no poses"));
}

TEST_F(DriveTracks, JoinsWhatHasAReference) {
  ReferencePoses references;
  references.track.add(nanoseconds_of(2.0), Pose2{7.0, 8.0, 0.0});
  references.track.add(nanoseconds_of(3.0), Pose2{9.0, 8.0, 0.0});
  references.track.settle();
  references.are_of_sensor = true;
  references.shift_ns = nanoseconds_of(0.5);
  JoinedDrive drive(std::make_unique<CarmenDriveReader>(folder_.write("raw.log", raw)), references);
  EXPECT_EQ(drive.sensors().size(), 1U);
  const auto first = drive.next();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->stamp_ns, nanoseconds_of(2.5));
  EXPECT_EQ(first->map_from_robot->x, 6.5) << "half a metre behind the sensor";
  EXPECT_TRUE(drive.next()) << "the same stamp again is up to pass_on()";
  EXPECT_TRUE(drive.next());
  EXPECT_FALSE(drive.next());
}

}  // namespace
}  // namespace glocal::conversion::drive_track_test
