#include "matchers/indexed_ransam/saved_index.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <cmath>
#include <cstring>
#include <optional>

#include "files.hpp"
#include "glocal/rng.hpp"
#include "matchers/indexed_ransam/oriented_pair_index.hpp"
#include "test_world.hpp"

namespace glocal::test::saved_index_test {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

const IndexOrigin origin{77, "min_length 0.5, max_length 6, angle_cells 24"};

class SavedIndexFile : public ::testing::Test {
 protected:
  /// What is wrong with these bytes as a file; empty if nothing is.
  [[nodiscard]] std::string fault_of(const std::string& bytes, const IndexOrigin& wanted = origin) const {
    const std::filesystem::path file = folder_.write("a.index", bytes);
    return config_error(folder(), [&] { const SavedIndex read(file, wanted); });
  }
  [[nodiscard]] std::filesystem::path folder() const { return (folder_ / "a.index").parent_path(); }

  TemporaryFolder folder_;
};

std::string two_sections() {
  const std::vector<std::uint32_t> numbers = {1, 2, 3};
  const std::vector<float> values = {0.5F, -1.25F};
  return saved_index("numbers", origin,
                     {std::as_bytes(std::span(numbers)), std::as_bytes(std::span(values))});
}

TEST_F(SavedIndexFile, GivesItsSectionsBackAsLongAsSomebodyHoldsThem) {
  const std::filesystem::path file = folder_.write("a.index", two_sections());
  SharedArray<std::uint32_t> numbers;
  SharedArray<float> values;
  {
    const SavedIndex saved(file, origin);
    numbers = saved.section<std::uint32_t>(0);
    values = saved.section<float>(1);
  }
  EXPECT_THAT(numbers.span(), ::testing::ElementsAre(1, 2, 3));
  EXPECT_THAT(values.span(), ::testing::ElementsAre(0.5F, -1.25F));
}

TEST_F(SavedIndexFile, SaysWhatIsWrongWithItAndHowToBuildItAnew) {
  const std::string good = two_sections();
  ASSERT_THAT(fault_of(good), IsEmpty());
  std::string reversed = good;
  std::swap(reversed[8], reversed[11]);
  std::swap(reversed[9], reversed[10]);
  std::string newer = good;
  newer[12] = 9;
  std::string older = good;
  older[12] = 1;
  const std::vector<std::pair<std::string, std::string>> cases = {
      {fault_of(""),
       "a.index: error: the index cannot be read: the file is empty; build it anew: glocal map "
       "index EXPERIMENT.yaml --force -o a.index"},
      {fault_of("schema: 1\nname: not an index, but a file that is long enough to be one\n"),
       "this is not an index of a map"},
      {fault_of(reversed), "saved on a machine of another byte order"},
      {fault_of(newer), "has version 9 of the format; this program reads version 3"},
      {fault_of(older), "has version 1 of the format; this program reads version 3"},
      {fault_of(good.substr(0, good.size() - 1)), "is not whole: the file has"},
      {fault_of(good + "x"), "is not whole: the file has"},
      {fault_of(good, {78, origin.rule}), "belongs to another map"},
      {fault_of(good, {77, "min_length 0.5, max_length 7, angle_cells 24"}),
       "was built with other parameters: max_length 6 instead of max_length 7; build it anew"},
      {config_error(folder(), [&] { const SavedIndex none(folder_ / "none.index", origin); }),
       "none.index: error: the index cannot be read: No such file or directory; build it anew"},
      {config_error(folder(), [&] { const SavedIndex none(folder_ / "", origin); }), "not a regular file"}};
  for (const auto& [said, expected] : cases) EXPECT_THAT(said, HasSubstr(expected));
}

TEST_F(SavedIndexFile, ANamedPipeIsRefusedAtOnce) {
  ASSERT_EQ(::mkfifo((folder_ / "pipe").c_str(), 0600), 0);
  EXPECT_THAT(config_error(folder(), [&] { const SavedIndex none(folder_ / "pipe", origin); }),
              HasSubstr("not a regular file"));
}

TEST_F(SavedIndexFile, NoChangedByteAndNoLengthGoesUnnoticed) {
  const std::string good = two_sections();
  for (std::size_t i = 0; i < good.size(); ++i) {
    std::string bad = good;
    bad[i] = static_cast<char>(bad[i] ^ 0x10);
    EXPECT_THAT(fault_of(bad), HasSubstr("; build it anew: ")) << "byte " << i;
    EXPECT_THAT(fault_of(good.substr(0, i)), HasSubstr("; build it anew: ")) << i << " bytes";
  }
}

TEST_F(SavedIndexFile, ASectionThatIsNotThereIsRefused) {
  const SavedIndex saved(folder_.write("a.index", two_sections()), origin);
  EXPECT_THAT(config_error(folder(), [&] { (void)saved.section<float>(2); }), HasSubstr("is missing"));
  EXPECT_THAT(config_error(folder(), [&] { (void)saved.section<double>(0); }), HasSubstr("no place"));
}

TEST(MapDigest, DependsOnEveryPointCellAndFreeVoxel) {
  const auto digest_with = [](auto change) {
    MapData data;
    data.points = glocal::test::small_world_points();
    data.grid = {{-0.05, -0.05, 0.0}, 0.1, 82, 92, std::vector<Cell>(std::size_t{82} * 92, Cell::free)};
    change(data);
    return digest_of(GlobalMap(std::move(data)));
  };
  const std::uint64_t as_it_is = digest_with([](MapData&) {});
  EXPECT_EQ(as_it_is, digest_of(*glocal::test::small_world()));
  EXPECT_NE(as_it_is, digest_with([](MapData& data) { data.points.x.back() += 0.001F; }));
  EXPECT_NE(as_it_is, digest_with([](MapData& data) { data.points.y.front() += 0.001F; }));
  EXPECT_NE(as_it_is, digest_with([](MapData& data) { data.points.z.back() += 0.001F; }));
  EXPECT_NE(as_it_is, digest_with([](MapData& data) { data.points.push_back({1.0F, 1.0F, 0.0F}); }));
  EXPECT_NE(as_it_is, digest_with([](MapData& data) { data.grid.cell(81, 91) = Cell::unknown; }));
  EXPECT_NE(as_it_is, digest_with([](MapData& data) { data.grid.map_from_grid.x = 0.0; }));
  const auto digest_with_free = [&](double side, int layer) {
    return digest_with([&](MapData& data) {
      data.free_voxels = FreeVoxels({}, side);
      data.free_voxels.add(1, 2, 3);
      data.free_voxels.add(1, 2, layer);
    });
  };
  EXPECT_NE(as_it_is, digest_with_free(0.1, 3));
  EXPECT_EQ(digest_with_free(0.1, 3), digest_with_free(0.1, 3));
  EXPECT_NE(digest_with_free(0.1, 3), digest_with_free(0.1, 4));
  EXPECT_NE(digest_with_free(0.1, 3), digest_with_free(0.2, 3));
}

/// An oriented point pair index of a hundred points, and files of it.
class SavedOrientedPairs : public ::testing::Test {
 protected:
  SavedOrientedPairs() : built_(oriented_points(), {}) {}

  static OrientedPoints oriented_points() {
    Rng rng(4);
    OrientedPoints result;
    for (int i = 0; i < 100; ++i) {
      result.add(static_cast<float>(rng.uniform(0.0, 8.0)), static_cast<float>(rng.uniform(0.0, 8.0)),
                 static_cast<float>(rng.uniform(-3.0, 3.0)));
    }
    return result;
  }

  [[nodiscard]] OrientedPairIndex read(const std::string& bytes) const {
    return {SavedIndex(folder_.write("a.index", bytes), origin), OrientedPairRule{}};
  }

  /// What is wrong with an index of these bins and oriented point pairs.
  [[nodiscard]] std::string fault_of(const std::vector<std::uint32_t>& begins,
                                     const std::vector<OrientedPairIndex::OrientedPair>& pairs,
                                     std::size_t angles = 100) const {
    const OrientedPoints s = oriented_points();
    const std::string bytes =
        saved_index(OrientedPairIndex::kind, origin,
                    {std::as_bytes(std::span(s.x)), std::as_bytes(std::span(s.y)),
                     std::as_bytes(std::span(s.angle).first(angles)), std::as_bytes(std::span(begins)),
                     std::as_bytes(std::span(pairs))});
    return config_error("", [&] { (void)read(bytes); });
  }

  TemporaryFolder folder_;
  OrientedPairIndex built_;
};

TEST_F(SavedOrientedPairs, AreTheSameAsBefore) {
  const std::string bytes = built_.saved(origin);
  const OrientedPairIndex again = read(bytes);
  EXPECT_EQ(again.size(), built_.size());
  EXPECT_EQ(again.memory_bytes(), built_.memory_bytes());
  EXPECT_EQ(again.saved(origin), bytes);
  std::size_t partners = 0;
  for (std::uint32_t i = 0; i + 1 < 100; ++i) {
    const auto one = built_.find(built_.oriented_points(), {i, i + 1});
    const auto other = again.find(again.oriented_points(), {i, i + 1});
    ASSERT_EQ(one.size(), other.size());
    EXPECT_TRUE(std::equal(one.begin(), one.end(), other.begin(), [](const auto& a, const auto& b) {
      return a.first == b.first && a.second == b.second;
    }));
    partners += one.size();
  }
  EXPECT_GT(partners, 50U);
}

TEST_F(SavedOrientedPairs, WhoseBinsOrPointsCannotBeAreRefused) {
  // 55 lengths of 0.1 m and twice 24 angles, and the end of the last bin.
  std::vector<std::uint32_t> begins(55U * 24U * 24U + 1U, 1);
  begins.front() = 0;
  const std::vector<OrientedPairIndex::OrientedPair> one = {{0, 99}};
  ASSERT_EQ(fault_of(begins, one), "");
  EXPECT_THAT(fault_of(begins, {{0, 100}}), HasSubstr("names points that it does not have"));
  EXPECT_THAT(fault_of(begins, {{100, 0}}), HasSubstr("names points that it does not have"));
  EXPECT_THAT(fault_of(begins, {{0, 1}, {2, 3}}), HasSubstr("its bins overlap"));
  EXPECT_THAT(fault_of(begins, one, 99), HasSubstr("its parts do not fit together"));
  std::vector<std::uint32_t> falling = begins;
  falling[5] = 7;
  EXPECT_THAT(fault_of(falling, one), HasSubstr("its bins overlap"));
  begins.pop_back();
  EXPECT_THAT(fault_of(begins, one), HasSubstr("its parts do not fit together"));
  EXPECT_THAT(fault_of({}, {}), HasSubstr("its parts do not fit together"));
}

TEST_F(SavedOrientedPairs, WhosePointsLieNowhereAreRefused) {
  const std::vector<std::uint32_t> begins(55U * 24U * 24U + 1U, 0);
  const std::vector<float> good = {1.0F, 2.0F};
  for (const float odd : {std::nanf(""), HUGE_VALF, -2e9F}) {
    const std::vector<float> bad = {1.0F, odd};
    const auto bytes = [](const auto& values) { return std::as_bytes(std::span(values)); };
    const std::string file = saved_index(OrientedPairIndex::kind, origin,
                                         {bytes(good), bytes(good), bytes(bad), bytes(begins), {}});
    EXPECT_THAT(config_error("", [&] { (void)read(file); }), HasSubstr("it has points that lie nowhere"));
  }
}

}  // namespace
}  // namespace glocal::test::saved_index_test
