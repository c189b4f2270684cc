// Experiments as products: which variants methods and cases make, and every fault where it stands.
#include "config/products.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "files.hpp"
#include "framework/config/toy_catalog.hpp"
#include "glocal/error.hpp"
#include "glocal/experiment.hpp"

namespace glocal::test::products_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

const char* const fast_method = "localizer: {matcher: {ransam: {iterations: 7}}}\n";
const char* const room_case =
    "map: {toy_map: {path: map.txt}}\nobservations: toy_drive\ntrials: {every_m: 6}\n";

class ProductsTest : public testing::Test {
 protected:
  ProductsTest() {
    register_toys(catalog_);
    folder_.write("map.txt", "a map");
    folder_.write("configs/cases/map.txt", "a map");
    folder_.write("configs/methods/fast.yaml", std::string("# Few draws. And more.\n") + fast_method);
    folder_.write("configs/methods/slow.yaml",
                  "extends: fast\nlocalizer: {matcher: {ransam: {iterations: 900}}}\n");
    folder_.write("configs/cases/room.yaml", room_case);
    folder_.write("configs/cases/hall.yaml", "extends: room\ntrials: {every_m: 9}\n");
    ::setenv("GLOCAL_CONFIGS", (folder_ / "configs").c_str(), 1);
  }
  ~ProductsTest() override { ::unsetenv("GLOCAL_CONFIGS"); }

  std::vector<Variant> read(const std::string& text, const std::vector<Override>& overrides = {}) {
    return read_variants(folder_.write("e.yaml", "schema: 1\nname: toy\n" + text), overrides, catalog_);
  }

  /// Keys of the experiment begin in line 3 of e.yaml.
  std::string faults_of(const std::string& text, const std::vector<Override>& overrides = {}) {
    return config_error(folder_.path(), [&] { return read(text, overrides); });
  }

  static int iterations(const Variant& variant) {
    return dynamic_cast<const ParamsOf<ToyMatcher::Params>&>(*variant.experiment.localizer.matcher.params)
        .value.iterations;
  }

  Catalog catalog_;
  TemporaryFolder folder_;
};

TEST_F(ProductsTest, EachMethodMeetsEachCaseWithEachSeed) {
  const auto all = read("methods: [fast, slow]\ncases: [room, hall]\nseeds: [3, 5]\n");
  std::vector<std::string> names;
  for (const Variant& variant : all) names.push_back(variant.name);
  EXPECT_THAT(names,
              ElementsAre("fast_room_seed-3", "fast_room_seed-5", "fast_hall_seed-3", "fast_hall_seed-5",
                          "slow_room_seed-3", "slow_room_seed-5", "slow_hall_seed-3", "slow_hall_seed-5"));
  EXPECT_EQ(iterations(all[0]), 7);
  EXPECT_EQ(iterations(all[7]), 900);
  EXPECT_EQ(all[0].experiment.trials.every_m, 6.0);
  EXPECT_EQ(all[7].experiment.trials.every_m, 9.0);
  EXPECT_EQ(all[7].experiment.seed, 5U);
  EXPECT_EQ(all[7].setting, "slow");
  EXPECT_EQ(all[7].case_name, "hall");
  EXPECT_THAT(all[7].values, ElementsAre(Pair("method", "slow")));
}

TEST_F(ProductsTest, AreNoMoreThanTenThousandWithTheirSeeds) {
  EXPECT_EQ(read("methods: [fast, slow]\ncases: [room]\nseeds: 1..5000\n").size(), 10'000U);
  EXPECT_THAT(faults_of("methods: [fast, slow]\ncases: [room]\nseeds: 1..5001\n"),
              HasSubstr("e.yaml:5:8: error: variants: are more than 10000"));
}

TEST_F(ProductsTest, NeedNoFile) {
  const auto all = read_variants(
      {}, {{"methods", "[fast]"}, {"cases", "[room]"}, {"seeds", "1..3"}, {"name", "n"}}, catalog_);
  ASSERT_EQ(all.size(), 3U);
  EXPECT_EQ(all[2].name, "fast_room_seed-3");
  EXPECT_EQ(iterations(all[2]), 7);
}

TEST_F(ProductsTest, PartsAreNamedByFileOrWrittenHere) {
  folder_.write("other.yaml", fast_method);
  const auto all = read(
      "methods:\n"
      "  fast:\n"
      "  theirs: other.yaml\n"
      "  mine: {localizer: {matcher: {ransam: {iterations: 3}}}}\n"
      "cases:\n"
      "  - room\n"
      "  - here: {map: {toy_map: {path: map.txt}}, observations: toy_drive, trials: {every_m: 2}}\n");
  ASSERT_EQ(all.size(), 6U);
  EXPECT_EQ(all[0].name, "fast_room");
  EXPECT_EQ(all[3].name, "theirs_here");
  EXPECT_EQ(all[5].name, "mine_here");
  EXPECT_EQ(iterations(all[5]), 3);
  EXPECT_EQ(all[5].experiment.trials.every_m, 2.0);
}

TEST_F(ProductsTest, TheExperimentsOwnValuesAndTheCommandLinesComeLast) {
  const auto all =
      read("methods: [fast, slow]\ncases: [room]\nlocalizer: {contact_epsilon: 0.07}\ntrials: {every_m: 4}\n",
           {{"localizer.matcher.ransam.iterations", "11"}});
  for (const Variant& variant : all) {
    EXPECT_EQ(variant.experiment.localizer.contact_epsilon, 0.07) << variant.name;
    EXPECT_EQ(variant.experiment.trials.every_m, 4.0) << variant.name;
    EXPECT_EQ(iterations(variant), 11) << variant.name;
  }
}

TEST_F(ProductsTest, ThoseOfTheCommandLineTakeThePlaceOfTheExperimentsOwn) {
  const std::string own =
      "localizer: {matcher: {ransam: {iterations: 3}}, contact_epsilon: 0.25}\n"
      "map: {toy_map: {path: none.txt}}\nobservations: toy_drive\ntrials: {every_m: 4, max_steps: 2}\n";
  const auto all = read(own, {{"methods", "[fast]"}, {"cases", "[room]"}});
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(iterations(all[0]), 7);
  EXPECT_EQ(all[0].experiment.localizer.contact_epsilon, std::nullopt);
  EXPECT_EQ(all[0].experiment.trials.every_m, 6.0);
  EXPECT_EQ(all[0].experiment.trials.max_steps, Experiment().trials.max_steps);
  // Trials alone are no case, and a localizer beside methods is none of its own.
  const std::string changes =
      "methods: [fast]\ncases: [room]\nlocalizer: {contact_epsilon: 0.25}\ntrials: {every_m: 4}\n";
  const auto others = read(changes, {{"methods", "[slow]"}, {"cases", "[hall]"}});
  ASSERT_EQ(others.size(), 1U);
  EXPECT_EQ(iterations(others[0]), 900);
  EXPECT_EQ(others[0].experiment.localizer.contact_epsilon, 0.25);
  EXPECT_EQ(others[0].experiment.trials.every_m, 4.0);
}

TEST_F(ProductsTest, VariantsVaryParametersOfEachMethod) {
  const auto all = read(
      "methods: [fast, slow]\ncases: [room]\n"
      "variants: {list: {as_is: {}, wide: {localizer.contact_epsilon: 0.2}}}\n");
  ASSERT_EQ(all.size(), 4U);
  EXPECT_EQ(all[3].name, "slow_wide_room");
  EXPECT_EQ(all[3].setting, "slow_wide");
  EXPECT_THAT(all[3].values, ElementsAre(Pair("method", "slow"), Pair("localizer.contact_epsilon", "0.2")));
}

TEST_F(ProductsTest, CasesAreChosenOnAndJudgedOn) {
  const auto all = read(
      "localizer: {matcher: ransam}\nseeds: [1, 2]\nchoose_on: [room]\njudge_on: [hall]\n"
      "variants: {grid: {localizer.matcher.ransam.iterations: [50, 200]}}\n");
  std::vector<std::string> names;
  for (const Variant& variant : all) names.push_back(variant.name);
  EXPECT_THAT(names, ElementsAre("iterations-50_room_seed-1", "iterations-50_room_seed-2",
                                 "iterations-200_room_seed-1", "iterations-200_room_seed-2",
                                 "iterations-50_hall_seed-1", "iterations-50_hall_seed-2",
                                 "iterations-200_hall_seed-1", "iterations-200_hall_seed-2"));
  EXPECT_EQ(all[0].role, CaseRole::choose);
  EXPECT_EQ(all[7].role, CaseRole::judge);
  EXPECT_EQ(all[7].case_name, "hall");
  EXPECT_EQ(all[7].setting, "iterations-200");
  EXPECT_THAT(all[7].values, ElementsAre(Pair("localizer.matcher.ransam.iterations", "200")));
  EXPECT_FALSE(all[7].changes_trials);
}

TEST_F(ProductsTest, OneOfEachIsAnExperimentOfItsOwn) {
  const auto all = read("methods: fast\ncases: room\n");
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0].name, "");
  EXPECT_EQ(all[0].setting, "");
  EXPECT_EQ(all[0].case_name, "room");
  EXPECT_EQ(read("methods: fast\ncases: room\nseeds: 4\n").front().name, "seed-4");
  EXPECT_EQ(read("methods: fast\ncases: [room]\nseeds: 4\n").front().name, "room_seed-4");
}

TEST_F(ProductsTest, WhatAnExperimentSaysItselfACaseMayLeaveOut) {
  const auto all = read(
      "map: {toy_map: {path: map.txt}}\nobservations: toy_drive\nlocalizer: {matcher: ransam}\n"
      "cases: {near: {trials: {every_m: 2}}, far: {trials: {every_m: 5}}}\n");
  ASSERT_EQ(all.size(), 2U);
  EXPECT_EQ(all[0].experiment.trials.every_m, 2.0);
  EXPECT_EQ(all[1].experiment.trials.every_m, 5.0);
}

TEST_F(ProductsTest, ProductsOfOneNameAreRefused) {
  EXPECT_THAT(faults_of("methods: {a: fast, a_b: slow}\ncases: {b_c: room, c: hall}\n"),
              HasSubstr("two of their products have the name 'a_b_c'"));
}

TEST_F(ProductsTest, AnExperimentOfOneIsNamedOutOfSeveral) {
  const fs::path file =
      folder_.write("e.yaml", "schema: 1\nname: toy\nmethods: [fast, slow]\ncases: [room]\n");
  EXPECT_THAT(faults_of("methods: [fast, slow]\ncases: [room]\n"), "");
  EXPECT_THROW(static_cast<void>(read_experiment(file, {}, catalog_)), ConfigError);
  EXPECT_EQ(read_experiment(file, {{"methods", "[slow]"}}, catalog_).trials.every_m, 6.0);
}

TEST_F(ProductsTest, ACaseWithoutAMapIsRefused) {
  folder_.write("no_map.yaml", "observations: toy_drive\ntrials: {every_m: 6}\n");
  EXPECT_THAT(faults_of("methods: [fast]\ncases: [no_map.yaml]\n"),
              HasSubstr("no_map.yaml:1:1: error: case no_map: missing key 'map'"));
}

TEST_F(ProductsTest, AMethodHasNoKeysOfACase) {
  folder_.write("odd.yaml", std::string(fast_method) + "trials: {every_m: 6}\n");
  EXPECT_THAT(
      faults_of("methods: [odd.yaml]\ncases: [room]\n"),
      HasSubstr("odd.yaml:2:1: error: method odd: 'trials' belongs into a case; a method has localizer and "
                "plugins"));
  folder_.write("odd.yaml", std::string(room_case) + "localizer: {}\n");
  EXPECT_THAT(faults_of("methods: [fast]\ncases: [odd.yaml]\n"),
              HasSubstr("'localizer' belongs into a method"));
  folder_.write("odd.yaml", std::string(fast_method) + "treshold: 1\n");
  EXPECT_THAT(faults_of("methods: [odd.yaml]\ncases: [room]\n"), HasSubstr("unknown key 'treshold'"));
}

TEST_F(ProductsTest, ANameThatIsBuiltInAndAFileIsRefused) {
  folder_.write("fast", fast_method);
  EXPECT_THAT(
      faults_of("methods: [fast]\ncases: [room]\n"),
      HasSubstr("e.yaml:3:11: error: 'fast' is a method that is built in and a file, too; write ./fast for "
                "the file"));
  EXPECT_EQ(faults_of("methods: [./fast]\ncases: [room]\n"), "");
}

TEST_F(ProductsTest, UnknownNamesComeWithTheNearest) {
  EXPECT_THAT(
      faults_of("methods: [fats]\ncases: [room]\n"),
      HasSubstr(
          "e.yaml:3:11: error: unknown method 'fats' (did you mean 'fast'?); files are named with .yaml"));
  EXPECT_THAT(faults_of("methods: [fast]\ncases: [room.yaml]\n"), HasSubstr("case: "));
}

TEST_F(ProductsTest, EachIsThereOnce) {
  EXPECT_THAT(faults_of("methods: [fast, fast]\ncases: [room]\n"),
              HasSubstr("e.yaml:3:17: error: the method 'fast' is there twice"));
  EXPECT_THAT(faults_of("methods: [fast]\nchoose_on: [room]\njudge_on: [room]\n"),
              HasSubstr("the case 'room' is there twice"));
}

TEST_F(ProductsTest, WhatExtendsItselfIsRefused) {
  folder_.write("configs/methods/round.yaml", "extends: round\n");
  EXPECT_THAT(faults_of("methods: [round]\ncases: [room]\n"), HasSubstr("does one extend itself?"));
}

TEST_F(ProductsTest, JudgesAreOfAChoice) {
  EXPECT_THAT(faults_of("methods: [fast]\njudge_on: [hall]\n"), HasSubstr("there is no choose_on"));
  EXPECT_THAT(faults_of("methods: [fast]\ncases: [room]\nchoose_on: [hall]\n"),
              HasSubstr("choose_on: there is `cases`, too"));
}

TEST_F(ProductsTest, NamesAreThoseOfFolders) {
  EXPECT_THAT(faults_of("methods: {../up: fast}\ncases: [room]\n"),
              HasSubstr("'../up' is no name for a method"));
  EXPECT_THAT(faults_of("methods: [[fast]]\ncases: [room]\n"),
              HasSubstr("methods: expected the name of a method, its file or `name: {keys}`, got a list"));
  EXPECT_THAT(faults_of("methods: {a: 7}\ncases: [room]\n"), HasSubstr("unknown method '7'"));
}

TEST_F(ProductsTest, BuiltInPartsAreListedWithTheirFirstSentence) {
  const auto methods = builtin_parts(PartKind::method);
  ASSERT_EQ(methods.size(), 2U);
  EXPECT_EQ(methods[0].name, "fast");
  EXPECT_EQ(methods[0].about, "Few draws.");
}

}  // namespace
}  // namespace glocal::test::products_test
