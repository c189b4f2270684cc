// What is wrong with an experiment file is said with its place, for every kind of fault.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <string>
#include <vector>

#include "files.hpp"
#include "framework/config/toy_catalog.hpp"
#include "glocal/experiment.hpp"

namespace glocal::test::bad_experiment_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::ElementsAreArray;
using testing::HasSubstr;
using testing::SizeIs;
using Lines = std::vector<std::string>;

const std::string valid =
    R"(schema: 1
name: toy
seed: 42
threads: 2
map:
  toy_map: {path: map.txt, segments: [[0.0, 0.3]], resolution: 0.05}
observations: toy_drive
trials: {every_m: 6.0, max_steps: 60}
localizer:
  matcher:
    ransam: {iterations: 500, contact_epsilon: 0.10}
evaluation: {max_translation_error: 0.5}
output: {steps: true, maps: first_trial}
)";

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const auto at = text.find(from);
  if (at == std::string::npos) ADD_FAILURE() << "'" << from << "' is not in the text";
  return text.replace(at, from.size(), to);
}

class ExperimentFile : public testing::Test {
 protected:
  ExperimentFile() {
    register_toys(catalog_);
    folder_.write("map.txt", "a map");
  }

  /// The faults as the user sees them, with the temporary folder left out.
  Lines faults_of(const std::string& text, const std::vector<Override>& overrides = {}) {
    return faults_of_file(folder_.write("e.yaml", text), overrides);
  }

  Lines faults_of_file(const std::filesystem::path& file, const std::vector<Override>& overrides = {}) {
    return config_faults(folder_.path(), [&] { return read_experiment(file, overrides, catalog_); });
  }

  /// With `to` in place of `from`, the valid file has these faults: "e.yaml:" and " error:" are added.
  void expect_refused(const std::string& from, const std::string& to, Lines faults) {
    for (std::string& fault : faults) fault = "e.yaml:" + fault.insert(fault.find(' '), " error:");
    EXPECT_THAT(faults_of(replaced(valid, from, to)), ElementsAreArray(faults)) << to;
  }

  Catalog catalog_;
  TemporaryFolder folder_;
};

TEST_F(ExperimentFile, ValidIsRead) {
  const Experiment e = read_experiment(folder_.write("e.yaml", valid), {}, catalog_);
  EXPECT_EQ(e.name, "toy");
  EXPECT_EQ(e.seed, 42U);
  EXPECT_EQ(e.threads, 2);
  EXPECT_DOUBLE_EQ(e.trials.every_m, 6.0);
  EXPECT_EQ(e.trials.max_steps, 60);
  EXPECT_EQ(e.output.maps, "first_trial");
  EXPECT_EQ(e.localizer.rater.name, "cluster_rating");
  const auto& matcher = dynamic_cast<const ParamsOf<ToyMatcher::Params>&>(*e.localizer.matcher.params).value;
  EXPECT_EQ(matcher.iterations, 500);
  EXPECT_DOUBLE_EQ(matcher.contact_epsilon, 0.1);
  const auto& map = dynamic_cast<const ParamsOf<ToyMap::Params>&>(*e.map.params).value;
  EXPECT_EQ(map.path.text, "map.txt");
  EXPECT_EQ(map.path.resolved, folder_.path() / "map.txt");
  ASSERT_EQ(map.segments.size(), 1U);
  EXPECT_DOUBLE_EQ(map.segments[0][1], 0.3);
}

/// Works with all motions.
struct Able final : Clusterer {
  using Params = Nothing;
  static constexpr Motions motions = all_motions;
  explicit Able(const Params& /*params*/) {}
  std::vector<Cluster> cluster(const std::vector<Hypothesis>& /*hypotheses*/, Rng& /*rng*/) override {
    return {};
  }
};

TEST_F(ExperimentFile, AStageThatCannotDoTheMotionIsNamedWhereItIsChosen) {
  catalog_.clusterers.add<Able>("able", "Groups nothing in space.");
  const std::string text =
      replaced(valid, "localizer:\n", "localizer:\n  motion: upright\n  rater: cluster_rating\n");
  const Lines faults = faults_of(text);
  EXPECT_THAT(faults, Contains("e.yaml:11:10: error: localizer: rater: the rater 'cluster_rating' can do the "
                               "motion planar, not upright; set localizer.motion to planar; no rater can do "
                               "upright"));
  EXPECT_THAT(faults, Contains(HasSubstr("the clusterer 'hierarchical_kmeans' can do the motion planar, not "
                                         "upright; set localizer.motion to planar, or take able")));
  EXPECT_THAT(faults, SizeIs(6));  // Nothing verifies here, and nothing can do any motion.
  EXPECT_THAT(
      faults_of(replaced(valid, "localizer:\n", "localizer:\n  motion: sideways\n")),
      ElementsAre("e.yaml:10:11: error: localizer: motion: 'sideways' is not one of planar, upright, free"));
}

TEST_F(ExperimentFile, APriorIsGivenAsAWholeOrNotAtAll) {
  const auto faults_with = [&](const std::string& prior) {
    return faults_of(replaced(valid, "localizer:\n", "localizer:\n  prior: " + prior + "\n"));
  };
  EXPECT_THAT(faults_with("{}"), ElementsAre());
  EXPECT_THAT(faults_with("{region: {x: 1, y: -2, radius: 0.5}, heading: {deg: -90, width_deg: 360}}"),
              ElementsAre());
  EXPECT_THAT(
      faults_with("{region: {x: 1, radius: 5}}"),
      ElementsAre("e.yaml:10:19: error: localizer.prior.region: x, y and radius must be given together"));
  EXPECT_THAT(
      faults_with("{heading: {width_deg: 5}}"),
      ElementsAre("e.yaml:10:20: error: localizer.prior.heading: deg and width_deg must be given together"));
  EXPECT_THAT(faults_with("{region: {x: 1, y: 2, radius: 0}}"),
              ElementsAre(HasSubstr("localizer.prior.region: radius: 0 is out of range, must be > 0")));
  EXPECT_THAT(faults_with("{heading: {deg: 0, width_deg: 361}}"),
              ElementsAre(HasSubstr("localizer.prior.heading: width_deg: 361 is out of range, must be")));
}

TEST_F(ExperimentFile, EachFaultHasItsPlaceAndRule) {
  // Keys.
  expect_refused("iterations: 500", "iteration: 500",
                 {"11:14: localizer.matcher.ransam: unknown key 'iteration' (did you mean 'iterations'?)"});
  expect_refused("iterations: 500", "temper: 2",
                 {"11:14: localizer.matcher.ransam: key 'temper' is called 'patience' now"});
  expect_refused(
      "iterations: 500", "luck: 2",
      {"11:14: localizer.matcher.ransam: key 'luck' was removed: there is none; raise iterations"});
  expect_refused("    ransam: {iterations: 500, contact_epsilon: 0.10}", "    ransack: {iterations: 500}",
                 {"11:5: localizer: matcher: the matcher 'ransack' is called 'ransam' now"});
  expect_refused("iterations: 500", "patience: soon",
                 {"11:24: localizer.matcher.ransam: patience: expected a number or auto, got 'soon'"});
  expect_refused("iterations: 500", "patience: 0",
                 {"11:24: localizer.matcher.ransam: patience: 0 is out of range, must be > 0 s"});
  expect_refused("seed: 42", "sede: 42", {"3:1: unknown key 'sede' (did you mean 'seed'?)"});
  expect_refused("steps: true", "colour: 1",
                 {"13:10: output: unknown key 'colour' (known keys: steps, trajectories, clusters, maps)"});
  expect_refused("iterations: 500", "iterations: 1, iterations: 2",
                 {"11:29: localizer.matcher.ransam: duplicate key 'iterations' (first in line 11)"});
  expect_refused("seed: 42", "name: twice", {"3:1: duplicate key 'name' (first in line 2)"});
  expect_refused("iterations: 500", "<<: {iterations: 5}",
                 {"11:14: localizer.matcher.ransam: merge keys (<<) are not supported; write the keys out"});
  expect_refused("{steps: true,", "{[1, 2]: true,", {"13:10: output: a key must be a word, not a list"});
  expect_refused(
      "name: toy\n", "",
      {"1:1: missing key 'name': What the experiment is called; results go to a folder of this name."});
  expect_refused("path: map.txt, ", "", {"6:12: map.toy_map: missing key 'path': The map's file."});
  expect_refused("toy_map: {path: map.txt, segments: [[0.0, 0.3]], resolution: 0.05}",
                 "toy_map:", {"6:3: map.toy_map: missing key 'path': The map's file."});
  // Types.
  expect_refused("seed: 42", "seed: [42]", {"3:7: seed: expected a whole number, got a list"});
  expect_refused("seed: 42", "seed: {a: 1}", {"3:7: seed: expected a whole number, got a map"});
  expect_refused("seed: 42", "seed:", {"3:1: seed: expected a whole number, got nothing"});
  expect_refused("seed: 42", "seed: many", {"3:7: seed: expected a whole number, got 'many'"});
  expect_refused("seed: 42", "seed: \"42\"",
                 {"3:7: seed: expected a whole number, got the text '42' (remove the quotes)"});
  expect_refused("every_m: 6.0", "every_m: far", {"8:19: trials: every_m: expected a number, got 'far'"});
  expect_refused("name: toy", "name: [toy]", {"2:7: name: expected text, got a list"});
  expect_refused("steps: true", "steps: yes", {"13:17: output: steps: expected true or false, got 'yes'"});
  expect_refused("steps: true", "steps: 'true'",
                 {"13:17: output: steps: expected true or false, got the text 'true'"});
  expect_refused("trials: {every_m: 6.0, max_steps: 60}", "trials: 6",
                 {"8:9: trials: expected a map (key: value), got '6'"});
  expect_refused("path: map.txt", "path: [map.txt]",
                 {"6:19: map.toy_map: path: expected a path, got a list"});
  expect_refused("segments: [[0.0, 0.3]]", "segments: 0.3",
                 {"6:38: map.toy_map: segments: expected a list, got '0.3'"});
  expect_refused("segments: [[0.0, 0.3]]", "walls: [3]",
                 {"6:36: map.toy_map.walls[0]: expected a map (key: value), got '3'"});
  // Whole numbers.
  expect_refused("seed: 42", "seed: 042", {"3:7: seed: 042 has a leading zero; write 42"});
  expect_refused("seed: 42", "seed: 000", {"3:7: seed: 000 has a leading zero; write 0"});
  expect_refused("seed: 42", "seed: 0x2A",
                 {"3:7: seed: 0x2A is not a decimal number; write it with the digits 0 to 9"});
  expect_refused("seed: 42", "seed: 0o52",
                 {"3:7: seed: 0o52 is not a decimal number; write it with the digits 0 to 9"});
  expect_refused("seed: 42", "seed: 4.2",
                 {"3:7: seed: 4.2 is not a whole number; write it without point and exponent"});
  expect_refused("threads: 2", "threads: 1e1",
                 {"4:10: threads: 1e1 is not a whole number; write it without point and exponent"});
  expect_refused("seed: 42", "seed: 1_000", {"3:7: seed: expected a whole number, got '1_000'"});
  expect_refused("seed: 42", "seed: -1", {"3:7: seed: -1 is out of range, must be >= 0"});
  expect_refused("seed: 42", "seed: 18446744073709551616",
                 {"3:7: seed: 18446744073709551616 is too large, must be <= 18446744073709551615"});
  expect_refused("max_steps: 60", "max_steps: 2147483648",
                 {"8:35: trials: max_steps: 2147483648 is too large, must be <= 2147483647"});
  expect_refused("max_steps: 60", "max_steps: -2147483649",
                 {"8:35: trials: max_steps: -2147483649 is too small, must be >= -2147483648"});
  // Ranges.
  expect_refused("contact_epsilon: 0.10", "contact_epsilon: 0",
                 {"11:48: localizer.matcher.ransam: contact_epsilon: 0 is out of range, must be > 0 m"});
  expect_refused("threads: 2", "threads: 0", {"4:10: threads: 0 is out of range, must be >= 1 and <= 256"});
  expect_refused("threads: 2", "threads: 257",
                 {"4:10: threads: 257 is out of range, must be >= 1 and <= 256"});
  expect_refused("schema: 1", "schema: 2", {"1:9: schema: 2 is out of range, must be 1"});
  expect_refused("0.3]]", "1.5]]",
                 {"6:45: map.toy_map: segments[0][1]: 1.5 is out of range, must be >= 0 and <= 1"});
  expect_refused("0.05", ".nan", {"6:64: map.toy_map: resolution: .nan is not a finite number"});
  expect_refused("0.05", "nan", {"6:64: map.toy_map: resolution: nan is not a finite number"});
  expect_refused("0.05", "-.inf", {"6:64: map.toy_map: resolution: -.inf is not a finite number"});
  expect_refused("0.05", "Infinity", {"6:64: map.toy_map: resolution: Infinity is not a finite number"});
  expect_refused("0.05", "1e999",
                 {"6:64: map.toy_map: resolution: 1e999 is too large or too small for a number (64-bit "
                  "floating point)"});
  expect_refused("0.05", "00.05", {"6:64: map.toy_map: resolution: 00.05 has a leading zero; write 0.05"});
  expect_refused("0.05", "0,05",
                 {"6:64: map.toy_map: resolution: 0 is out of range, must be > 0 m",
                  "6:66: map.toy_map: unknown key '05' (known keys: path, segments, resolution, walls)"});
  // Lists.
  expect_refused("[[0.0, 0.3]]", "[]", {"6:38: map.toy_map: segments: expected at least 1 item, got 0"});
  expect_refused("[[0.0, 0.3]]", "[[0.0]]",
                 {"6:39: map.toy_map: segments[0]: expected a pair of numbers [a, b], got 1 item"});
  expect_refused("[[0.0, 0.3]]", "[0.0, 0.3]",
                 {"6:39: map.toy_map: segments[0]: expected a pair of numbers [a, b], got '0.0'",
                  "6:44: map.toy_map: segments[1]: expected a pair of numbers [a, b], got '0.3'"});
  expect_refused("segments: [[0.0, 0.3]]", "walls: [{from: [1, 2, 3]}]",
                 {"6:43: map.toy_map.walls[0]: from: expected 2 items, got 3"});
  expect_refused("segments: [[0.0, 0.3]]", "walls: [{}, {}, {}, {}]",
                 {"6:35: map.toy_map: walls: expected at most 3 items, got 4"});
  // Choices and rules.
  expect_refused(
      "first_trial", "first",
      {"13:29: output: maps: 'first' is not one of none, first_trial, all (did you mean 'first_trial'?)"});
  expect_refused("first_trial", "first_trail",
                 {"13:29: output: maps: 'first_trail' is not one of none, first_trial, all (did you mean "
                  "'first_trial'?)"});
  expect_refused("name: toy", "name: a/b",
                 {"2:7: name: must be usable as a folder name: at most 100 letters, digits, '_', '-' and "
                  "'.', beginning with a letter, a digit or '_'"});
  expect_refused("every_m: 6.0, ", "",
                 {"8:9: trials: exactly one of every_m, starts_m, every_scan and whole must be given"});
  expect_refused("every_m: 6.0", "every_m: 6.0, whole: true",
                 {"8:9: trials: exactly one of every_m, starts_m, every_scan and whole must be given"});
  expect_refused("observations: toy_drive", "observations: {toy_drive: {max_range: 1, min_range: 2}}",
                 {"7:53: observations.toy_drive: min_range: must be less than max_range"});
  expect_refused("observations: toy_drive", "observations: {toy_drive: {max_range: 0.05}}",
                 {"7:27: observations.toy_drive: min_range: must be less than max_range"});
  expect_refused("observations: toy_drive", "observations: {toy_drive: {max_range: x, min_range: 50}}",
                 {"7:39: observations.toy_drive: max_range: expected a number, got 'x'"});
  expect_refused("observations: toy_drive", "observations: {toy_drive: {noise: {beams: 9}}}",
                 {"7:43: observations.toy_drive.noise: beams: 9 is out of range, must be >= 1 and <= 8"});
  // Strategies.
  expect_refused("    ransam:", "    ransac:",
                 {"11:5: localizer: matcher: unknown matcher 'ransac', did you mean 'ransam'? (there are: "
                  "indexed, ransam); 'ransac' is a method: --method ransac"});
  expect_refused("observations: toy_drive", "observations: carmen",
                 {"7:15: observations: unknown observation_source 'carmen' (there are: toy_drive)"});
  expect_refused("observations: toy_drive", "observations:",
                 {"7:1: observations: expected one observation_source, its name or `name: {parameters}`, got "
                  "nothing (there are: toy_drive)"});
  expect_refused("    ransam: {iterations: 500, contact_epsilon: 0.10}",
                 "    iterations: 500\n    contact_epsilon: 0.1",
                 {"11:5: localizer: matcher: expected one matcher, its name or `name: {parameters}`, got a "
                  "map with 2 keys (there are: indexed, ransam)"});
  expect_refused("ransam: {iterations: 500, contact_epsilon: 0.10}", "ransam: 500",
                 {"11:13: localizer.matcher.ransam: expected a map (key: value), got '500'"});
  expect_refused("ransam: {iterations: 500, contact_epsilon: 0.10}", "indexed: {iterations: 5}",
                 {"11:15: localizer.matcher.indexed: unknown key 'iterations' (there are no parameters)"});
  // Files.
  expect_refused("map.txt", "nowhere.txt", {"6:19: map.toy_map: path: no such file: nowhere.txt"});
  expect_refused("path: map.txt", "path: ''",
                 {"6:19: map.toy_map: path: expected a path, got an empty text"});
  expect_refused("seed: 42", "plugins: [map.txt, a.so]", {"3:20: plugins[1]: no such file: a.so"});
  // YAML.
  expect_refused("seed: 42", "seed: &s 42",
                 {"3:7: seed: anchors are not supported; write the value out where it is needed"});
  expect_refused("seed: 42\nthreads: 2", "seed: &s 42\nthreads: *s",
                 {"3:7: seed: anchors are not supported; write the value out where it is needed",
                  "4:10: threads: aliases are not supported; write the value out"});
  expect_refused("seed: 42", "seed: !!int 42",
                 {"3:7: seed: tags are not supported; remove 'tag:yaml.org,2002:int'"});
  expect_refused(
      "seed: 42", "---\nseed: 42",
      {"3:1: only one document is allowed, and another begins here (by '---', or by wrong indentation?)"});
  expect_refused("threads: 2", "\tthreads: 2",
                 {"4:1: not valid YAML: illegal tab when looking for indentation (indent with spaces)"});
  expect_refused("trials: {", "trials:\n\tmax_steps: 3\nx: {",
                 {"9:11: not valid YAML: illegal map value (a tab is no indentation; indent with spaces)"});
  expect_refused("[[0.0, 0.3]]", "[[0.0, 0.3]",
                 {"6:67: not valid YAML: illegal flow end (brackets do not match)"});
  expect_refused("name: toy", "name: \"toy",
                 {"2:7: not valid YAML: the quote that begins here is not closed"});
  expect_refused("name: toy", "name: 'toy''",
                 {"2:7: not valid YAML: the quote that begins here is not closed"});
  expect_refused("name: toy", "name: ! toy", {"2:7: name: tags are not supported; remove '!'"});
  expect_refused(
      "name: toy", " name: toy",
      {"2:6: not valid YAML: illegal map value (check the indentation, and quote text that has ': ' in it)"});
}

TEST_F(ExperimentFile, AllFaultsAreReportedInOneRunSortedByPlace) {
  std::string text = replaced(valid, "threads: 2", "threads: 0");
  text = replaced(text, "seed: 42", "seed: x");
  text = replaced(text, "steps: true", "step: true");
  text = replaced(text, "iterations: 500", "iterations: 0, iterations: 1");
  EXPECT_THAT(
      faults_of(text, {{"map.toy_map.resolution", "-1"}}),
      ElementsAre(
          "--set map.toy_map.resolution=-1: error: map.toy_map: resolution: -1 is out of range, must be > 0 "
          "m",
          "e.yaml:3:7: error: seed: expected a whole number, got 'x'",
          "e.yaml:4:10: error: threads: 0 is out of range, must be >= 1 and <= 256",
          "e.yaml:11:26: error: localizer.matcher.ransam: iterations: 0 is out of range, must be >= 1",
          "e.yaml:11:29: error: localizer.matcher.ransam: duplicate key 'iterations' (first in line 11)",
          "e.yaml:13:10: error: output: unknown key 'step' (did you mean 'steps'?)"));
}

TEST_F(ExperimentFile, FilesThatAreNoConfiguration) {
  EXPECT_THAT(faults_of(""), ElementsAre("e.yaml: error: the file is empty"));
  EXPECT_THAT(faults_of("# nothing\n"), ElementsAre("e.yaml: error: the file is empty"));
  EXPECT_THAT(faults_of("---\n"), ElementsAre("e.yaml: error: the file is empty"));
  EXPECT_THAT(faults_of("just words"),
              ElementsAre("e.yaml:1:1: error: expected a map (key: value), got 'just words'"));
  EXPECT_THAT(faults_of("- a\n- b\n"),
              ElementsAre("e.yaml:1:1: error: expected a map (key: value), got a list"));
  EXPECT_THAT(faults_of("name: a\nsee\xff"), ElementsAre("e.yaml:2:4: error: the file is not UTF-8 text"));
  EXPECT_THAT(faults_of(std::string("name:\0 a", 8)),
              ElementsAre("e.yaml:1:6: error: the file has a control character (a binary file?)"));
  EXPECT_THAT(faults_of(std::string((1U << 20U) + 1, ' ')),
              ElementsAre("e.yaml: error: is larger than 1 MiB: not a configuration file"));
  EXPECT_THAT(faults_of_file(folder_.path() / "missing.yaml"),
              ElementsAre("missing.yaml: error: no such file: missing.yaml"));
  std::filesystem::create_directory(folder_.path() / "folder");
  EXPECT_THAT(faults_of_file(folder_.path() / "folder"),
              ElementsAre("folder: error: is a folder, not a file: folder"));
}

TEST_F(ExperimentFile, NestingIsLimited) {
  const std::string deep = "a: " + std::string(500000, '[');
  EXPECT_THAT(faults_of(deep), testing::SizeIs(1));
  const std::string just_too_deep = "a: " + std::string(32, '[') + std::string(32, ']');
  EXPECT_THAT(faults_of(just_too_deep), ElementsAre(testing::EndsWith("nested deeper than 32 levels")));
}

TEST_F(ExperimentFile, DataFolderMustBeKnown) {
  const std::string text = replaced(valid, "map.txt", "data:map.txt");
  unsetenv("GLOCAL_DATASETS");
  EXPECT_THAT(
      faults_of(text),
      ElementsAre("e.yaml:6:19: error: map.toy_map: path: 'data:map.txt' needs the environment variable "
                  "GLOCAL_DATASETS, which is not set; set it to the folder of the data sets"));
  setenv("GLOCAL_DATASETS", folder_.path().c_str(), 1);
  EXPECT_THAT(faults_of(text), ElementsAre());
  EXPECT_THAT(faults_of(replaced(valid, "map.txt", "data:/map.txt")),
              ElementsAre("e.yaml:6:19: error: map.toy_map: path: expected a relative path after 'data:', "
                          "got 'data:/map.txt'"));
  EXPECT_THAT(faults_of(replaced(valid, "map.txt", "data:a/b.txt")),
              ElementsAre("e.yaml:6:19: error: map.toy_map: path: no such file: a/b.txt"));
  unsetenv("GLOCAL_DATASETS");
}

TEST_F(ExperimentFile, DefaultThatIsNotRegisteredMustBeReplaced) {
  Catalog poor;
  poor.map_sources.add<ToyMap>("toy_map", "A map.");
  poor.observation_sources.add<ToyDrive>("toy_drive", "A drive.");
  poor.matchers.add<ToyMatcher>("other", "Matches.");
  const auto file = folder_.write(
      "e.yaml",
      replaced(valid, "localizer:\n  matcher:\n    ransam: {iterations: 500, contact_epsilon: 0.10}\n", ""));
  const Lines faults = config_faults(folder_.path(), [&] { return read_experiment(file, {}, poor); });
  ASSERT_THAT(faults, SizeIs(7));
  EXPECT_EQ(faults[2],
            "e.yaml:1:1: error: localizer: matcher: the default matcher 'ransam' does not exist; name "
            "another (there are: other)");
}

}  // namespace
}  // namespace glocal::test::bad_experiment_test
