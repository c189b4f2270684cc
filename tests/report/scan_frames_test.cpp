#include "report/scan_frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "points.hpp"

namespace glocal::test::scan_frames_test {
namespace {

TEST(ScanFrames, AreOneAfterTheOther) {
  ScanFrames frames(100);
  frames.add(points_at({{2, 0.5F}, {1, -1}}));
  frames.add({});
  frames.add(points_at({{1.2344F, 3}}));
  EXPECT_EQ(frames.to_json().dump(),
            R"({"steps":[0,1,2],"first":[0,2,2,3],"x":[2000,1000,1234],"y":[500,-1000,3000]})");
}

TEST(ScanFrames, LeaveOutEverySecondOrMoreWhereThereAreTooManyPoints) {
  ScanFrames frames(4);
  for (int i = 0; i < 7; ++i) frames.add(points_at({{static_cast<float>(i), 0}, {static_cast<float>(i), 1}}));
  EXPECT_EQ(frames.to_json().dump(),
            R"({"steps":[0,4],"first":[0,2,4],"x":[0,0,4000,4000],"y":[0,1000,0,1000]})");
  frames.keep_at_most(3);
  EXPECT_EQ(frames.to_json()["steps"], std::vector<int>{0});
  frames.keep_at_most(0);
  EXPECT_EQ(frames.to_json()["first"], (std::vector<int>{0, 2}));
}

TEST(ScanFrames, InSpaceHaveHeights) {
  ScanFrames frames(100);
  Points hits = points_of({{1.0F, 2.0F, 0.0F}, {3.0F, 4.0F, 0.5F}});
  frames.add(hits);
  EXPECT_EQ(frames.to_json().dump(),
            R"({"steps":[0],"first":[0,2],"x":[1000,3000],"y":[2000,4000],"z":[0,500]})");
}

TEST(ScanFrames, LeaveOutNoneWhereTheyFit) {
  ScanFrames frames(6);
  for (int i = 0; i < 3; ++i) frames.add(points_at({{1, 0}, {1, 1}}));
  EXPECT_EQ(frames.to_json()["steps"], (std::vector<int>{0, 1, 2}));
}

}  // namespace
}  // namespace glocal::test::scan_frames_test
