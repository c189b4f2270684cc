// glocal convert.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "app/program.hpp"
#include "sources/bags/recordings.hpp"

namespace glocal::test::convert_test {
namespace {

using testing::HasSubstr;

class ConvertCommand : public CommandLine {
 protected:
  ConvertCommand() {
    std::ofstream(file("drive.log")) << "TRUEPOS 5 6 0 0 0 0 1.5 host 1.5\n"
                                        "FLASER 3 1 2 3 0.1 0 0 0 0 0 1.5 host 1.5\n"
                                        "FLASER 3 1 2 3 1.1 0 0 1 0 0 2.5 host 2.5\n";
  }
  [[nodiscard]] Answer convert(const std::string& in, const std::string& out, const std::string& more = "") {
    return run("convert " + file(in) + " -o " + file(out) + " " + more);
  }
  [[nodiscard]] std::ptrdiff_t entries() const {
    return std::distance(std::filesystem::directory_iterator(folder_.path()),
                         std::filesystem::directory_iterator());
  }
};

TEST_F(ConvertCommand, ALogBecomesMcapAndALogAgain) {
  const Answer there = good(convert("drive.log", "drive.mcap"));
  EXPECT_EQ(there.out, "2 scans, 1 of them with reference pose, in " + file("drive.mcap") + "\n");
  const Answer info = run("bag info --json " + file("drive.mcap"));
  const auto json = nlohmann::json::parse(info.out);
  EXPECT_EQ(json["path_m"], 1.0);
  EXPECT_EQ(json["topics"][0]["topic"], "/reference");
  EXPECT_EQ(json["topics"][1]["scan"]["beams"], 3);
  good(convert("drive.mcap", "back.log", "--reference /reference"));
  EXPECT_THAT(content("back.log"), HasSubstr("TRUEPOS 5 6 0 "));
  EXPECT_THAT(content("back.log"), HasSubstr(" 80 0 0 3 1 2 3 0 0.1 0 0 0 0 0 0 0 0 0 0 1.500000 glocal"));
}

TEST_F(ConvertCommand, McapCanBeCopied) {
  good(convert("drive.log", "drive.mcap"));
  const Answer answer = good(convert("drive.mcap", "copy.mcap"));
  EXPECT_EQ(answer.out, "6 messages in " + file("copy.mcap") + "\n");
  EXPECT_EQ(content("copy.mcap").size(), content("drive.mcap").size());
}

TEST_F(ConvertCommand, MessagesOfRos1ThatAreNotKnownAreLeftOut) {
  using namespace bags;
  const std::string header = le<std::uint32_t>(0) + ros1_time(5, 6) + sized("map");
  const std::string pose(std::size_t{7} * 8, '\0');
  folder_.write("a.bag", ros1_magic + ros1_bag_header() +
                             ros1_chunk(ros1_connection(0, "/pose", "geometry_msgs/PoseStamped") +
                                        ros1_connection(1, "/imu", "sensor_msgs/Imu") +
                                        ros1_message(0, 5, header + pose) + ros1_message(1, 6, "imu") +
                                        ros1_message(1, 7, "imu")));
  const Answer answer = good(convert("a.bag", "a.mcap"));
  EXPECT_EQ(answer.out, "1 messages in " + file("a.mcap") + "\n");
  EXPECT_THAT(answer.err,
              HasSubstr("a.bag: 2 messages of /imu are left out: the definition of sensor_msgs/Imu "
                        "for ROS 2 is not known"));
  const auto info = nlohmann::json::parse(run("bag info --json " + file("a.mcap")).out);
  EXPECT_EQ(info["topics"][0]["type"], "geometry_msgs/PoseStamped");
  EXPECT_EQ(info["topics"][0]["encoding"], "cdr");
}

TEST_F(ConvertCommand, AFolderOfCloudsBecomesMcapAndAFolderAgain) {
  std::filesystem::create_directory("clouds");
  for (const char* name : {"clouds/10.250000.pcd", "clouds/10.750000.pcd"}) {
    std::ofstream(name) << "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\nWIDTH 1\n"
                           "HEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 1\nDATA ascii\n1 2 3\n";
  }
  const std::string odometry =
      "10.250000 0.000000 0.000000 0.500000 0.000000000 0.000000000 0.000000000 1.000000000\n"
      "10.750000 1.000000 0.000000 0.500000 0.600000000 0.000000000 0.000000000 0.800000000\n";
  std::ofstream("clouds/odometry.tum") << odometry;
  good(convert("clouds", "drive.mcap"));
  good(convert("drive.mcap", "back/"));
  EXPECT_EQ(content("back/odometry.tum"), odometry);
  EXPECT_TRUE(std::filesystem::exists("back/10.250000.pcd"));
  EXPECT_TRUE(std::filesystem::exists("back/10.750000.pcd"));
  EXPECT_FALSE(std::filesystem::exists("back/reference.tum"));
  good(convert("back", "again.mcap"));
  EXPECT_EQ(content("again.mcap"), content("drive.mcap"));
  good(convert("drive.mcap", "back/", "--force"));

  EXPECT_THAT(refusal(convert("drive.mcap", "a.log")),
              HasSubstr("has clouds, which cannot be written as a CARMEN log"));
  EXPECT_THAT(refusal(convert("clouds", "a.log")),
              HasSubstr("has clouds, which cannot be written as a CARMEN log"));
  EXPECT_THAT(refusal(convert("clouds", "other/")),
              HasSubstr("is a folder of clouds already; name --out *.mcap"));
  EXPECT_THAT(refusal(convert("drive.log", "other/")),
              HasSubstr("has planar scans, which are no clouds in space"));
  EXPECT_THAT(refusal(convert("drive.mcap", "back/")), HasSubstr("the folder exists and is not empty"));
}

TEST_F(ConvertCommand, WhatCannotBeIsSaidAndLeavesNothing) {
  good(convert("drive.log", "drive.mcap"));
  EXPECT_THAT(refusal(convert("drive.log", "other.log")),
              HasSubstr("is a CARMEN log already; name --out *.mcap"));
  EXPECT_THAT(refusal(convert("drive.log", "a.bag")), HasSubstr("a.bag: error: the name says no format"));
  EXPECT_THAT(refusal(convert("none.log", "a.mcap")),
              HasSubstr("none.log: error: there is no such file or folder"));
  EXPECT_THAT(refusal(convert("drive.log", "drive.mcap")), HasSubstr("drive.mcap: error: the file exists"));
  EXPECT_THAT(
      refusal(convert("drive.log", "a.mcap", "--scans /scan")),
      HasSubstr("a CARMEN log says which scans, odometry and reference poses it has: leave out --scans"));
  EXPECT_THAT(refusal(convert("drive.mcap", "a.mcap", "--scans /scan")),
              HasSubstr("all topics of a recording are copied to MCAP: leave out --scans"));
  EXPECT_THAT(refusal(convert("drive.mcap", "a.log", "--reference world")),
              HasSubstr("tf does not connect world with base_link"));
  EXPECT_THAT(refusal(convert("drive.mcap", "a.log", "--scans /none")),
              HasSubstr("has no topic /none with scans; set --scans to one of /scan"));
  EXPECT_THAT(refusal(convert("drive.mcap", "a.log", "--odometry /none")),
              HasSubstr("it has none at all: leave out --odometry"));
  EXPECT_THAT(refusal(convert("drive.mcap", "a.log", "--odom-frame world")),
              HasSubstr("set --odom-frame and --base-frame to frames of the tree"));
  std::ofstream("bad.log") << "FLASER 3 1 2 3 0.1 0 0 0 0 0 1.5 host 1.5\nFLASER 3 1\n";
  EXPECT_THAT(refusal(convert("bad.log", "drive.mcap", "--force")),
              HasSubstr("bad.log:2: error: FLASER says 3 readings"));
  EXPECT_EQ(entries(), 5) << "two logs, a recording, and what the commands said";
  good(convert("drive.log", "drive.mcap", "--force"));
}

}  // namespace
}  // namespace glocal::test::convert_test
