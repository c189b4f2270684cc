#include "app/live_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/results/file_io.hpp"
#include "files.hpp"

namespace glocal::app::live_state_test {
namespace {

using test::config_error;
using testing::HasSubstr;

GlobalMap map_of(const std::vector<Point>& points) {
  MapData data;
  for (const Point& p : points) data.points.push_back(p);
  return GlobalMap(std::move(data));
}

LiveState state_on(const GlobalMap& map) {
  return {.map = fingerprint(map),
          .map_from_robot = Pose2{1.0 / 3.0, -2.0, 0.7},
          .covariance = PoseCovariance{1, 2, 3, 4, 5, 6},
          .stamp = 1.5e9 + 0.125,
          .way_since_m = 0.1};
}

TEST(LiveState, IsReadAsItWasWritten) {
  test::TemporaryFolder folder;
  const auto file = folder.path() / "state.json";
  EXPECT_FALSE(read_state(file));
  LiveState state = state_on(map_of({{0.0F, 0.0F, 0.0F}}));
  write_state(file, state);
  EXPECT_EQ(read_state(file), state);
  state.covariance.reset();
  state.map_from_robot = Pose2{5.0, 0.0, 0.0};
  write_state(file, state);
  EXPECT_EQ(read_state(file), state);
}

TEST(LiveState, OfAnotherMapSaysNothing) {
  const GlobalMap map = map_of({{0.0F, 0.0F, 0.0F}, {1.0F, 0.0F, 0.0F}});
  EXPECT_TRUE(expected_from(state_on(map), fingerprint(map)));
  EXPECT_FALSE(expected_from(state_on(map), fingerprint(map_of({{0.0F, 0.0F, 0.0F}, {1.5F, 0.0F, 0.0F}}))));
}

TEST(LiveState, SaysLessTheFartherTheRobotHasDrivenSince) {
  const GlobalMap map = map_of({{0.0F, 0.0F, 0.0F}});
  LiveState state = state_on(map);
  state.way_since_m = 0.0;
  EXPECT_DOUBLE_EQ(expected_from(state, fingerprint(map))->odds, 19.0);
  state.way_since_m = 5.0;
  EXPECT_DOUBLE_EQ(expected_from(state, fingerprint(map))->odds, 10.0);
  state.way_since_m = 1000.0;
  EXPECT_NEAR(expected_from(state, fingerprint(map))->odds, 1.0, 1e-9);
}

TEST(LiveState, ThatIsDamagedIsRefused) {
  test::TemporaryFolder folder;
  const auto file = folder.path() / "state.json";
  write_state(file, state_on(map_of({{0.0F, 0.0F, 0.0F}})));
  const std::string whole = content_of(file);
  const auto fault = [&](const std::string& damaged) {
    folder.write("state.json", damaged);
    return config_error(folder.path(), [&] { static_cast<void>(read_state(file)); });
  };
  for (std::size_t n = 0; n + 2 < whole.size(); ++n)
    EXPECT_THAT(fault(whole.substr(0, n)), HasSubstr("state.json: error: is cut short")) << n;
  EXPECT_THAT(fault("[1, 2]"), HasSubstr("no state of glocal live"));
  EXPECT_THAT(fault("{\"schema\": 2}"), HasSubstr("is of schema 2, not 1"));
  const std::string no_rotation =
      R"({"schema":1,"map":"","pose":[0,0,0,0,0,0,0],"covariance":null,"stamp":0,"way_since_m":0})";
  EXPECT_THAT(fault(no_rotation), HasSubstr("has no pose that can be; remove it"));
  EXPECT_THAT(config_error(folder.path(), [&] { static_cast<void>(read_state(folder.path() / ".")); }),
              HasSubstr("is a folder; name a file with --state"));
}

}  // namespace
}  // namespace glocal::app::live_state_test
