// Offices as sources: map and drive are of one place.
#include "sources/sites/office.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "files.hpp"
#include "samples.hpp"

namespace glocal::test::office_test {
namespace {

std::vector<Sample> drive_in(double side, std::uint64_t number, std::uint64_t seed) {
  sites::OfficeDrive::Params params;
  params.side = side;
  params.length = 20.0;
  params.number = number;
  sites::OfficeDrive drive(params, {.seed = seed});
  return all_of(drive);
}

MapData map_of(double side, std::uint64_t number) {
  sites::OfficeMap::Params params;
  params.side = side;
  params.length = 20.0;
  params.number = number;
  return sites::OfficeMap(params).load();
}

TEST(OfficeTest, TheRobotDrivesWhereItsMapIsFree) {
  const MapData map = map_of(30.0, 2);
  const auto samples = drive_in(30.0, 2, 1);
  ASSERT_GT(samples.size(), 50U);
  for (const Sample& sample : samples)
    EXPECT_EQ(map.grid.at(sample.map_from_robot->x, sample.map_from_robot->y), Cell::free);
}

TEST(OfficeTest, TheSeedDrawsNoiseAndTheNumberTheOffice) {
  const auto one = drive_in(30.0, 2, 1);
  const auto noisy = drive_in(30.0, 2, 9);
  ASSERT_EQ(one.size(), noisy.size());
  EXPECT_EQ(one.back().map_from_robot->x, noisy.back().map_from_robot->x);
  EXPECT_NE(one.back().observation.odom_from_robot.x, noisy.back().observation.odom_from_robot.x);
  EXPECT_NE(map_of(30.0, 2).points.x, map_of(30.0, 3).points.x);
}

TEST(OfficeTest, RefusesAMapOfTooManyCells) {
  sites::OfficeMap::Params params;
  params.side = 400.0;
  params.resolution = 0.01;
  EXPECT_EQ(
      config_error("", [&] { static_cast<void>(sites::OfficeMap(params).load()); }),
      "error: its map would have more than 1000 million cells of 0.01 m; raise resolution to 0.02 or more");
}

TEST(OfficeTest, WithoutALengthTheWayIsFiveTimesTheSide) {
  EXPECT_EQ(sites::usual_length(50.0), 250.0);
  EXPECT_EQ(sites::usual_length(1000.0), 3000.0);
}

}  // namespace
}  // namespace glocal::test::office_test
