#include "sources/ros_map/ros_map.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "files.hpp"
#include "sources/png_files.hpp"
#include "sources/ros_map/image.hpp"
#include "sources/ros_map/ros_map_writer.hpp"

namespace glocal::ros_map::ros_map_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr Cell o = Cell::occupied;
constexpr Cell f = Cell::free;
constexpr Cell u = Cell::unknown;

/// A map of one row of grey values.
class Row {
 public:
  explicit Row(const std::vector<int>& greys) {
    std::string image = "P5 " + std::to_string(greys.size()) + " 1 255\n";
    for (const int grey : greys) image += static_cast<char>(grey);
    folder_.write("map.pgm", image);
  }
  [[nodiscard]] std::filesystem::path write(const std::string& more) const {
    return folder_.write("map.yaml", "image: map.pgm\nresolution: 0.5\norigin: [0, 0, 0]\n" + more);
  }
  [[nodiscard]] MapData load(const std::string& more) const {
    return RosMap({test::file_path(write(more))}, {}).load();
  }
  [[nodiscard]] std::string fault_of(const std::string& more) const {
    const auto file = write(more);
    return test::config_error(file.parent_path(),
                              [&] { static_cast<void>(RosMap({test::file_path(file)}, {}).load()); });
  }

 private:
  test::TemporaryFolder folder_;
};

std::string thresholds(double occupied, double free) {
  return "occupied_thresh: " + std::to_string(occupied) + "\nfree_thresh: " + std::to_string(free) + "\n";
}

TEST(RosMap, TrinaryKnowsThreeKindsOfCells) {
  // Darkness 1, 0.667, 0.643, 0.2, 0.192, 0.
  const Row row({0, 85, 91, 204, 206, 255});
  EXPECT_THAT(row.load(thresholds(0.65, 0.196)).grid.cells, ElementsAre(o, o, u, u, f, f));
  EXPECT_THAT(row.load(thresholds(0.65, 0.25)).grid.cells, ElementsAre(o, o, u, f, f, f));
  for (const std::string yes : {"1", "true"}) {
    EXPECT_THAT(row.load(thresholds(0.65, 0.196) + "mode: trinary\nnegate: " + yes + "\n").grid.cells,
                ElementsAre(f, u, u, o, o, o));
  }
  EXPECT_THAT(row.load(thresholds(0.65, 0.196) + "negate: false\n").grid.cells,
              ElementsAre(o, o, u, u, f, f));
}

TEST(RosMap, TheGreyOfMapSaversIsUnknownWhateverTheThreshold) {
  const Row row({0, 205, 254});
  for (const double free : {0.196, 0.25}) {
    EXPECT_THAT(row.load(thresholds(0.65, free)).grid.cells, ElementsAre(o, u, f)) << free;
  }
}

TEST(RosMap, RawTakesBytesAsPerCent) {
  const Row row({100, 66, 65, 20, 19, 0, 101, 255});
  EXPECT_THAT(row.load(thresholds(0.65, 0.2) + "mode: raw\n").grid.cells,
              ElementsAre(o, o, u, u, f, f, u, u));
}

TEST(RosMap, IsReadAsMapServersDoIt) {
  const Row row({0, 100, 255});
  EXPECT_THAT(row.load(thresholds(0.5, 0.5)).grid.cells, ElementsAre(o, o, f));
  EXPECT_THAT(row.load(thresholds(0.65, 0.2) + "mode: Trinary\n").grid.cells, ElementsAre(o, u, f));
  EXPECT_THAT(row.load(thresholds(0.65, 0.2) + "mode: RAW\n").grid.cells, ElementsAre(f, o, u));
}

TEST(RosMap, AlphaIsAColourOrMakesUnknown) {
  const test::TemporaryFolder folder;
  // Black opaque, black transparent, white opaque, white transparent.
  folder.write("map.png", test::make_png(4, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA,
                                         test::bytes({0, 255, 0, 0, 255, 255, 255, 0})));
  const auto cells = [&](const std::string& mode) {
    const auto file =
        folder.write("map.yaml", "image: map.png\nresolution: 1\norigin: [0, 0, 0]\nmode: " + mode + "\n");
    return RosMap({test::file_path(file)}, {}).load().grid.cells;
  };
  EXPECT_THAT(cells("scale"), ElementsAre(o, u, f, u));
  // The means over three colours and alpha are 0.25, 0, 1 and 0.75.
  EXPECT_THAT(cells("trinary"), ElementsAre(o, o, f, u));
}

TEST(RosMap, TheLowestRowOfTheImageIsTheLowestY) {
  const test::TemporaryFolder folder;
  folder.write("map.pgm", "P2 2 3 255\n0 255\n255 255\n255 0");
  const auto file = folder.write("map.yaml", "image: map.pgm\nresolution: 0.5\norigin: [10, 20, 0]\n");
  const MapData map = RosMap({test::file_path(file)}, {}).load();
  EXPECT_EQ(map.grid.at(10.75, 20.25), o);
  EXPECT_EQ(map.grid.at(10.25, 21.25), o);
  EXPECT_EQ(map.grid.at(10.25, 20.25), f);
  ASSERT_EQ(map.points.size(), 2U);
  EXPECT_EQ(map.points[0], (Point{10.75F, 20.25F, 0}));
  EXPECT_EQ(map.points[1], (Point{10.25F, 21.25F, 0}));
  EXPECT_TRUE(map.path.empty());
}

TEST(RosMap, FarAwayIsHeldRelativeToAnOriginInWholeMetres) {
  const test::TemporaryFolder folder;
  folder.write("map.pgm", "P2 3 1 255\n255 255 0");
  const auto load = [&](const std::string& origin) {
    return RosMap({test::file_path(folder.write(
                      "map.yaml", "image: map.pgm\nresolution: 0.05\norigin: " + origin + "\n"))},
                  {})
        .load();
  };
  const MapData near = load("[0, 0, 0]");
  EXPECT_EQ(near.origin, Vector3(0, 0, 0));
  const MapData far = load("[500000, 4649776, 0]");
  EXPECT_EQ(far.origin, Vector3(500'000, 4'649'776, 0));
  EXPECT_EQ(far.points, near.points) << "to the last bit";
  EXPECT_EQ(far.grid.map_from_grid, near.grid.map_from_grid);
  // Single precision would make 500,012.6 of 500,012.615 and 4,649,776.5 of 4,649,776.275. The third cell's
  // centre is at (0.125, 0.025) in the grid.
  const MapData shifted = load("[500012.49, -4649776.25, 0]");
  EXPECT_EQ(shifted.origin, Vector3(500'012, -4'649'776, 0));
  EXPECT_NEAR(shifted.points[0].x, 0.615, 1e-6);
  EXPECT_NEAR(shifted.points[0].y, -0.225, 1e-6);
  EXPECT_EQ(shifted.grid.at(0.615, -0.225), o);
  // Along x it is near.
  EXPECT_EQ(load("[-12.5, 2000.4, 1]").origin, Vector3(0, 2000, 0));
  EXPECT_EQ(load("[-12.5, 2000.4, 1]").grid.map_from_grid.x, -12.5);
}

TEST(RosMap, IsWrittenInItsOwnFrame) {
  const OccupancyGrid grid{{0.5, -0.25, 1.5}, 0.05, 1, 1, {o}};
  EXPECT_THAT(ros_map_yaml(grid, "a.pgm", {500'000.0, 4'649'776.0, 0.0}),
              HasSubstr("origin: [500000.5, 4649775.75, 1.5]\n"));
}

TEST(RosMap, TurnsWithItsOrigin) {
  const test::TemporaryFolder folder;
  folder.write("map.pgm", "P2 3 1 255\n255 255 0");
  const auto file =
      folder.write("map.yaml", "image: map.pgm\nresolution: 1\norigin: [5, 6, 1.5707963267948966]\n");
  const MapData map = RosMap({test::file_path(file)}, {}).load();
  // The third cell's centre, (2.5, 0.5) in the grid, is 2.5 m along the map's y and half a metre to the left.
  ASSERT_EQ(map.points.size(), 1U);
  EXPECT_NEAR(map.points[0].x, 4.5, 1e-6);
  EXPECT_NEAR(map.points[0].y, 8.5, 1e-6);
  EXPECT_EQ(map.grid.at(4.5, 8.5), o);
  EXPECT_EQ(map.grid.at(4.5, 6.5), f);
}

TEST(RosMap, TakesAYawThatIsNoNumberFor0) {
  const test::TemporaryFolder folder;
  folder.write("map.pgm", "P2 1 1 255\n0");
  for (const char* yaw : {"-nan", "nan", ".nan", "NaN"}) {
    const auto file =
        folder.write("map.yaml", std::string("image: map.pgm\nresolution: 1\norigin: [5, 6, ") + yaw + "]\n");
    std::vector<std::string> warnings;
    SourceSetup setup;
    setup.warn = [&](const std::string& text) { warnings.push_back(text); };
    EXPECT_EQ(RosMap({test::file_path(file)}, setup).load().grid.map_from_grid, (Pose2{5.0, 6.0, 0.0}));
    EXPECT_THAT(warnings, ElementsAre(HasSubstr("map.yaml: the origin's yaw is NaN, and is taken as 0")));
  }
  const auto file = folder.write("map.yaml", "image: map.pgm\nresolution: 1\norigin: [nan, 6, 0]\n");
  EXPECT_EQ(test::config_error(file.parent_path(), [&] { RosMap({test::file_path(file)}, {}); }),
            "map.yaml:3:9: error: origin: must begin with two finite numbers, x and y");
}

TEST(RosMap, NamesThePlaceOfAFault) {
  const Row row({0, 255});
  const test::TemporaryFolder folder;
  const auto fault_of = [&](const std::string& yaml) {
    const auto file = folder.write("map.yaml", yaml);
    return test::config_error(file.parent_path(), [&] { RosMap({test::file_path(file)}, {}); });
  };
  folder.write("map.pgm", "P5 1 1 255\n0");
  EXPECT_EQ(fault_of("image: no.pgm\nresolution: 0\norigin: [0, 0]\nnegatve: 0\nfree_thresh: nan\n"),
            "map.yaml:1:8: error: image: no such file: no.pgm\n"
            "map.yaml:2:13: error: resolution: 0 is out of range, must be >= 0.001 and <= 100 m\n"
            "map.yaml:3:9: error: origin: expected 3 items, got 2\n"
            "map.yaml:4:1: error: unknown key 'negatve' (did you mean 'negate'?)\n"
            "map.yaml:5:14: error: free_thresh: nan is not a finite number");
  EXPECT_THAT(fault_of("image: map.pgm\nresolution: -0.1\norigin: [0, 0, 0]\n"),
              HasSubstr("-0.1 is out of range"));
  EXPECT_THAT(fault_of("resolution: 1\n"), HasSubstr("missing key 'image'"));
  EXPECT_THAT(row.fault_of(thresholds(0.2, 0.65)),
              HasSubstr("free_thresh: must not be above occupied_thresh"));
  EXPECT_THAT(row.fault_of("mode: fancy\n"),
              HasSubstr("map.yaml:4:7: error: mode: must be trinary, scale or raw"));
}

TEST(RosMap, RefusesAMapWithoutOccupiedCell) {
  EXPECT_EQ(Row({255, 205}).fault_of(""),
            "map.yaml: error: its image has no occupied cell; check negate, occupied_thresh and mode, or "
            "take another image");
}

TEST(RosMap, RefusesATruncatedImage) {
  const test::TemporaryFolder folder;
  folder.write("map.pgm", "P5 9 9 255\n123");
  const auto file = folder.write("map.yaml", "image: map.pgm\nresolution: 1\norigin: [0, 0, 0]\n");
  EXPECT_THAT(test::config_error(file.parent_path(),
                                 [&] { static_cast<void>(RosMap({test::file_path(file)}, {}).load()); }),
              HasSubstr("map.pgm: error: ends before the end of its pixels"));
}

TEST(RosMapWriter, IsReadBack) {
  OccupancyGrid grid{{-1.25, 3.7, 0.3}, 0.05, 3, 2, {o, f, u, u, u, o}};
  for (const bool as_png : {false, true}) {
    const test::TemporaryFolder folder;
    const ByteImage image = trinary_image(grid);
    folder.write("map.image", as_png ? png(image) : pgm(image));
    const auto file = folder.write("map.yaml", ros_map_yaml(grid, "map.image"));
    const MapData map = RosMap({test::file_path(file)}, {}).load();
    EXPECT_EQ(map.grid.cells, grid.cells);
    EXPECT_EQ(map.grid.map_from_grid, grid.map_from_grid);
    EXPECT_EQ(map.grid.resolution, grid.resolution);
    EXPECT_EQ(map.grid.width, 3);
  }
}

TEST(RosMapWriter, TakesAnyNameOfAnImage) {
  const OccupancyGrid grid{{}, 0.05, 1, 1, {o}};
  for (const char* name : {"a\"b.pgm", "a\\b.pgm", "a: b # c.pgm", "a\nb.pgm", "1.5", "größe.pgm"}) {
    const test::TemporaryFolder folder;
    folder.write(name, pgm(trinary_image(grid)));
    const auto file = folder.write("map.yaml", ros_map_yaml(grid, name));
    EXPECT_EQ(RosMap({test::file_path(file)}, {}).load().grid.cells, grid.cells) << name;
  }
}

TEST(RosMapWriter, WritesTheSameImagePieceByPiece) {
  OccupancyGrid grid{{0.0, 0.0, 0.0}, 0.1, 3, 700, PackedCells(2100)};
  for (std::size_t i = 0; i < 2100; ++i) grid.cells[i] = i % 7 == 0 ? o : i % 5 == 0 ? u : f;
  std::string image;
  int pieces = 0;
  write_trinary_pgm(grid, [&](std::string_view piece) {
    image += piece;
    ++pieces;
  });
  EXPECT_EQ(image, pgm(trinary_image(grid)));
  EXPECT_GT(pieces, 2);
}

struct SharedMapFacts {
  const char* file;
  double width, height;  ///< m, of what is occupied
};

class SharedRosMap : public testing::TestWithParam<SharedMapFacts> {};

TEST_P(SharedRosMap, CoversTheAreaItsDescriptionSays) {
  const auto file = test::dataset(GetParam().file);
  if (file.empty()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  const MapData map = RosMap({test::file_path(file)}, {}).load();
  const auto extent = [](const std::vector<float>& v) {
    const auto [low, high] = std::minmax_element(v.begin(), v.end());
    return static_cast<double>(*high - *low);
  };
  EXPECT_NEAR(extent(map.points.x), GetParam().width, 1.0);
  EXPECT_NEAR(extent(map.points.y), GetParam().height, 1.0);
  for (const Cell kind : {o, f, u}) {
    EXPECT_GT(std::count(map.grid.cells.begin(), map.grid.cells.end(), kind), 1000);
  }
}

INSTANTIATE_TEST_SUITE_P(Datasets, SharedRosMap,
                         testing::Values(SharedMapFacts{"maps/willow_full/willow-full-0.05.yaml", 58, 47},
                                         SharedMapFacts{"maps/mit_basement/basement_fixed.map.yaml", 63, 43},
                                         SharedMapFacts{"maps/nav2_depot/depot.yaml", 30, 15},
                                         SharedMapFacts{"maps/aws_small_house/map.yaml", 19, 11}),
                         [](const auto& map) {
                           const std::string name = std::string(map.param.file).substr(5);
                           return name.substr(0, name.find('/'));
                         });

}  // namespace
}  // namespace glocal::ros_map::ros_map_test
