// What every source promises.
#include <gtest/gtest.h>

#include "config/writer.hpp"
#include "contract/strategies.hpp"
#include "glocal/yaml.hpp"

namespace glocal::test::sources_test {
namespace {

std::vector<Sample> all_of(ObservationSource& source) {
  std::vector<Sample> samples;
  while (auto sample = source.next()) samples.push_back(std::move(*sample));
  return samples;
}

TEST_F(Contract, ObservationSourcesEndForGood) {
  for_each(catalog_.observation_sources, [&](const StrategyChoice& choice) {
    const auto source = catalog_.observation_sources.make(choice, {});
    EXPECT_FALSE(all_of(*source).empty());
    EXPECT_FALSE(source->next().has_value());
    EXPECT_FALSE(source->next().has_value());
  });
}

TEST_F(Contract, ObservationSourcesRepeatThemselves) {
  for_each(catalog_.observation_sources, [&](const StrategyChoice& choice) {
    const SourceSetup setup{.seed = 7};
    const auto a = all_of(*catalog_.observation_sources.make(choice, setup));
    const auto b = all_of(*catalog_.observation_sources.make(choice, setup));
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_EQ(a[i].observation.stamp, b[i].observation.stamp);
      EXPECT_EQ(a[i].observation.scan.hits, b[i].observation.scan.hits);
      EXPECT_EQ(a[i].observation.scan.free_ends, b[i].observation.scan.free_ends);
      EXPECT_EQ(a[i].observation.odom_from_robot, b[i].observation.odom_from_robot);
      EXPECT_EQ(a[i].map_from_robot, b[i].map_from_robot);
    }
  });
}

TEST_F(Contract, ARecordingIsReadBackAsTheDriveItself) {
  std::size_t recorded = 0;
  for_each(catalog_.observation_sources, [&](const StrategyChoice& choice) {
    const auto source = catalog_.observation_sources.make(choice, {.seed = 7});
    (void)source->next();  // what has been delivered is in it all the same
    const auto recording = source->recording();
    if (!recording) return;
    ++recorded;
    const std::string file = folder_.write(recording->file_name, recording->content);
    const std::string text = write_yaml(*recording->source.params);
    StrategyChoice reader = catalog_.observation_sources.choose(recording->source.name);
    read_yaml(folder_.write("recording.yaml", text), *reader.params);
    const auto again = all_of(*catalog_.observation_sources.make(reader, {}));
    const auto drive = all_of(*catalog_.observation_sources.make(choice, {.seed = 7}));
    ASSERT_EQ(again.size(), drive.size());
    EXPECT_EQ(recording->observations, drive.size());
    for (std::size_t i = 0; i < drive.size(); ++i) {
      EXPECT_LT(distance(*again[i].map_from_robot, *drive[i].map_from_robot), 1e-5);
      EXPECT_EQ(again[i].observation.scan.hits.size(), drive[i].observation.scan.hits.size());
      EXPECT_EQ(again[i].observation.scan.free_ends.size(), drive[i].observation.scan.free_ends.size());
    }
  });
  EXPECT_GT(recorded, 0U);
}

TEST_F(Contract, SourcesNoteTheFilesTheyRead) {
  std::size_t noted = 0;
  // An office is made up.
  const auto reads_files = [](const StrategyChoice& choice) { return choice.name != "office"; };
  const SourceSetup setup{.note_input = [&](const std::filesystem::path& file) {
    ++noted;
    EXPECT_TRUE(std::filesystem::is_regular_file(file)) << file;
  }};
  for_each(catalog_.observation_sources, [&](const StrategyChoice& choice) {
    noted = 0;
    static_cast<void>(all_of(*catalog_.observation_sources.make(choice, setup)));
    EXPECT_EQ(noted > 0, reads_files(choice));
  });
  for_each(catalog_.map_sources, [&](const StrategyChoice& choice) {
    noted = 0;
    static_cast<void>(catalog_.map_sources.make(choice, setup)->load());
    EXPECT_EQ(noted > 0, reads_files(choice));
  });
}

TEST_F(Contract, MapSourcesGiveTheSamePointsAndAWholeGrid) {
  for_each(catalog_.map_sources, [&](const StrategyChoice& choice) {
    const MapData a = catalog_.map_sources.make(choice, {})->load();
    const MapData b = catalog_.map_sources.make(choice, {})->load();
    EXPECT_FALSE(a.points.empty());
    EXPECT_EQ(a.points, b.points);
    EXPECT_EQ(a.grid.cells, b.grid.cells);
    EXPECT_GT(a.grid.cells.empty() ? a.resolution : a.grid.resolution, 0.0);
    EXPECT_EQ(a.grid.cells.size(),
              static_cast<std::size_t>(a.grid.width) * static_cast<std::size_t>(a.grid.height));
    if (!a.normals.empty()) {
      EXPECT_EQ(a.normals.size(), a.points.size());
    }
  });
}

}  // namespace
}  // namespace glocal::test::sources_test
