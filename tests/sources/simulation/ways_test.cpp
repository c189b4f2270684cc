#include "sources/simulation/ways.hpp"

#include <gtest/gtest.h>

#include "sources/plan.hpp"

namespace glocal::simulation::ways_test {
namespace {

/// Two rooms side by side, 0.5 m cells: the left one has 4 x 3 cells, the right one 2 x 3.
const std::vector<std::string> two_rooms{
    "#########",  //
    "#....#..#",  //
    "#....#..#",  //
    "#....#..?",  //
    "#########",
};

std::string fault(const std::vector<Position>& way_points, double clearance = 0.0) {
  const OccupancyGrid grid = test::Plan(two_rooms).grid();
  return test::config_error("", [&] { MapWays(grid, clearance, way_points, "map.yaml"); });
}

TEST(MapWays, LeadBetweenTheGivenPlacesInTheirOrder) {
  const OccupancyGrid grid = test::Plan(two_rooms).grid();
  const std::vector<Position> places{{0.75, 0.75}, {2.25, 1.75}, {0.75, 1.75}};
  const MapWays ways(grid, 0.0, places, "map.yaml");
  EXPECT_EQ(ways.places(), places);
  Itinerary itinerary = ways.itinerary(0, Rng(1));
  EXPECT_EQ(itinerary.next(), places[1]);
  ways.go_on_from({0.75, 1.25}, itinerary);
  EXPECT_EQ(itinerary.next(), places[1]) << "where it was going";
  EXPECT_EQ(itinerary.next(), places[2]);
  EXPECT_EQ(itinerary.next(), std::nullopt);
  EXPECT_EQ(ways.between(places[0], places[1]), (std::vector<Position>{places[1]}));
}

TEST(MapWays, LeadBetweenPlacesDrawnInTheLargestRegion) {
  const OccupancyGrid grid = test::Plan(two_rooms).grid();
  const auto places = [&](std::uint64_t seed) {
    return MapWays(grid, 0.0, 40, Rng(seed), "map.yaml").places();
  };
  const std::vector<Position> drawn = places(1);
  ASSERT_EQ(drawn.size(), 41U);
  for (std::size_t i = 0; i < drawn.size(); ++i) {
    EXPECT_LT(drawn[i][0], 2.5) << "the left room";
    EXPECT_EQ(grid.at(drawn[i][0], drawn[i][1]), Cell::free);
    if (i > 0) {
      EXPECT_NE(drawn[i], drawn[i - 1]);
    }
  }
  EXPECT_EQ(drawn, places(1));
  EXPECT_NE(drawn, places(2));
  EXPECT_EQ(MapWays(grid, 0.0, 2, Rng(1), "map.yaml").itinerary(2, Rng(1)).next(), drawn[1]);
}

TEST(MapWays, SayWhichPlaceIsWrongAndWhy) {
  EXPECT_EQ(fault({{0.75, 0.75}, {2.25, 1.75}}), "");
  EXPECT_EQ(
      fault({{0.75, 0.75}, {0.25, 1.75}, {9.0, 9.0}}),
      "map.yaml: error: way_points[1]: [0.25, 1.75] lies in no free cell of the map; move it onto free "
      "space\n"
      "map.yaml: error: way_points[2]: [9, 9] lies in no free cell of the map; move it onto free space");
  EXPECT_EQ(fault({{1.25, 1.25}, {0.75, 0.75}}, 0.4),
            "map.yaml: error: way_points[1]: [0.75, 0.75] is nearer than 0.4 m to a cell that is not free; "
            "move it, or lower clearance");
  EXPECT_EQ(
      fault({{0.75, 0.75}, {3.25, 1.25}}),
      "map.yaml: error: way_points[1]: [3.25, 1.25] cannot be reached from [0.75, 0.75] with a clearance "
      "of 0 m; move it, or lower clearance");
  EXPECT_EQ(fault({{0.75, 0.75}, {0.75, 0.75}}),
            "map.yaml: error: way_points[1]: is the same place as the one before; leave it out");
  EXPECT_EQ(fault({{0.25, 0.75}, {0.75, 0.75}}),
            "map.yaml: error: way_points[0]: [0.25, 0.75] lies in no free cell of the map; move it onto free "
            "space")
      << "the second is no fault of its own";
}

TEST(MapWays, SayThatThereIsNowhereToDrive) {
  const OccupancyGrid grid = test::Plan(two_rooms).grid();
  EXPECT_EQ(
      test::config_error("", [&] { MapWays(grid, 1.0, 5, Rng(1), "map.yaml"); }),
      "map.yaml: error: has no two free cells side by side that are 1 m away from all that is not free; "
      "lower clearance, or take another map");
}

}  // namespace
}  // namespace glocal::simulation::ways_test
