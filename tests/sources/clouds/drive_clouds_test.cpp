#include "sources/clouds/drive_clouds.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"

namespace glocal::clouds::drive_clouds_test {
namespace {

using testing::ElementsAre;

class DriveClouds : public testing::Test {
 protected:
  std::vector<DriveCloud> read() {
    return drive_clouds(files_, [&](const std::string& sentence) { warnings_ += sentence; });
  }
  std::string fault() {
    return test::config_error(folder_.path(), [&] { static_cast<void>(read()); });
  }
  void write_clouds(const std::vector<std::string>& names) {
    for (const std::string& name : names) folder_.write(name, "");
  }
  /// Poses at x = 10 times the stamp.
  std::filesystem::path write_tum(const std::string& name, const std::vector<double>& stamps) {
    std::string text;
    for (const double stamp : stamps)
      text += std::to_string(stamp) + " " + std::to_string(10.0 * stamp) + " 0 0 0 0 0 1\n";
    return folder_.write(name, text);
  }
  static std::vector<std::string> names(const std::vector<DriveCloud>& clouds) {
    std::vector<std::string> all;
    for (const DriveCloud& cloud : clouds) all.push_back(cloud.file.filename().string());
    return all;
  }

  test::TemporaryFolder folder_;
  DriveFiles files_{.folder = folder_.path()};
  std::string warnings_;
};

TEST_F(DriveClouds, ComeInTheOrderOfTheirNumbers) {
  write_clouds({"10.pcd", "9.ply", "scan_11.bin.gz", "notes.txt"});
  const auto clouds = read();
  EXPECT_THAT(names(clouds), ElementsAre("9.ply", "10.pcd", "scan_11.bin.gz"));
  EXPECT_EQ(clouds[2].stamp, 11.0);
  write_clouds({"last.pcd"});
  EXPECT_THAT(names(read()), ElementsAre("10.pcd", "9.ply", "last.pcd", "scan_11.bin.gz"));
  EXPECT_EQ(read()[2].stamp, 2.0);
}

TEST_F(DriveClouds, HaveStampsInTheirNames) {
  EXPECT_EQ(stamp_in_name("folder7/000.pcd"), 0.0);
  EXPECT_EQ(stamp_in_name("1305031102.175304.pcd"), 1305031102.175304);
  EXPECT_EQ(stamp_in_name("cloud_0012.ply.xz"), 12.0);
  EXPECT_DOUBLE_EQ(stamp_in_name("1403636579763555584.bin").value(), 1403636579.763555584);
  // Seconds and nanoseconds; a number with fewer digits before the separator is none of seconds.
  EXPECT_DOUBLE_EQ(stamp_in_name("cloud_1583836591_082590976.pcd").value(), 1583836591.082590976);
  EXPECT_DOUBLE_EQ(stamp_in_name("1583836591-182590976.ply.xz").value(), 1583836591.182590976);
  EXPECT_DOUBLE_EQ(stamp_in_name("1418381798123456.bin").value(), 1418381798.123456);
  EXPECT_EQ(stamp_in_name("drive_7_182590976.pcd"), 182590976.0);
  // A dot after the name parts the number from it.
  EXPECT_EQ(stamp_in_name("frame.000123.pcd"), 123.0);
  EXPECT_EQ(stamp_in_name("cloud.1305031102.175304.ply"), 1305031102.175304);
  EXPECT_EQ(stamp_in_name(".5.pcd"), 0.5);
  for (const char* name : {"cloud.pcd", "1.2.3.pcd", ".pcd", "cloud..pcd", "cloud.1.2.3.pcd"})
    EXPECT_FALSE(stamp_in_name(name)) << name;
}

TEST_F(DriveClouds, TakeThePosesOfTheNearestStamp) {
  write_clouds({"1.0.pcd", "2.0.pcd", "3.0.pcd"});
  files_.odometry = write_tum("odometry.tum", {0.5, 0.99, 1.011, 2.0, 2.5, 2.985});
  files_.reference = write_tum("reference.tum", {1.99, 7.0});
  const auto clouds = read();
  EXPECT_NEAR(clouds[0].odometry->x, 9.9, 1e-9);
  EXPECT_NEAR(clouds[2].odometry->x, 29.85, 1e-9);
  EXPECT_FALSE(clouds[0].reference);
  EXPECT_NEAR(clouds[1].reference->x, 19.9, 1e-9);
  EXPECT_THAT(warnings_, testing::EndsWith("has a pose for 1 of 3 clouds; the others have no reference"));
}

TEST_F(DriveClouds, TakePosesInTheirOrderWithoutStamps) {
  write_clouds({"a.pcd", "b.pcd"});
  files_.reference = folder_.write("kitti.txt", "1 0 0 4 0 1 0 5 0 0 1 6\n1 0 0 7 0 1 0 5 0 0 1 6\n");
  files_.odometry = write_tum("odometry.tum", {100.0, 101.0});
  EXPECT_EQ(read()[1].reference->x, 7.0);
  EXPECT_EQ(read()[1].odometry->x, 1010.0);
}

TEST_F(DriveClouds, TakePosesInTheirOrderWhereStampsAreNearByChance) {
  std::vector<std::string> names;
  std::vector<double> tenths, milliseconds;
  for (int i = 0; i < 20; ++i) {
    names.push_back(std::to_string(i) + ".pcd");
    tenths.push_back(0.1 * i);
    milliseconds.push_back(100.0 * i);
  }
  write_clouds(names);
  files_.odometry = write_tum("tenths.tum", tenths);
  files_.reference = write_tum("milliseconds.tum", milliseconds);
  const auto clouds = read();
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    EXPECT_NEAR(clouds[i].odometry->x, 10.0 * tenths[i], 1e-9);
    EXPECT_NEAR(clouds[i].reference->x, 10.0 * milliseconds[i], 1e-9);
  }
  EXPECT_EQ(warnings_, "");
}

TEST_F(DriveClouds, ThatAreCountedAreRefusedWithTimesOfAPart) {
  write_clouds({"0.pcd", "1.pcd", "2.pcd", "3.pcd", "4.pcd"});
  files_.reference = write_tum("reference.tum", {0.0, 0.1, 0.2, 0.3});
  EXPECT_EQ(fault(), "reference.tum: error: has 4 poses for 5 clouds in " + folder_.path().string() +
                         ", and its stamps are times, where the numbers of the clouds count them; give one "
                         "pose for each cloud, or stamps that are the clouds' numbers");
}

TEST_F(DriveClouds, MayHaveAReferenceForAPart) {
  std::vector<std::string> names;
  std::vector<double> shifted, dense;
  for (int i = 0; i < 10; ++i) {
    names.push_back(std::to_string(5.05 + 0.1 * i) + ".pcd");
    shifted.push_back(5.75 + 0.1 * i);
  }
  for (int i = 0; i < 25; ++i) dense.push_back(5.0 + 0.01 * i);
  write_clouds(names);
  files_.reference = write_tum("shifted.tum", shifted);
  auto clouds = read();
  EXPECT_FALSE(clouds[6].reference);
  EXPECT_NEAR(clouds[7].reference->x, 57.5, 1e-9) << "as many poses as clouds, of another part";
  files_.reference = write_tum("dense.tum", dense);
  clouds = read();
  EXPECT_NEAR(clouds[1].reference->x, 51.5, 1e-9);
  EXPECT_FALSE(clouds[3].reference);
}

TEST_F(DriveClouds, WithOtherPosesAreRefused) {
  write_clouds({"0.pcd", "1.pcd"});
  files_.odometry = write_tum("odometry.tum", {1.0, 2.0, 3.0});
  EXPECT_EQ(fault(),
            "odometry.tum: error: has a pose for 1 of 2 clouds; there is none within 0.02 s of '0.pcd'; move "
            "the clouds without odometry away");
  files_.odometry.clear();
  files_.reference = write_tum("reference.tum", {7.0, 8.0, 9.0});
  EXPECT_EQ(fault(), "reference.tum: error: has 3 poses for 2 clouds in " + folder_.path().string() +
                         ", and no stamp is the number of a cloud; give the trajectory of these clouds");
}

TEST_F(DriveClouds, InNoFolderOrWithTheSameNumberAreRefused) {
  EXPECT_THAT(fault(), testing::EndsWith("has no clouds (*.pcd, *.ply, *.bin); give another folder"));
  write_clouds({"scan.1.pcd", "scan.10.pcd"});
  EXPECT_EQ(read()[1].stamp, 10.0) << "other numbers";
  write_clouds({"1.pcd", "01.ply"});
  EXPECT_EQ(fault(), "1.pcd: error: has the same number as '01.ply'; remove one of the two");
  files_.folder = folder_ / "none";
  EXPECT_EQ(fault(), "none: error: cannot be read as a folder: No such file or directory");
}

}  // namespace
}  // namespace glocal::clouds::drive_clouds_test
