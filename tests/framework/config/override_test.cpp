// Values from the command line end up where the file would have them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/overrides.hpp"
#include "files.hpp"
#include "framework/config/toy_catalog.hpp"
#include "glocal/experiment.hpp"

namespace glocal::test::override_test {
namespace {

using testing::ElementsAre;
using testing::StartsWith;

class OverrideTest : public testing::Test {
 protected:
  OverrideTest() {
    register_toys(catalog_);
    folder_.write("map.txt", "a map");
  }

  Experiment read(const std::string& localizer, const std::vector<Override>& overrides) {
    const std::string text =
        "schema: 1\nname: toy\nmap: {toy_map: {path: map.txt}}\nobservations: toy_drive\ntrials: {every_m: "
        "6}\n" +
        localizer;
    return read_experiment(folder_.write("e.yaml", text), overrides, catalog_);
  }

  static const ToyMatcher::Params& matcher(const Experiment& e) {
    return dynamic_cast<const ParamsOf<ToyMatcher::Params>&>(*e.localizer.matcher.params).value;
  }

  std::vector<std::string> faults_of(const std::vector<Override>& overrides) {
    return config_faults(folder_.path(), [&] { return read("", overrides); });
  }

  Catalog catalog_;
  TemporaryFolder folder_;
};

const Override five_iterations = {"localizer.matcher.ransam.iterations", "5"};

TEST_F(OverrideTest, ReplacesAValue) {
  const Experiment e =
      read("localizer: {matcher: {ransam: {iterations: 7, contact_epsilon: 0.3}}}\n", {five_iterations});
  EXPECT_EQ(matcher(e).iterations, 5);
  EXPECT_DOUBLE_EQ(matcher(e).contact_epsilon, 0.3);
}

TEST_F(OverrideTest, ReachesStrategiesThatAreDefaultedBareOrWithoutBody) {
  for (const char* localizer :
       {"", "localizer:\n", "localizer: {matcher: ransam}\n", "localizer: {matcher: {ransam: }}\n"}) {
    EXPECT_EQ(matcher(read(localizer, {five_iterations})).iterations, 5) << localizer;
  }
}

TEST_F(OverrideTest, ReplacesAnotherStrategy) {
  for (const char* localizer : {"localizer: {matcher: indexed}\n", "localizer: {matcher: {indexed: {}}}\n"}) {
    const Experiment e = read(localizer, {five_iterations});
    EXPECT_EQ(e.localizer.matcher.name, "ransam") << localizer;
    EXPECT_EQ(matcher(e).iterations, 5) << localizer;
  }
  EXPECT_EQ(read("", {{"localizer.matcher", "indexed"}}).localizer.matcher.name, "indexed");
  EXPECT_EQ(matcher(read("", {{"localizer.matcher", "{ransam: {iterations: 9}}"}})).iterations, 9);
}

TEST_F(OverrideTest, LastOneWins) {
  EXPECT_EQ(matcher(read("", {five_iterations, {"localizer.matcher.ransam.iterations", "6"}})).iterations, 6);
  EXPECT_EQ(read("", {five_iterations, {"localizer.matcher", "indexed"}}).localizer.matcher.name, "indexed");
}

TEST_F(OverrideTest, ValuesAreYaml) {
  const Experiment e =
      read("", {{"trials.every_m", "0"}, {"trials.starts_m", "[1.5, 20]"}, {"output.steps", "false"}});
  EXPECT_THAT(e.trials.starts_m, ElementsAre(1.5, 20.0));
  EXPECT_FALSE(e.output.steps);
}

TEST_F(OverrideTest, MakesNestedMaps) {
  const Experiment e = read("", {{"observations.toy_drive.noise.beams", "3"}});
  EXPECT_EQ(dynamic_cast<const ParamsOf<ToyDrive::Params>&>(*e.observations.params).value.noise.beams, 3);
}

TEST_F(OverrideTest, PathsStartFromTheWorkingDirectory) {
  const auto other = folder_.write("other.txt", "another map");
  const auto relative = std::filesystem::relative(other).string();
  const Experiment e = read("", {{"map.toy_map.path", relative}});
  EXPECT_EQ(dynamic_cast<const ParamsOf<ToyMap::Params>&>(*e.map.params).value.path.resolved, other);
}

TEST_F(OverrideTest, FaultsNameTheOverride) {
  EXPECT_THAT(
      faults_of({{"localizer.matcher.ransam.iteration", "5"}}),
      ElementsAre("--set localizer.matcher.ransam.iteration=5: error: localizer.matcher.ransam: unknown key "
                  "'iteration' (did you mean 'iterations'?)"));
  EXPECT_THAT(
      faults_of({{"localizer.matcher.ransam.iterations", "0"}}),
      ElementsAre(
          "--set localizer.matcher.ransam.iterations=0: error: localizer.matcher.ransam: iterations: 0 "
          "is out of range, must be >= 1"));
  EXPECT_THAT(
      faults_of({{"localizer.matcher.ransam.iterations", ""}}),
      ElementsAre("--set localizer.matcher.ransam.iterations=: error: localizer.matcher.ransam: iterations: "
                  "expected a whole number, got nothing"));
  EXPECT_THAT(
      faults_of({{"localiser.matcher", "ransam"}}),
      ElementsAre(
          "--set localiser.matcher=ransam: error: unknown key 'localiser' (did you mean 'localizer'?)"));
  EXPECT_THAT(
      faults_of({{"seed", "[1"}}),
      ElementsAre("--set seed=[1: error: not valid YAML: end of sequence flow not found (is a ']' or ',' "
                  "missing?)"));
  EXPECT_THAT(faults_of({{"seed..x", "1"}}),
              ElementsAre("--set seed..x=1: error: the path has an empty part; write it as a.b.c"));
  EXPECT_THAT(faults_of({{"name.first", "1"}}),
              ElementsAre("--set name.first=1: error: cannot set 'first': 'name' is not a map but 'toy'"));
  EXPECT_THAT(
      faults_of({{"localizer.matcher.ransac.iterations", "1"}}),
      ElementsAre("--set localizer.matcher.ransac.iterations=1: error: localizer: matcher: unknown matcher "
                  "'ransac', did you mean 'ransam'? (there are: indexed, ransam); 'ransac' is a method: "
                  "--method ransac"));
}

TEST_F(OverrideTest, APathDeeperThanAnyExperimentIsRefused) {
  std::string path = "a";
  for (int i = 0; i < 200000; ++i) path += ".a";
  EXPECT_THAT(faults_of({{path, "1"}}),
              ElementsAre(testing::HasSubstr("the path has 200001 parts; no value lies deeper than 32")));
}

TEST_F(OverrideTest, ALocalizerIsReadFromValuesAlone) {
  const LocalizerConfig config = read_localizer(
      {{"matcher.ransam.iterations", "5"}, {"contact_epsilon", "0.25"}, {"unknown_place.window", "3"}},
      catalog_);
  EXPECT_EQ(dynamic_cast<const ParamsOf<ToyMatcher::Params>&>(*config.matcher.params).value.iterations, 5);
  EXPECT_EQ(config.contact_epsilon, 0.25);
  EXPECT_EQ(config.unknown_place.window, 3);
  EXPECT_EQ(config.motion, Motion::planar);
}

TEST_F(OverrideTest, EveryFaultOfALocalizersValuesIsFound) {
  const std::vector<Override> wrong = {{"matcher.ransam.iteration", "5"}, {"motion", "sideways"}};
  EXPECT_THAT(config_faults(folder_.path(), [&] { return read_localizer(wrong, catalog_); }),
              ElementsAre(StartsWith("--set matcher.ransam.iteration=5: error: "),
                          StartsWith("--set motion=sideways: error: ")));
}

}  // namespace
}  // namespace glocal::test::override_test
