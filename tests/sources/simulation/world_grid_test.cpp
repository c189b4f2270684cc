#include "sources/simulation/world_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "evaluation/results/pcd.hpp"
#include "files.hpp"

namespace glocal::simulation::world_grid_test {
namespace {

using testing::HasSubstr;

/// A floor of points 0.1 m apart at a height of -1 m, 30 m x 6 m, and what a test puts onto it.
class CloudFloor : public testing::Test {
 protected:
  CloudFloor() { put({0.05, 29.95}, {0.05, 5.95}, {-1.0, -1.0}); }

  using Range = std::array<double, 2>;

  void put(const Range& x, const Range& y, const Range& z) {
    const auto steps = [](const Range& range) { return std::lround((range[1] - range[0]) / 0.1); };
    for (long i = 0; i <= steps(x); ++i) {
      for (long k = 0; k <= steps(y); ++k) {
        for (long m = 0; m <= steps(z); ++m) {
          const auto at = [](double from, long step) {
            return static_cast<float>(from + 0.1 * static_cast<double>(step));
          };
          points_.push_back({at(x[0], i), at(y[0], k), at(z[0], m)});
        }
      }
    }
  }

  /// Takes away what is in a rectangle.
  void dig(const Range& x, const Range& y) {
    Points left;
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const Point p = points_[i];
      const bool is_in = p.x > x[0] && p.x < x[1] && p.y > y[0] && p.y < y[1];
      if (!is_in) left.push_back(p);
    }
    points_ = left;
  }

  OccupancyGrid floor(const std::vector<Position>& places, const std::string& more = "") {
    folder_.write("cloud.pcd", pcd(points_));
    const auto file = folder_.write("world.yaml",
                                    "size: [1, 1]\ncloud: cloud.pcd\nfree_from: [[0, 0]]\n"
                                    "way_points: [[1, 1], [2, 1]]\n" +
                                        (more.empty() ? "floor: -1\n" : more));
    const World world = read_world(file);
    return floor_near(places, world, voxels_of(world), "world.yaml");
  }

  test::TemporaryFolder folder_;
  Points points_;
};

TEST_F(CloudFloor, IsFreeWhereNothingStands) {
  put({3.05, 3.55}, {2.05, 2.55}, {-0.3, -0.3});  // a table, 0.7 m high
  put({5.05, 5.55}, {2.05, 2.55}, {-0.9, -0.9});  // a threshold
  put({7.05, 7.55}, {2.05, 2.55}, {1.3, 1.3});    // a lamp, 2.3 m high
  put({9.05, 9.05}, {0.05, 5.95}, {-0.9, 1.5});   // a wall right across
  const OccupancyGrid grid = floor({{1.0, 1.0}});
  EXPECT_NEAR(grid.resolution, 0.1, 1e-12);
  EXPECT_EQ(grid.at(2.0, 2.0), Cell::free);
  EXPECT_EQ(grid.at(3.3, 2.3), Cell::occupied) << "the table";
  EXPECT_EQ(grid.at(5.3, 2.3), Cell::free) << "the threshold";
  EXPECT_EQ(grid.at(7.3, 2.3), Cell::free) << "below the lamp";
  EXPECT_EQ(grid.at(9.07, 3.0), Cell::occupied) << "the wall";
  EXPECT_EQ(grid.at(9.5, 3.0), Cell::unknown) << "behind it, but for holes of a voxel in the wall";
  EXPECT_EQ(grid.at(8.8, 3.0), Cell::free);
  EXPECT_NE(grid.at(2.0, -0.1), Cell::free) << "off the floor";
  EXPECT_NE(grid.at(-5.0, 3.0), Cell::free);
}

TEST_F(CloudFloor, HasSmallGapsButNoHoles) {
  dig({3.0, 3.4}, {2.0, 4.0});
  dig({5.0, 7.0}, {2.0, 4.0});
  const OccupancyGrid grid = floor({{1.0, 1.0}});
  EXPECT_EQ(grid.at(3.2, 3.0), Cell::free) << "0.4 m wide";
  EXPECT_NE(grid.at(6.0, 3.0), Cell::free) << "2 m wide";
  EXPECT_EQ(grid.at(4.2, 3.0), Cell::free);
}

TEST_F(CloudFloor, ReachesTenMetresFarFromAnyPlace) {
  const OccupancyGrid grid = floor({{1.0, 1.0}, {15.0, 1.0}});
  EXPECT_EQ(grid.at(10.0, 3.0), Cell::free);
  EXPECT_EQ(grid.at(24.5, 1.0), Cell::free);
  EXPECT_NE(grid.at(24.5, 5.5), Cell::free) << "10.5 m away";
  EXPECT_NE(grid.at(25.5, 1.0), Cell::free);
}

TEST_F(CloudFloor, IsReachedFromEachPlace) {
  put({9.05, 9.05}, {0.05, 5.95}, {-0.9, 1.5});
  EXPECT_EQ(floor({{1.0, 1.0}, {12.0, 1.0}}).at(11.0, 4.0), Cell::free);
  // The place itself may be off the floor, or within something.
  EXPECT_EQ(floor({{9.05, 3.0}, {12.0, 1.0}}).at(11.0, 4.0), Cell::free);
}

TEST_F(CloudFloor, IsReachedThroughDoorsOnly) {
  const auto behind_a_wall_with_a_gap = [&](double width) {
    dig({8.9, 9.1}, {-1.0, 7.0});
    put({9.05, 9.05}, {0.05, 1.95}, {-0.9, 1.5});
    put({9.05, 9.05}, {2.05 + width, 5.95}, {-0.9, 1.5});
    return floor({{1.0, 1.0}}).at(10.5, 4.0);
  };
  EXPECT_EQ(behind_a_wall_with_a_gap(0.2), Cell::unknown);
  EXPECT_EQ(behind_a_wall_with_a_gap(0.9), Cell::free);
}

TEST_F(CloudFloor, IsBarredByThingsOfTheWorld) {
  const OccupancyGrid grid = floor({{1.0, 1.0}},
                                   "floor: -1\nwalls: [{points: [[6, -1], [6, 7]]}]\n"
                                   "rectangles: [{centre: [3, 3], size: [1, 1]}]\n");
  EXPECT_EQ(grid.at(4.0, 3.0), Cell::free);
  EXPECT_NE(grid.at(3.0, 3.0), Cell::free);
  EXPECT_NE(grid.at(7.0, 3.0), Cell::free);
}

TEST_F(CloudFloor, HasToBeThereAndNotTooLarge) {
  const auto fault = [&](const std::vector<Position>& places, const std::string& more) {
    return test::config_error("", [&] { static_cast<void>(floor(places, more)); });
  };
  EXPECT_EQ(
      fault({{1.0, 1.0}}, "floor: 0\n"),
      "world.yaml: error: cloud: has no points within 0.2 m of the floor of 0 m near the drive, so that "
      "boxes and people have nothing to stand on; change floor, leave them out, or list them in the file "
      "of the world");
  EXPECT_THAT(fault({{50.0, 1.0}}, "floor: -1\n"), HasSubstr("near the drive"));
  EXPECT_EQ(fault({{1.0, 1.0}, {1000.0, 1000.0}}, "floor: -1\n"),
            "world.yaml: error: cloud: the drive leads past more than 64 million columns of voxels of 0.1 m; "
            "leave out boxes and people, drive less far, or take larger voxels");
}

/// A world of 1 km x 1 km, so that cells of its reality have a side of 0.5 m, centred on multiples of that.
OccupancyGrid coarse_reality(const std::string& walls_and_way) {
  const test::TemporaryFolder folder;
  const OccupancyGrid grid = reality_of(
      read_world(folder.write("world.yaml", "size: [1000, 1000]\nfree_from: [[20, 500]]\n" + walls_and_way)));
  EXPECT_EQ(grid.resolution, 0.5);
  return grid;
}

TEST(RealityOf, MayBeginInTheCellOfAWall) {
  // Wall and first way point are in the cell from x = 9.75 m to 10.25 m.
  const OccupancyGrid grid = coarse_reality(
      "walls: [{points: [[9.8, 0], [9.8, 1000]]}]\nway_points: [[10.2, 500], [20, 500], [30, 500]]\n");
  EXPECT_EQ(grid.at(10.2, 500.0), Cell::occupied);
  EXPECT_EQ(grid.at(20.0, 500.0), Cell::free);
  EXPECT_EQ(grid.at(990.0, 10.0), Cell::free);
  EXPECT_EQ(grid.at(5.0, 500.0), Cell::unknown) << "behind the wall";
}

TEST(RealityOf, IsFreeWhereTheDriveBegins) {
  // The door of 0.4 m is within one cell, from y = 499.75 m to 500.25 m.
  const OccupancyGrid grid = coarse_reality(
      "walls: [{points: [[100, 0], [100, 499.8]]}, {points: [[100, 500.2], [100, 1000]]}]\n"
      "way_points: [[20, 500], [200, 500]]\n");
  EXPECT_EQ(grid.at(20.0, 500.0), Cell::free);
  EXPECT_EQ(grid.at(100.0, 500.0), Cell::occupied);
  EXPECT_EQ(grid.at(200.0, 500.0), Cell::unknown);
}

TEST(FloorNear, IsMostOfARealCorridor) {
  const auto octree = test::dataset("octomap/geb079.bt");
  if (octree.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  World world;
  world.cloud = test::file_path(octree);
  world.floor = -0.08;
  const OccupancyGrid grid =
      floor_near({{-5.5, -0.3}, {5.0, -0.3}, {15.0, -0.2}, {25.0, 0.0}}, world, voxels_of(world), "");
  int cells = 0, free = 0;
  for (double x = -5.0; x < 25.0; x += 0.08) {
    for (double y = -0.5; y < 0.2; y += 0.08) {
      ++cells;
      free += grid.at(x, y) == Cell::free ? 1 : 0;
    }
  }
  EXPECT_GT(free, 0.95 * cells);
}

}  // namespace
}  // namespace glocal::simulation::world_grid_test
