#include "sources/conversion/cloud_folder.hpp"

#include <gmock/gmock.h>

#include "files.hpp"
#include "glocal/error.hpp"
#include "sources/bags/bag_drive.hpp"
#include "sources/conversion/recording_drive.hpp"

namespace glocal::conversion::cloud_folder_test {
namespace {

using testing::ElementsAre;

std::string pcd_text(const std::string& points) {
  return "VERSION 0.7\nFIELDS x y z t\nSIZE 4 4 4 4\nTYPE F F F F\nCOUNT 1 1 1 1\nWIDTH 2\nHEIGHT 1\n"
         "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA ascii\n" +
         points;
}

class Clouds : public testing::Test {
 protected:
  Clouds() {
    folder_.write("clouds/10.25.pcd", pcd_text("1 2 3 0\n4 5 6 0.125\n"));
    folder_.write("clouds/10.75.pcd", pcd_text("2 2 3 0\n5 5 6 0.125\n"));
    folder_.write("odometry.tum", "10.25 0 0 0.5 0 0 0 1\n10.75 1 0 0.5 0.6 0 0 0.8\n");
    folder_.write("reference.tum", "10.75 7 8 9 0 0 0 1\n");
  }
  std::filesystem::path as_mcap() {
    CloudFolderReader reader({.folder = folder_ / "clouds",
                              .odometry = folder_ / "odometry.tum",
                              .reference = folder_ / "reference.tum"},
                             [](const std::string&) {});
    std::string bytes;
    McapDriveWriter writer(reader.sensors(), [&](std::string_view more) { bytes += more; });
    counts_ = pass_on(reader, writer, "clouds", [](const std::string&) {});
    return folder_.write("drive.mcap", bytes);
  }

  test::TemporaryFolder folder_;
  DriveCounts counts_;
};

TEST_F(Clouds, AreReadBackFromMcap) {
  bags::BagDrive::Params params;
  params.path = test::file_path(as_mcap());
  params.keyframes = {0.0, 0.0};
  params.voxel_size = 0.0;
  params.deskew = "none";
  params.reference.topic = "/reference";
  EXPECT_EQ(counts_.scans, 2U);
  EXPECT_EQ(counts_.references, 1U);
  bags::BagDrive bag(params, {.motion = Motion::free});
  const auto first = bag.next(), second = bag.next();
  ASSERT_TRUE(first && second);
  EXPECT_FALSE(bag.next());
  EXPECT_EQ(first->observation.stamp, 10.25);
  EXPECT_THAT(first->observation.scan.hits.x, ElementsAre(1.0F, 4.0F));
  EXPECT_THAT(first->observation.scan.hits.z, ElementsAre(3.0F, 6.0F));
  EXPECT_THAT(first->observation.scan.times, ElementsAre(0.0F, 0.125F));
  EXPECT_EQ(second->observation.odom_from_robot, Pose3({1.0, 0.0, 0.5}, {0.8, 0.6, 0.0, 0.0}));
  EXPECT_EQ(second->map_from_robot, Pose3(Vector3{7.0, 8.0, 9.0}));
}

TEST_F(Clouds, NeedOdometry) {
  EXPECT_EQ(test::config_error(
                folder_.path(),
                [&] { CloudFolderReader({.folder = folder_ / "clouds"}, [](const std::string&) {}); }),
            "clouds: error: has no odometry.tum, and a recording says where the robot was at each scan; give "
            "the file with --odometry");
}

}  // namespace
}  // namespace glocal::conversion::cloud_folder_test
