#include "evaluation/results/map_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/results/pcd.hpp"
#include "files.hpp"

namespace glocal::test::map_files_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;

/// Three columns, two rows: unknown, free, free; occupied, occupied, unknown.
OccupancyGrid small_grid() {
  using enum Cell;
  return {{1.0, -2.0, 0.5}, 0.25, 3, 2, {unknown, free, free, occupied, occupied, unknown}};
}

TEST(MapFiles, GridHasItsCellsAsRunLengths) {
  EXPECT_EQ(grid_json(small_grid()), Json::parse(R"({"resolution": 0.25, "origin": {"x": 1.0, "y": -2.0,
    "theta": 0.5}, "width": 3, "height": 2, "cells": "1u2f2o1u"})"));
}

TEST(MapFiles, AreInTheFrameOfAMapFarAway) {
  MapData data;
  data.points.push_back({0.25F, 0.5F, 0.0F});
  data.grid = small_grid();
  data.origin = {500'000.0, 4'649'776.0, 0.0};
  const TemporaryFolder folder;
  const auto files = map_files(GlobalMap(std::move(data)));
  ASSERT_EQ(files.size(), 2U);
  const MapPoints points = read_map_pcd(folder.write("global.pcd", files[0].second));
  EXPECT_EQ(points.origin, Vector3(500'000, 4'649'777, 0)) << "halves are rounded away from 0";
  EXPECT_EQ(points.points[0], (Point{0.25F, -0.5F, 0.0F}));
  EXPECT_EQ(Json::parse(files[1].second)["origin"],
            Json::parse(R"({"x": 500001.0, "y": 4649774.0, "theta": 0.5})"));
}

class ReadGrid : public testing::Test {
 protected:
  Json read(const std::string& content) {
    folder_.write("grid.json", content);
    return read_grid(folder_ / "grid.json");
  }
  std::string fault(const std::string& content) {
    return error_of([&] { return read(content); });
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(ReadGrid, GivesWhatWasWritten) {
  const Json grid = grid_json(small_grid());
  EXPECT_EQ(read(grid.dump()), grid);
}

TEST_F(ReadGrid, RefusesWhatIsNoGrid) {
  const auto with = [](const char* key, const Json& value) {
    Json grid = grid_json(small_grid());
    grid[key] = value;
    return grid.dump();
  };
  for (const std::string& content :
       {std::string("{"), std::string("[]"), with("cells", "1u2f2o"), with("cells", "1u2f2o1x"),
        with("cells", "1u2f2o1"), with("cells", 7), with("width", -3), with("width", 4),
        with("resolution", 0.0), with("origin", {{"x", 1.0}})})
    EXPECT_THAT(fault(content), HasSubstr("grid.json: error: is no grid as glocal run leaves it")) << content;
}

}  // namespace
}  // namespace glocal::test::map_files_test
