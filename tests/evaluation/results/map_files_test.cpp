#include "evaluation/results/map_files.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"
#include "glocal/error.hpp"

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

class ReadGrid : public testing::Test {
 protected:
  Json read(const std::string& content) {
    folder_.write("grid.json", content);
    return read_grid(folder_ / "grid.json");
  }
  std::string fault(const std::string& content) {
    try {
      static_cast<void>(read(content));
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "no fault";
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
