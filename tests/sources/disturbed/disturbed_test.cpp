// Sources that disturb others: in which order, by which levels, and what is refused.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string_view>

#include "config/text_file.hpp"
#include "files.hpp"
#include "framework/pipeline/fakes.hpp"
#include "glocal/catalog.hpp"
#include "glocal/yaml.hpp"
#include "samples.hpp"
#include "sources/disturbed/disturbed_drive.hpp"
#include "sources/disturbed/disturbed_map.hpp"
#include "sources/disturbed/map_disturbances.hpp"
#include "temporary_folder.hpp"

namespace glocal::disturbed::disturbed_test {
namespace {

using testing::HasSubstr;

/// Samples of a robot that stands, with one hit 4 m ahead in each.
class Standing final : public ObservationSource {
 public:
  using Params = NoParams;
  explicit Standing(const Params& /*params*/) {}
  std::optional<Sample> next() override {
    if (count_ == 1000) return std::nullopt;
    Sample sample;
    sample.observation.stamp = count_++;
    sample.observation.scan.hits.push_back({4.0F, 0.0F, 0.0F});
    return sample;
  }

 private:
  int count_ = 0;
};

/// A room of 10 m × 4 m in cells of 0.5 m: its walls, a box of 1 m × 1 m in its middle, and free floor.
class Room final : public MapSource {
 public:
  using Params = NoParams;
  explicit Room(const Params& /*params*/) {}
  MapData load() override {
    MapData map;
    map.grid = {.map_from_grid = {}, .resolution = 0.5, .width = 20, .height = 8, .cells = {}};
    map.grid.cells = PackedCells(160, Cell::free);
    for (int column = 0; column < 20; ++column) {
      for (const int row : {0, 7}) map.grid.cell(column, row) = Cell::occupied;
    }
    for (int row = 0; row < 8; ++row) {
      for (const int column : {0, 19}) map.grid.cell(column, row) = Cell::occupied;
    }
    for (const int column : {9, 10}) {
      for (const int row : {3, 4}) map.grid.cell(column, row) = Cell::occupied;
    }
    map.points = occupied_centres(map.grid);
    return map;
  }
};

class Disturbed : public testing::Test {
 protected:
  Disturbed() {
    drives_.add<Standing>("standing", "A robot that stands.");
    maps_.add<Room>("room", "A room.");
  }

  std::vector<Sample> drive(std::vector<ChosenDisturbance> by, std::uint64_t seed = 1) const {
    DisturbedDrive source({&drives_, drives_.choose("standing"), std::move(by)}, {.seed = seed});
    return test::all_of(source);
  }
  MapData map(std::vector<ChosenMapDisturbance> by, std::uint64_t seed = 1) const {
    return DisturbedMap({&maps_, maps_.choose("room"), std::move(by)}, {.seed = seed}).load();
  }
  static std::size_t occupied(const MapData& map) {
    return static_cast<std::size_t>(std::count(map.grid.cells.begin(), map.grid.cells.end(), Cell::occupied));
  }

  Registry<ObservationSource, SourceSetup> drives_{"observation_source"};
  Registry<MapSource, SourceSetup> maps_{"map_source"};
};

TEST_F(Disturbed, OneThingAfterTheOther) {
  // Bias, then stretch: 1.1 (4 + 0.5); the other way round 1.1 · 4 + 0.5.
  EXPECT_NEAR(drive({{{"bias", 0, 0.5}}, {{"stretch", 0, 0.1}}})[0].observation.scan.hits.x[0], 4.95, 1e-5);
  EXPECT_NEAR(drive({{{"stretch", 5, {}}}, {{"bias", 5, {}}}})[0].observation.scan.hits.x[0], 4.9, 1e-5);
}

TEST_F(Disturbed, TheSameSeedIsTheSameDrive) {
  const auto ranges = [&](std::uint64_t seed) {
    std::vector<float> all;
    for (const Sample& s : drive({{{"dropped_scans", 3, {}}}, {{"noise", 3, {}}}}, seed))
      all.push_back(s.observation.scan.hits.x[0]);
    return all;
  };
  EXPECT_EQ(ranges(1), ranges(1));
  EXPECT_NE(ranges(1), ranges(2));
  EXPECT_NEAR(static_cast<double>(ranges(1).size()), 500.0, 70.0);
}

TEST_F(Disturbed, TwiceIsByOtherNumbers) {
  // Noise of 0.1 m within noise of 0.1 m is one of 0.14 m, not of 0.2 m.
  Registry<ObservationSource, SourceSetup> sources{"observation_source"};
  sources.add<Standing>("standing", "A robot that stands.");
  const std::vector<ChosenDisturbance> noise = {{{"noise", 0, 0.1}}};
  sources.add<DisturbedDrive>("disturbed", "Disturbed.", {}, {&sources, sources.choose("standing"), noise});
  DisturbedDrive source({&sources, sources.choose("disturbed"), noise}, {});
  double squared = 0.0;
  for (const Sample& s : test::all_of(source))
    squared += std::pow(s.observation.scan.hits.x[0] - 4.0, 2) / 1000.0;
  EXPECT_NEAR(std::sqrt(squared), 0.1414, 0.01);
}

TEST_F(Disturbed, NumbersOfThingsAreWhole) {
  const test::TemporaryFolder folder;
  const auto fault = [&](const std::string& kind, double amount) {
    return test::config_error(folder.path(), [&] {
      ParamsOf<ChosenDisturbance> params;
      read_yaml(folder.write("by.yaml", fmt::format("kind: {}\namount: {}\n", kind, amount)), params);
    });
  };
  EXPECT_EQ(fault("repeated_scans", 2.0), "");
  EXPECT_EQ(fault("noise", 0.3), "");
  EXPECT_THAT(fault("repeated_scans", 0.3), HasSubstr("amount: must be a whole number of at least 2"));
  EXPECT_THAT(fault("late_scans", 1.5), HasSubstr("amount: must be a whole number of at least 1"));
}

TEST_F(Disturbed, WhatHasHeightsIsNoPlan) {
  const auto in_space = [](MapData map) {
    map.points.push_back({4.0F, 2.0F, 1.0F});
    map.free_voxels = FreeVoxels({}, 0.5);
    map.free_voxels.add(1, 1, 1);
    return map;
  };
  Registry<MapSource, SourceSetup> sources{"map_source"};
  sources.add<test::GivenMap>("space", "Points in space.", {}, {in_space(map({{{"taken", 0, 1e-9}}}))});
  const auto disturbed = [&](const char* kind, double amount) {
    return DisturbedMap({&sources, sources.choose("space"), {{{kind, 0, amount}}}}, {}).load();
  };
  EXPECT_THAT(test::error_of([&] { return disturbed("coarse", 2.0); }), HasSubstr("points in space"));
  EXPECT_EQ(occupied(disturbed("blurred", 0.01)), 56U) << "the plan is as it was";
  EXPECT_FALSE(disturbed("blurred", 0.01).free_voxels.empty());
  EXPECT_TRUE(disturbed("cut_off", 0.1).free_voxels.empty());
}

TEST_F(Disturbed, WholeMapsAreChangedOneByOne) {
  MapData several = map({{{"taken", 0, 1e-9}}});
  several.parts.resize(2);
  Registry<MapSource, SourceSetup> sources{"map_source"};
  sources.add<test::GivenMap>("several", "Two maps.", {}, {several});
  DisturbedMap source({&sources, sources.choose("several"), {{{"stretched", 5, {}}}}}, {});
  EXPECT_THAT(test::error_of([&] { return source.load(); }),
              HasSubstr("disturb each of the maps of 'several'"));
}

TEST_F(Disturbed, ADriveOfWhichNothingIsLeftIsRefused) {
  const std::vector<ChosenDisturbance> by = {{{"short_range", 5, {}}}};
  DisturbedDrive source({&drives_, drives_.choose("standing"), by}, {});
  EXPECT_THAT(test::error_of([&] { return test::all_of(source); }),
              HasSubstr("nothing of what the source has measured is left"));
}

TEST_F(Disturbed, FurnitureIsTakenOrMovedAndWallsStay) {
  const MapData as_it_is = map({{{"taken", 0, 1e-9}}});
  ASSERT_EQ(occupied(as_it_is), 20U * 2 + 6 * 2 + 4);
  const MapData taken = map({{{"taken", 5, {}}}});
  EXPECT_EQ(occupied(taken), 52U);
  EXPECT_EQ(taken.grid.at(4.75, 1.75), Cell::free);
  EXPECT_EQ(taken.points, occupied_centres(taken.grid));
  const MapData moved = map({{{"moved", 5, {}}}}, 3);
  EXPECT_NE(moved.grid.cells, as_it_is.grid.cells);
  EXPECT_NE(moved.grid.cells, taken.grid.cells);
  EXPECT_LE(occupied(moved), 56U);
}

TEST(DisturbedMaps, ATableMappedBelowItsTopIsFourLegs) {
  // A table of 0.6 m x 0.8 m in cells of 5 cm, and a wall of 3 m.
  MapData map;
  map.grid = {.map_from_grid = {}, .resolution = 0.05, .width = 60, .height = 40, .cells = {}};
  map.grid.cells = PackedCells(2400, Cell::free);
  for (int column = 0; column < 60; ++column) map.grid.cell(column, 0) = Cell::occupied;
  for (int column = 20; column < 32; ++column) {
    for (int row = 10; row < 26; ++row) map.grid.cell(column, row) = Cell::occupied;
  }
  const auto kinds = map_disturbance_kinds();
  const auto kind = std::find_if(kinds.begin(), kinds.end(),
                                 [](const auto& k) { return std::string_view(k.name) == "other_height"; });
  ASSERT_NE(kind, kinds.end());
  Rng rng(1);
  kind->change(map, 1.0, rng);
  EXPECT_EQ(map.points.size(), 60U + 4 * 4);
  for (const auto& [column, row] : {std::pair{20, 10}, {21, 11}, {31, 10}, {30, 24}, {20, 25}, {5, 0}})
    EXPECT_EQ(map.grid.cell(column, row), Cell::occupied) << column << ", " << row;
  for (const auto& [column, row] : {std::pair{22, 10}, {20, 12}, {25, 17}})
    EXPECT_EQ(map.grid.cell(column, row), Cell::free) << column << ", " << row;
}

TEST_F(Disturbed, BoxesAreBroughtByTheFloor) {
  // 16 on 100 square metres of 26 free ones: 4 boxes of 1 to 2 cells along each side.
  const std::size_t more = occupied(map({{{"brought", 5, {}}}})) - 56;
  EXPECT_GE(more, 2U);
  EXPECT_LE(more, 16U);
}

TEST_F(Disturbed, WallsAreMissingByTheBlock) {
  const MapData left = map({{{"missing_walls", 0, 0.5}}}, 5);
  EXPECT_EQ(left.points.size(), occupied(left));
  EXPECT_GT(occupied(left), 10U);
  EXPECT_LT(occupied(left), 46U);
  // Cells of one block go together: those of the lower wall are in pairs.
  for (int column = 0; column < 20; column += 2)
    EXPECT_EQ(left.grid.cell(column, 0), left.grid.cell(column + 1, 0)) << column;
}

TEST_F(Disturbed, WhatIsCutOffIsUnknown) {
  const MapData left = map({{{"cut_off", 0, 0.5}}});
  EXPECT_EQ(left.grid.at(2.25, 2.25), Cell::free);
  EXPECT_EQ(left.grid.at(7.25, 2.25), Cell::unknown);
  EXPECT_EQ(left.grid.at(9.75, 2.25), Cell::unknown);
  for (const float x : left.points.x) EXPECT_LE(x, 5.0F);
}

TEST_F(Disturbed, BlurMovesPointsAndCoarseCellsJoinThem) {
  const MapData blurred = map({{{"blurred", 0, 0.05}}});
  const MapData sharp = map({{{"taken", 0, 1e-9}}});
  double squares = 0.0;
  for (std::size_t i = 0; i < sharp.points.size(); ++i)
    squares +=
        std::pow(blurred.points.x[i] - sharp.points.x[i], 2) / static_cast<double>(sharp.points.size());
  EXPECT_NEAR(std::sqrt(squares), 0.05, 0.02);
  const MapData coarse = map({{{"coarse", 1, {}}}});
  EXPECT_EQ(coarse.grid.resolution, 1.0);
  EXPECT_EQ(coarse.grid.width, 10);
  EXPECT_EQ(coarse.grid.at(4.5, 1.75), Cell::occupied) << "the box's left half is in it";
  EXPECT_EQ(coarse.grid.at(2.5, 1.75), Cell::free);
}

TEST_F(Disturbed, AStretchedMapKeepsItsMiddle) {
  // Points from 0.25 to 9.75 m: the middle is 5 m.
  const MapData stretched = map({{{"stretched", 0, 100.0}}});
  EXPECT_NEAR(*std::max_element(stretched.points.x.begin(), stretched.points.x.end()), 5.0 + 1.1 * 4.75,
              1e-5);
  EXPECT_EQ(stretched.grid.at(5.0, 2.0), Cell::occupied);
  EXPECT_NEAR(stretched.grid.resolution, 0.55, 1e-12);
}

TEST_F(Disturbed, AShearedMapLeansAboutItsMiddle) {
  // Points from 0.25 to 3.75 m along y: the middle is 2 m. Half a metre away everything is 5 cm aside.
  const MapData sheared = map({{{"sheared", 0, 100.0}}});
  const MapData upright = map({{{"taken", 0, 1e-9}}});
  ASSERT_EQ(sheared.points.y, upright.points.y);
  for (std::size_t i = 0; i < upright.points.size(); ++i)
    EXPECT_NEAR(sheared.points.x[i], upright.points.x[i] + 0.1F * (upright.points.y[i] - 2.0F), 1e-5F);
  for (std::size_t i = 0; i < sheared.points.size(); ++i)
    EXPECT_EQ(sheared.grid.at(sheared.points.x[i], sheared.points.y[i]), Cell::occupied);
}

/// Amounts rise with the level, or fall.
template <class Kinds>
void expect_levels_in_order(const Kinds& kinds) {
  for (const auto& kind : kinds) {
    const bool is_constant = kind.levels.front() == kind.levels.back();
    EXPECT_TRUE(is_constant || std::is_sorted(kind.levels.begin(), kind.levels.end()) ||
                std::is_sorted(kind.levels.rbegin(), kind.levels.rend()))
        << kind.name;
    for (const double level : kind.levels) EXPECT_LE(level, kind.most) << kind.name;
  }
}

template <class Kinds>
std::string table_of(const Kinds& kinds) {
  std::string table;
  for (const auto& kind : kinds) {
    std::string levels;
    for (const double level : kind.levels) levels += (levels.empty() ? "" : ", ") + fmt::format("{}", level);
    table += fmt::format("| `{}` | {} | {} | `{}` | {} |\n", kind.name, kind.amount, kind.unit, levels,
                         kind.reason);
  }
  return table;
}

TEST(DisturbanceLevels, AreInOrderAndOnTheirPage) {
  expect_levels_in_order(disturbance_kinds());
  expect_levels_in_order(map_disturbance_kinds());
  const std::string page = read_text_file(std::filesystem::path(GLOCAL_SOURCE_DIR) / "docs/disturbances.md");
  EXPECT_THAT(page, HasSubstr(table_of(disturbance_kinds())));
  EXPECT_THAT(page, HasSubstr(table_of(map_disturbance_kinds())));
}

}  // namespace
}  // namespace glocal::disturbed::disturbed_test
