// Variants of an experiment: names and values by hand, and every fault at the change that makes it.
#include "config/variants.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"
#include "framework/config/toy_catalog.hpp"
#include "glocal/experiment.hpp"

namespace glocal::test::variants_test {
namespace {

using testing::ElementsAre;

class VariantsTest : public testing::Test {
 protected:
  VariantsTest() {
    register_toys(catalog_);
    folder_.write("map.txt", "a map");
  }

  /// The variants begin in line 7 of the file.
  std::vector<Variant> read(const std::string& variants, const std::vector<Override>& overrides = {}) {
    const std::string text =
        "schema: 1\n"
        "name: toy\n"
        "map: {toy_map: {path: map.txt}}\n"
        "observations: toy_drive\n"
        "trials: {every_m: 6}\n"
        "localizer: {matcher: {ransam: {iterations: 7}}}\n" +
        variants;
    return read_variants(folder_.write("e.yaml", text), overrides, catalog_);
  }

  std::vector<std::string> faults_of(const std::string& variants,
                                     const std::vector<Override>& overrides = {}) {
    return config_faults(folder_.path(), [&] { return read(variants, overrides); });
  }

  static std::vector<std::string> names(const std::vector<Variant>& variants) {
    std::vector<std::string> names;
    for (const Variant& variant : variants) names.push_back(variant.name);
    return names;
  }

  static const ToyMatcher::Params& matcher(const Variant& variant) {
    return dynamic_cast<const ParamsOf<ToyMatcher::Params>&>(*variant.experiment.localizer.matcher.params)
        .value;
  }

  Catalog catalog_;
  TemporaryFolder folder_;
};

TEST_F(VariantsTest, WithoutAnyThereIsTheExperimentItself) {
  for (const char* variants : {"", "variants:\n", "variants: {}\n", "variants: {list: {}, grid: }\n"}) {
    const auto all = read(variants);
    ASSERT_EQ(names(all), std::vector<std::string>{""}) << variants;
    EXPECT_EQ(matcher(all[0]).iterations, 7) << variants;
  }
}

TEST_F(VariantsTest, AListChangesWhatItNames) {
  const auto all = read(
      "variants:\n"
      "  list:\n"
      "    base: {}\n"
      "    other: {localizer.matcher: indexed, seed: 5}\n"
      "    fewer: {localizer.matcher.ransam.iterations: 3, localizer.matcher.ransam.contact_epsilon: 0.2}\n");
  EXPECT_THAT(names(all), ElementsAre("base", "other", "fewer"));
  EXPECT_EQ(matcher(all[0]).iterations, 7);
  EXPECT_EQ(all[1].experiment.localizer.matcher.name, "indexed");
  EXPECT_EQ(all[1].experiment.seed, 5U);
  EXPECT_EQ(matcher(all[2]).iterations, 3);
  EXPECT_DOUBLE_EQ(matcher(all[2]).contact_epsilon, 0.2);
  EXPECT_FALSE(all[0].changes_trials);
  EXPECT_TRUE(all[1].changes_trials);
  EXPECT_FALSE(all[2].changes_trials);
  for (const Variant& variant : all) EXPECT_EQ(variant.experiment.name, "toy");
}

TEST_F(VariantsTest, AGridHasEveryCombinationTheLastKeyFastest) {
  const auto all = read(
      "variants:\n"
      "  grid:\n"
      "    localizer.matcher.ransam.iterations: [50, 200]\n"
      "    localizer.matcher.ransam.contact_epsilon: [0.05, 0.1, 0.2]\n");
  EXPECT_THAT(names(all),
              ElementsAre("iterations-50_contact_epsilon-0.05", "iterations-50_contact_epsilon-0.1",
                          "iterations-50_contact_epsilon-0.2", "iterations-200_contact_epsilon-0.05",
                          "iterations-200_contact_epsilon-0.1", "iterations-200_contact_epsilon-0.2"));
  EXPECT_EQ(matcher(all[2]).iterations, 50);
  EXPECT_DOUBLE_EQ(matcher(all[2]).contact_epsilon, 0.2);
  EXPECT_EQ(matcher(all[3]).iterations, 200);
  EXPECT_DOUBLE_EQ(matcher(all[3]).contact_epsilon, 0.05);
}

TEST_F(VariantsTest, ZipTakesValuesSideBySide) {
  const auto all = read(
      "variants:\n"
      "  zip:\n"
      "    localizer.matcher.ransam.iterations: [50, 200]\n"
      "    seed: [3, 4]\n");
  EXPECT_THAT(names(all), ElementsAre("iterations-50_seed-3", "iterations-200_seed-4"));
  EXPECT_EQ(matcher(all[1]).iterations, 200);
  EXPECT_EQ(all[1].experiment.seed, 4U);
}

TEST_F(VariantsTest, ListGridAndZipStandTogether) {
  EXPECT_THAT(names(read("variants: {zip: {seed: [8]}, grid: {seed: [9]}, list: {mine: {seed: 7}}}\n")),
              ElementsAre("mine", "seed-9", "seed-8"));
}

TEST_F(VariantsTest, NamesAreShortAndFitForAFolder) {
  EXPECT_THAT(names(read("variants:\n"
                         "  grid:\n"
                         "    seed: [1]\n"
                         "    observations.toy_drive.mode: [slow]\n"
                         "    observations.toy_drive.label: ['a/b c']\n"
                         "    map.toy_map.segments: [[[0, 0.5]]]\n"
                         "    localizer.matcher: [{ransam: {iterations: 5}}]\n")),
              ElementsAre("seed-1_mode-slow_label-a-b-c_segments-0-0.5_matcher-ransam-iterations-5"));
  // The same last part twice: as much of the path as tells them apart.
  EXPECT_THAT(names(read("variants: {grid: {observations.toy_drive.noise.range: [0.5], "
                         "observations.toy_drive.noise.beams: [2]}}\n")),
              ElementsAre("range-0.5_beams-2"));
  EXPECT_THAT(faults_of("variants: {grid: {a.b.x: [1], c.b.x: [2]}}\n"),
              ElementsAre(testing::HasSubstr("unknown key 'a'"), testing::HasSubstr("unknown key 'c'")));
}

TEST_F(VariantsTest, OverridesComeBeforeTheChanges) {
  const std::vector<Override> overrides = {{"localizer.matcher.ransam.iterations", "9"},
                                           {"localizer.matcher.ransam.contact_epsilon", "0.3"}};
  const auto all =
      read("variants: {list: {a: {}, b: {localizer.matcher.ransam.iterations: 3}}}\n", overrides);
  EXPECT_EQ(matcher(all[0]).iterations, 9);
  EXPECT_EQ(matcher(all[1]).iterations, 3);
  EXPECT_DOUBLE_EQ(matcher(all[1]).contact_epsilon, 0.3);
  EXPECT_THAT(names(read("variants: {list: {a: {}}}\n", {{"variants", "{}"}})), ElementsAre(""));
}

TEST_F(VariantsTest, AllFaultsOfAllVariantsAreSaidAtTheirChange) {
  EXPECT_THAT(
      faults_of("variants:\n"
                "  list:\n"
                "    a: {localizer.matcher.ransam.iterations: 0}\n"
                "    b: {localizer.matcher.ransam.iteration: 5, localizer.rate: x}\n"
                "    c: {trials.whole: true}\n"
                "    d: {observations.toy_drive.max_range: 0.05}\n"
                "    e: {name.first: 1, seed..x: 1}\n"),
      ElementsAre(
          "e.yaml:9:46: error: localizer.matcher.ransam: iterations: 0 is out of range, must be >= 1",
          "e.yaml:10:9: error: localizer.matcher.ransam: unknown key 'iteration' (did you mean "
          "'iterations'?)",
          "e.yaml:10:48: error: localizer: unknown key 'rate' (did you mean 'rater'?)",
          "e.yaml:11:9: error: with this change, trials: exactly one of every_m, starts_m, every_scan and "
          "whole must be given",
          "e.yaml:12:9: error: observations.toy_drive: min_range: must be less than max_range",
          "e.yaml:13:9: error: cannot set 'first': 'name' is not a map but 'toy'",
          "e.yaml:13:9: error: variants: 'name' is the same for all variants and cannot be changed",
          "e.yaml:13:24: error: the path has an empty part; write it as a.b.c"));
}

TEST_F(VariantsTest, APointsFaultIsSaidOnceHoweverManyPointsHaveIt) {
  EXPECT_THAT(
      faults_of("variants:\n"
                "  grid:\n"
                "    localizer.matcher.ransam.iterations: [0, 5, 6]\n"
                "    localizer.matcher.ransam.contact_epsilon: [0.1, 0.2]\n"
                "    trials.whole: [true]\n"),
      ElementsAre(
          "e.yaml:9:43: error: localizer.matcher.ransam: iterations: 0 is out of range, must be >= 1",
          "e.yaml:11:5: error: with this change, trials: exactly one of every_m, starts_m, every_scan "
          "and whole must be given"));
}

TEST_F(VariantsTest, FaultsOfTheExperimentItselfAreSaidOnce) {
  EXPECT_THAT(faults_of("sede: 1\nvariants: {list: {a: {}, b: {seed: -1}}}\n"),
              ElementsAre("e.yaml:7:1: error: unknown key 'sede' (did you mean 'seed'?)",
                          "e.yaml:8:36: error: seed: -1 is out of range, must be >= 0"));
  EXPECT_THAT(faults_of("variants: {list: {a: {}}}\n", {{"seed", "-1"}}),
              ElementsAre("--set seed=-1: error: seed: -1 is out of range, must be >= 0"));
}

TEST_F(VariantsTest, RefusesWhatHasTheWrongShape) {
  EXPECT_THAT(
      faults_of("variants: {list: [a], grid: {seed: 1}, zip: {seed: []}, lists: {}}\n"),
      ElementsAre("e.yaml:7:18: error: variants: list: expected a map (name: {path: value}), got a list",
                  "e.yaml:7:36: error: variants: grid.seed: expected a list of values, got '1'",
                  "e.yaml:7:52: error: variants: zip.seed: expected at least 1 item, got 0",
                  "e.yaml:7:57: error: variants: unknown key 'lists' (did you mean 'list'?)"));
  EXPECT_THAT(faults_of("variants: {list: {a: 5}}\n"),
              ElementsAre("e.yaml:7:22: error: variants: list.a: expected a map (path: value), got '5'"));
}

TEST_F(VariantsTest, RefusesUnevenListsTwoOfANameAndTooMany) {
  EXPECT_THAT(faults_of("variants:\n"
                        "  zip:\n"
                        "    seed: [1, 2]\n"
                        "    threads: [1, 2, 3]\n"),
              ElementsAre("e.yaml:10:14: error: variants.zip: 3 values for 'threads', but 2 for 'seed'; give "
                          "equally many"));
  EXPECT_THAT(faults_of("variants:\n"
                        "  list: {seed-2: {}, a/b: {}}\n"
                        "  grid: {seed: [1, 2, 1]}\n"),
              ElementsAre(testing::HasSubstr("e.yaml:8:22: error: variants: 'a/b' is no name for a folder"),
                          "e.yaml:9:20: error: variants: 'seed-2' is there twice (first in line 8)",
                          "e.yaml:9:23: error: variants: 'seed-1' is there twice (first in line 9)"));
  std::string hundred = "[0";
  for (int i = 1; i <= 100; ++i) hundred += ", " + std::to_string(i);
  EXPECT_THAT(faults_of("variants:\n  grid:\n    seed: " + hundred + "]\n    threads: " + hundred + "]\n"),
              ElementsAre("e.yaml:9:5: error: variants.grid: has more than 10000 combinations; leave some "
                          "values out"));
}

TEST_F(VariantsTest, FaultsOfTheExperimentAreSaidOnceAtTheirPlace) {
  const auto unknown =
      ElementsAre(testing::StartsWith("e.yaml:7:1: error: unknown key 'typo' (known keys: schema, "));
  for (const char* changes : {"{}", "{a: {}}", "{a: {seed: 3}}", "{a: {}, b: {localizer.matcher: indexed}}"})
    EXPECT_THAT(faults_of("typo: 1\nvariants: {list: " + std::string(changes) + "}\n"), unknown) << changes;
  EXPECT_THAT(faults_of("typo: 1\nvariants: {grid: {seed: [1, 2]}, zip: {threads: [3]}}\n"), unknown);
}

/// "0, 1, 2, …", each between `before` and `after`.
std::string count_to(int n, const std::string& before, const std::string& after) {
  std::string text;
  for (int i = 0; i < n; ++i) {
    if (i > 0) text += ", ";
    text.append(before).append(std::to_string(i)).append(after);
  }
  return text;
}

TEST_F(VariantsTest, MoreThanTenThousandOfAnyKindAreRefusedAtOnce) {
  using testing::HasSubstr;
  EXPECT_THAT(faults_of("variants: {list: {" + count_to(40000, "v", ": {}") + "}}\n"),
              ElementsAre(HasSubstr("variants.list: has 40000 variants, at most 10000 are allowed")));
  EXPECT_THAT(faults_of("variants: {zip: {seed: [" + count_to(100000, "", "") + "]}}\n"),
              ElementsAre(HasSubstr("variants.zip: has more than 10000 rows; leave some values out")));
  EXPECT_THAT(faults_of("variants: {grid: {" + count_to(50000, "a.b", ": [1]") + "}}\n"),
              ElementsAre(HasSubstr("variants: 50000 paths at once, at most 1000 are allowed")));
  EXPECT_THAT(faults_of("variants: {grid: {" + count_to(900, "a.b", ": [1]") + ", seed: [" +
                        count_to(5000, "", "") + "]}}\n"),
              ElementsAre(HasSubstr("variants.grid: changes 4505000 values in all; leave some values out")));
}

TEST_F(VariantsTest, WhatTakesTooMuchMemoryIsRefused) {
  const std::string long_list = "[[" + count_to(30000, "", "") + "]]";
  EXPECT_THAT(faults_of("variants: {grid: {trials.starts_m: " + long_list + ", trials.every_m: [0], seed: [" +
                        count_to(1000, "", "") + "]}}\n"),
              testing::Contains(testing::HasSubstr("have more than 20 million values together")));
  EXPECT_THAT(faults_of("variants: {grid: {" + std::string(1010, 'a') + ": [1, 2]}}\n"),
              ElementsAre(testing::HasSubstr("a path of 1010 letters is none")));
}

std::vector<std::uint64_t> seeds(const std::vector<Variant>& variants) {
  std::vector<std::uint64_t> all;
  for (const Variant& variant : variants) all.push_back(variant.experiment.seed);
  return all;
}

TEST_F(VariantsTest, SeedsAreRunFastest) {
  const auto all = read(
      "seed: 77\n"
      "seeds: [3, 8..9]\n"
      "variants: {list: {a: {}, b: {localizer.matcher.ransam.iterations: 3}}}\n");
  EXPECT_THAT(names(all),
              ElementsAre("a_seed-3", "a_seed-8", "a_seed-9", "b_seed-3", "b_seed-8", "b_seed-9"));
  EXPECT_THAT(seeds(all), ElementsAre(3, 8, 9, 3, 8, 9));
  EXPECT_EQ(matcher(all[2]).iterations, 7);
  EXPECT_EQ(matcher(all[3]).iterations, 3);
  for (const Variant& variant : all) EXPECT_FALSE(variant.changes_trials);
  EXPECT_EQ(all[4].setting, "b");
  EXPECT_EQ(all[4].case_name, "");
  EXPECT_EQ(all[4].role, CaseRole::none);
}

TEST_F(VariantsTest, SeedsAloneMakeVariants) {
  EXPECT_THAT(names(read("seeds: 1..3\n")), ElementsAre("seed-1", "seed-2", "seed-3"));
  EXPECT_THAT(names(read("seeds: 5\n")), ElementsAre("seed-5"));
  EXPECT_THAT(seeds(read("seeds: 18446744073709551614..18446744073709551615\n")),
              ElementsAre(18446744073709551614ULL, 18446744073709551615ULL));
  EXPECT_THAT(names(read("", {{"seeds", "[2, 4]"}})), ElementsAre("seed-2", "seed-4"));
  for (const char* none : {"seeds:\n", "seeds: []\n"})
    EXPECT_THAT(names(read(none)), ElementsAre("")) << none;
  EXPECT_EQ(read("seeds: 1..10000\n").size(), 10000U);
}

TEST_F(VariantsTest, SeedsAreSaidOnceAndInOnePlace) {
  EXPECT_THAT(
      faults_of("seeds: 1..3\n", {{"seed", "5"}}),
      ElementsAre("--set seed=5: error: seed: the experiment has `seeds`; leave one out (--set seeds=[] "
                  "leaves out those of the file)"));
  EXPECT_THAT(names(read("seeds: 1..3\n", {{"seeds", "[]"}, {"seed", "5"}})), ElementsAre(""));
  EXPECT_THAT(faults_of("seeds: 1..3\n"
                        "variants: {list: {a: {seed: 4}}, grid: {seed: [5, 6]}}\n"),
              ElementsAre("e.yaml:8:23: error: seed: is changed here, and `seeds` is given; leave one out"));
}

TEST_F(VariantsTest, BadSeedsAreRefusedAtTheirPlace) {
  EXPECT_THAT(
      faults_of("seeds: [5..1, 1.., ..2, -1, -3..5, two, '7', 1.5, 4, 3..4, {}, 1..2..3]\n"),
      ElementsAre(
          "e.yaml:7:9: error: seeds: 5..1 runs backwards; write 1..5",
          "e.yaml:7:15: error: seeds: '1..' is no range such as 1..30: one end is missing",
          "e.yaml:7:20: error: seeds: '..2' is no range such as 1..30: one end is missing",
          "e.yaml:7:25: error: seeds: -1 is out of range, must be >= 0; a range is written as 1..30",
          "e.yaml:7:29: error: seeds: '-3..5' is no range such as 1..30: -3 is out of range, must be >= 0",
          "e.yaml:7:36: error: seeds: expected a whole number, got 'two'; a range is written as 1..30",
          "e.yaml:7:41: error: seeds: expected a whole number, got the text '7' (remove the quotes); a "
          "range is written as 1..30",
          "e.yaml:7:46: error: seeds: 1.5 is not a whole number; write it without point and exponent; a "
          "range is written as 1..30",
          "e.yaml:7:54: error: seeds: 4 is there twice; give each once",
          "e.yaml:7:60: error: seeds: expected a whole number, got a map; a range is written as 1..30",
          "e.yaml:7:64: error: seeds: '1..2..3' is no range such as 1..30: expected a whole number, got "
          "'2..3'"));
  EXPECT_THAT(faults_of("seeds: 0..18446744073709551615\n"),
              ElementsAre("e.yaml:7:8: error: seeds: more than 10000 seeds; leave some out"));
  EXPECT_THAT(faults_of("seeds: 1..101\nvariants: {grid: {localizer.matcher.ransam.iterations: [" +
                        count_to(100, "1", "") + "]}}\n"),
              ElementsAre("e.yaml:8:57: error: variants: 100 settings and 101 seeds make 10100 "
                          "variants, at most 10000 are allowed; leave some out"));
}

TEST_F(VariantsTest, ValuesAreToldAsTheyCouldBeSet) {
  const auto all = read(
      "variants:\n"
      "  list:\n"
      "    a: {localizer.matcher: {ransam: {iterations: 5}}, trials.starts_m: [1.0, 2e1], trials.every_m: "
      "0}\n"
      "    b: {observations.toy_drive.label: 'a, b', observations.toy_drive.loop: true}\n");
  EXPECT_THAT(all[0].values,
              ElementsAre(Override("localizer.matcher", "{ransam: {iterations: 5}}"),
                          Override("trials.starts_m", "[1.0, 2e1]"), Override("trials.every_m", "0")));
  EXPECT_THAT(all[1].values, ElementsAre(Override("observations.toy_drive.label", "\"a, b\""),
                                         Override("observations.toy_drive.loop", "true")));
  for (const Variant& variant : all) {
    auto set = read("", variant.values);
    Experiment experiment = variant.experiment;
    EXPECT_EQ(effective_yaml(set.at(0).experiment, catalog_), effective_yaml(experiment, catalog_));
  }
}

TEST_F(VariantsTest, NamesWithSeedsFitFolders) {
  const std::string ninety(90, 'x');
  EXPECT_THAT(faults_of("seeds: [10000]\nvariants: {list: {" + ninety + ": {}}}\n"),
              ElementsAre(testing::HasSubstr("_seed-10000' is too long for a folder's name")));
}

TEST_F(VariantsTest, TheEffectiveExperimentHasNone) {
  auto all = read("variants: {list: {a: {}}}\nseeds: 3\nchoose_on: {b: {}}\n");
  const std::string written = effective_yaml(all[0].experiment, catalog_);
  for (const char* key : {"variants", "seeds", "choose_on"}) EXPECT_EQ(written.find(key), std::string::npos);
  EXPECT_THAT(names(read_variants(folder_.write("effective.yaml", written), {}, catalog_)), ElementsAre(""));
}

}  // namespace
}  // namespace glocal::test::variants_test
