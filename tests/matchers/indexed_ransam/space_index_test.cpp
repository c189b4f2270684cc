#include "matchers/indexed_ransam/space_index.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <vector>

#include "files.hpp"
#include "matchers/in_space/hall_map.hpp"
#include "matchers/indexed_ransam/indexed_ransam.hpp"

namespace glocal::test::space_index_test {
namespace {

using ::testing::HasSubstr;

const IndexOrigin origin{77, "rule"};
const SpaceIndexRule rule{.voxel_size = 0.2F, .pairs = 20000};

const SpaceIndex& built() {
  static const SpaceIndex index(hall_map()->points(), rule);
  return index;
}

/// The sections of a saved index, to be damaged.
struct Sections {
  Sections() {
    const Surfels& surfels = built().map.surfels;
    const FixedVoxelTable& table = built().map.contact.nearest_numbers();
    floats = {surfels.points.x,  surfels.points.y,  surfels.points.z,
              surfels.normals.x, surfels.normals.y, surfels.normals.z};
    numbers = {table.brick_numbers().copy(),
               table.voxel_numbers().copy(),
               {built().pairs.starts().begin(), built().pairs.starts().end()}};
    pairs.assign(built().pairs.pairs().begin(), built().pairs.pairs().end());
  }
  [[nodiscard]] std::string file() const {
    const auto bytes = [](const auto& values) { return std::as_bytes(std::span(values)); };
    return saved_index(
        SpaceIndex::kind, origin,
        {bytes(floats[0]), bytes(floats[1]), bytes(floats[2]), bytes(floats[3]), bytes(floats[4]),
         bytes(floats[5]), bytes(numbers[0]), bytes(numbers[1]), bytes(numbers[2]), bytes(pairs)});
  }

  std::array<std::vector<float>, 6> floats;           ///< x, y, z of points and normals.
  std::array<std::vector<std::uint32_t>, 3> numbers;  ///< Of bricks and voxels, and starts of buckets.
  std::vector<SurfelPair> pairs;
};

class SavedSpaceIndex : public ::testing::Test {
 protected:
  [[nodiscard]] SpaceIndex read(const std::string& bytes, const SpaceIndexRule& wanted = rule) const {
    return {SavedIndex(folder_.write("a.index", bytes), origin), wanted};
  }
  /// What is wrong with an index that was changed so.
  template <class Change>
  [[nodiscard]] std::string fault_of(Change change) const {
    Sections sections;
    change(sections);
    const std::string bytes = sections.file();
    return config_error("", [&] { (void)read(bytes); });
  }

  TemporaryFolder folder_;
};

TEST_F(SavedSpaceIndex, IsTheSameAsBefore) {
  const std::string bytes = built().saved(origin);
  EXPECT_EQ(bytes, Sections().file());
  const SpaceIndex again = read(bytes);
  EXPECT_EQ(again.saved(origin), bytes);
  EXPECT_EQ(again.memory_bytes(), built().memory_bytes());
  EXPECT_EQ(again.map.surfels.points, built().map.surfels.points);
  EXPECT_EQ(again.map.surfels.normals, built().map.surfels.normals);
  EXPECT_EQ(again.map.surfels.weights, built().map.surfels.weights);
  ASSERT_GT(again.pairs.size(), 10000U);
  // Contact is the same everywhere, in the hall and beyond.
  Rng rng(1);
  std::size_t touched = 0;
  for (int i = 0; i < 20000; ++i) {
    const Point p{static_cast<float>(rng.uniform(-2.0, 16.0)), static_cast<float>(rng.uniform(-2.0, 11.0)),
                  static_cast<float>(rng.uniform(-2.0, 6.0))};
    ASSERT_EQ(again.map.contact.nearest(p), built().map.contact.nearest(p));
    const bool touches = built().map.contact.touches(p, {0.0F, 0.0F, 1.0F});
    ASSERT_EQ(again.map.contact.touches(p, {0.0F, 0.0F, 1.0F}), touches);
    if (touches) ++touched;
  }
  EXPECT_GT(touched, 500U);
}

TEST_F(SavedSpaceIndex, WhosePartsDoNotFitIsRefused) {
  ASSERT_EQ(fault_of([](Sections&) {}), "");
  const std::string parts = "its parts do not fit together; build it anew: glocal map index ";
  for (std::size_t i = 0; i < 6; ++i)
    EXPECT_THAT(fault_of([&](Sections& s) { s.floats[i].pop_back(); }), HasSubstr(parts)) << i;
  EXPECT_THAT(fault_of([](Sections& s) {
                for (std::size_t i = 0; i < 3; ++i) s.floats[i].pop_back();
              }),
              HasSubstr(parts));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_THAT(fault_of([&](Sections& s) { s.numbers[i].pop_back(); }), HasSubstr(parts)) << i;
    EXPECT_THAT(fault_of([&](Sections& s) { s.numbers[i].clear(); }), HasSubstr("the index is damaged")) << i;
  }
  EXPECT_THAT(fault_of([](Sections& s) { s.pairs.pop_back(); }), HasSubstr("its bins overlap"));
  EXPECT_THAT(fault_of([](Sections& s) { s.numbers[2][5] = 20001; }), HasSubstr("its bins overlap"));
  // Twice the pairs, twice the buckets.
  EXPECT_THAT(config_error("", [&] { (void)read(Sections().file(), {0.2F, 40000}); }), HasSubstr(parts));
}

TEST_F(SavedSpaceIndex, ThatNamesWhatItDoesNotHaveIsRefused) {
  const auto surfels = static_cast<std::uint32_t>(built().map.surfels.size());
  const auto bricks = static_cast<std::uint32_t>(Sections().numbers[1].size() / 512);
  const std::string missing = "it names points that it does not have";
  const auto first_number = [](std::vector<std::uint32_t>& numbers) -> std::uint32_t& {
    return *std::find_if(numbers.begin(), numbers.end(),
                         [](std::uint32_t number) { return number != VoxelTable::none; });
  };
  EXPECT_EQ(fault_of([&](Sections& s) { first_number(s.numbers[0]) = bricks - 1; }), "");
  EXPECT_THAT(fault_of([&](Sections& s) { first_number(s.numbers[0]) = bricks; }), HasSubstr(missing));
  EXPECT_EQ(fault_of([&](Sections& s) { first_number(s.numbers[1]) = surfels - 1; }), "");
  EXPECT_THAT(fault_of([&](Sections& s) { first_number(s.numbers[1]) = surfels; }), HasSubstr(missing));
  EXPECT_THAT(fault_of([&](Sections& s) { s.pairs.back().second = surfels; }), HasSubstr(missing));
}

TEST_F(SavedSpaceIndex, WhoseSurfelsCannotBeIsRefused) {
  for (const float odd : {std::nanf(""), HUGE_VALF, -2e9F}) {
    for (std::size_t i = 0; i < 6; ++i)
      EXPECT_THAT(fault_of([&](Sections& s) { s.floats[i].front() = odd; }), HasSubstr("lie nowhere")) << i;
  }
  EXPECT_THAT(fault_of([&](Sections& s) {
                for (std::size_t i = 3; i < 6; ++i) s.floats[i].back() = 0.0F;
              }),
              HasSubstr("it has normals that are not of unit length"));
}

TEST_F(SavedSpaceIndex, OfAnotherKindIsRefused) {
  const std::string other = saved_index("triangles", origin, {});
  EXPECT_THAT(config_error("", [&] { (void)read(other); }),
              HasSubstr("the index is one of triangles instead of surfel pairs"));
}

/// A matcher of the hall, and what it says of a scan in it.
class SavedSearch : public ::testing::TestWithParam<Motion> {
 protected:
  [[nodiscard]] std::unique_ptr<Matcher> make(const std::string& index_file, int pairs = 20000) const {
    IndexedRansam::Params params{.space = {.voxel_size = 0.2, .pairs = pairs}};
    params.index_file = file_path(index_file);
    StageSetup setup{.map = hall_map(), .motion = GetParam()};
    setup.note_input = [this](const std::filesystem::path& file) { noted_.push_back(file); };
    return IndexedRansam::make(params, setup);
  }

  TemporaryFolder folder_;
  mutable std::vector<std::filesystem::path> noted_;
};

TEST_P(SavedSearch, GivesTheSameAnswersAsABuiltOne) {
  const auto builder = make("");
  const std::filesystem::path file = folder_.write("a.index", builder->saved_index().value());
  EXPECT_TRUE(noted_.empty());
  const auto reader = make(file.string());
  EXPECT_EQ(noted_, std::vector{file});
  EXPECT_EQ(reader->saved_index(), builder->saved_index());
  EXPECT_EQ(reader->map_index()->entries, builder->map_index()->entries);
  EXPECT_EQ(reader->map_index()->bytes, builder->map_index()->bytes);

  Observation latest;
  latest.scan.hits = scan_of(hall(), {{5.0, 4.5, 1.2}, turn_about_z(0.7)});
  LocalMap local;
  local.points = latest.scan.hits;
  local.ends = {local.points.size()};
  for (int step = 0; step < 2; ++step) {
    Rng one(5);
    Rng two(5);
    const MatchResult expected = builder->match(local, latest, 0.0, one);
    const MatchResult found = reader->match(local, latest, 0.0, two);
    ASSERT_GT(expected.hypotheses.size(), 1U);
    ASSERT_EQ(found.hypotheses.size(), expected.hypotheses.size());
    for (std::size_t i = 0; i < found.hypotheses.size(); ++i) {
      EXPECT_EQ(found.hypotheses[i].map_from_local, expected.hypotheses[i].map_from_local);
      EXPECT_EQ(found.hypotheses[i].quality, expected.hypotheses[i].quality);
      EXPECT_EQ(found.hypotheses[i].score, expected.hypotheses[i].score);
    }
    EXPECT_EQ(found.proposals, expected.proposals);
    EXPECT_EQ(found.points_tested, expected.points_tested);
  }
}

TEST_P(SavedSearch, AFileThatDoesNotFitIsRefused) {
  const std::filesystem::path file = folder_.write("a.index", make("")->saved_index().value());
  EXPECT_THAT(config_error("", [&] { (void)make(file.string(), 30000); }),
              HasSubstr("was built with other parameters: pairs 20000 instead of pairs 30000"));
  EXPECT_THAT(
      config_error(
          "",
          [&] { const IndexedRansam in_the_plane({.index_file = file_path(file)}, {.map = hall_map()}); }),
      HasSubstr("was built with other parameters: relation surfel_pair instead of relation auto"));
  EXPECT_THAT(config_error("", [&] { (void)make((folder_ / "none.index").string()); }),
              HasSubstr("the index cannot be read: No such file or directory"));
}

INSTANTIATE_TEST_SUITE_P(Motions, SavedSearch, ::testing::Values(Motion::upright, Motion::free));

}  // namespace
}  // namespace glocal::test::space_index_test
