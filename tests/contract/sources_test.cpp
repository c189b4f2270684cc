// What the sources that are built in do besides what all promise.
#include <gtest/gtest.h>

#include "config/writer.hpp"
#include "contract/strategies.hpp"
#include "glocal/yaml.hpp"
#include "samples.hpp"

namespace glocal::test::sources_test {
namespace {

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
    EXPECT_TRUE(std::filesystem::is_regular_file(file) || std::filesystem::is_directory(file)) << file;
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

TEST_F(Contract, MapSourcesKnowTheirResolution) {
  for_each(catalog_.map_sources, [&](const StrategyChoice& choice) {
    EXPECT_GT(GlobalMap(catalog_.map_sources.make(choice, {})->load()).resolution(), 0.0);
  });
}

}  // namespace
}  // namespace glocal::test::sources_test
