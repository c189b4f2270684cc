#include "evaluation/results/pose_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace glocal::pose_json_test {
namespace {

using Json = nlohmann::ordered_json;

TEST(PoseJson, InThePlaneHasThreeNumbers) {
  EXPECT_EQ(to_json(Pose2{1.5, -2.0, 0.25}, Motion::planar).dump(), R"({"x":1.5,"y":-2.0,"theta":0.25})");
  EXPECT_EQ(pose_of(Json::parse(R"({"x": 1.5, "y": -2, "theta": 0.25})")), (Pose2{1.5, -2.0, 0.25}));
}

TEST(PoseJson, InSpaceComesBackAsItWas) {
  const Pose3 pose({1.5, -2.0, 0.75}, exponential({0.3, -0.2, 2.9}));
  for (const Motion motion : {Motion::upright, Motion::free}) {
    const Json json = to_json(pose, motion);
    EXPECT_EQ(pose_of(Json::parse(json.dump())), pose);
    EXPECT_EQ(json.at("theta"), pose.heading());
  }
}

TEST(PoseJson, InSpaceHasAllKeysEvenWhereThePoseIsPlanar) {
  EXPECT_EQ(to_json(Pose3(), Motion::free).dump(),
            R"({"x":0.0,"y":0.0,"z":0.0,"qx":0.0,"qy":0.0,"qz":0.0,"qw":1.0,"theta":0.0})");
}

TEST(PoseJson, OfTheTwoQuaternionsTheOneWithPositiveWIsWritten) {
  const Pose3 pose(Quaternion{-0.5, 0.5, -0.5, 0.5});
  const Json json = to_json(pose, Motion::free);
  EXPECT_EQ(json.at("qw"), 0.5);
  EXPECT_EQ(json.at("qx"), -0.5);
  EXPECT_EQ(json.at("qy"), 0.5);
  EXPECT_EQ(json.at("qz"), -0.5);
  EXPECT_NEAR(rotation_between(pose_of(json), pose), 0.0, 1e-12);
}

TEST(PoseJson, WhatIsNoPoseIsRefused) {
  for (const char* text : {R"({})", R"({"x": 1, "y": 2})", R"({"x": "a", "y": 2, "theta": 3})",
                           R"({"x": 1, "y": 2, "z": 3, "qx": 0, "qy": 0, "qz": 0})",
                           R"({"x": 1, "y": 2, "z": 3, "qx": 0, "qy": 0, "qz": 0, "qw": 0.9})",
                           R"({"x": 1, "y": 2, "qx": 0, "qy": 0, "qz": 0, "qw": 1})"})
    EXPECT_THROW(static_cast<void>(pose_of(Json::parse(text))), std::exception) << text;
}

TEST(PoseJson, OfATrajectoryHasTheFormOfEvo) {
  EXPECT_EQ(tum_text(Pose2{1.0, -2.0, 0.0}), "1.000000 -2.000000 0 0 0 0.000000000 1.000000000");
  EXPECT_EQ(tum_text(Pose3({1, 2, 3}, {-0.5, 0.5, 0.5, 0.5})),
            "1.000000 2.000000 3.000000 -0.500000000 -0.500000000 -0.500000000 0.500000000");
}

}  // namespace
}  // namespace glocal::pose_json_test
