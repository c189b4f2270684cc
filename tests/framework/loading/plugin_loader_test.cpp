// Files that are no shared objects are handed to whoever knows them. Shared objects: tests/plugins/.
#include "loading/plugin_loader.hpp"

#include <gmock/gmock.h>

#include <stdexcept>

#include "files.hpp"
#include "framework/config/toy_catalog.hpp"
#include "glocal/error.hpp"

namespace glocal::test::plugin_loader_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

/// All hypotheses in one cluster.
struct AnyClusterer final : Clusterer {
  [[nodiscard]] std::vector<Cluster> cluster(const std::vector<Hypothesis>&, Rng&) override { return {}; }
};

/// A strategy without a class of its own.
void add_found(Catalog& catalog) {
  catalog.clusterers.add_made(
      "found", "Was found in a file.", all_motions, [] { return std::make_unique<ParamsOf<NoParams>>(); },
      [](const AnyParams&, const StageSetup&) { return std::make_unique<AnyClusterer>(); });
}

class PluginLoaderTest : public testing::Test {
 protected:
  /// What load() says of a file that is read like this.
  std::string fault_of(const PluginLoader::LoadOther& load) {
    loader_.hand_over(".toy", load);
    return error_of([&] { loader_.load(file_); });
  }

  TemporaryFolder folder_;
  std::filesystem::path file_ = folder_.write("two words.toy", "");
  Catalog catalog_;
  PluginLoader loader_{catalog_};
};

TEST_F(PluginLoaderTest, HandsAFileOverOnce) {
  int calls = 0;
  EXPECT_EQ(fault_of([&](const std::filesystem::path& file, Catalog& catalog) {
              ++calls;
              EXPECT_EQ(file, std::filesystem::canonical(file_));
              add_found(catalog);
            }),
            "");
  loader_.load(file_);
  EXPECT_EQ(calls, 1);
  EXPECT_THAT(loader_.loaded(), ElementsAre(std::filesystem::canonical(file_)));
  const StrategyInfo* info = catalog_.clusterers.find("found");
  ASSERT_NE(info, nullptr);
  EXPECT_EQ(info->origin, "two words.toy");
  EXPECT_TRUE(info->motions.contain(Motion::free));
  EXPECT_NE(dynamic_cast<AnyClusterer*>(catalog_.clusterers.make({"found"}, {}).get()), nullptr);
}

TEST_F(PluginLoaderTest, NamesTheFileInFaults) {
  EXPECT_THAT(fault_of([](const auto&, Catalog&) { throw std::runtime_error("odd"); }),
              AllOf(HasSubstr("two words.toy"), HasSubstr("odd")));
  EXPECT_THAT(fault_of([](const auto&, Catalog& catalog) {
                add_found(catalog);
                add_found(catalog);
              }),
              AllOf(HasSubstr("two words.toy"), HasSubstr("already registered"), HasSubstr("rename one")));
  EXPECT_EQ(fault_of([](const auto&, Catalog&) {
              throw ConfigError({{"a", 1, 2, "b"}});
            }),
            "a:1:2: error: b");
  EXPECT_TRUE(loader_.loaded().empty());
}

TEST_F(PluginLoaderTest, TakesOtherFilesForSharedObjects) {
  loader_.hand_over(".toy", [](const auto&, Catalog&) { FAIL(); });
  EXPECT_THROW(loader_.load(folder_.write("some.txt", "")), ConfigError);
}

}  // namespace
}  // namespace glocal::test::plugin_loader_test
