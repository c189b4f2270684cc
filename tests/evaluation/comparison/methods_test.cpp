// Which runs are one method, and which trials are pairs.
#include "evaluation/comparison/methods.hpp"

#include <gmock/gmock.h>

#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/sweeps/runs.hpp"
#include "files.hpp"

namespace glocal::test::methods_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<std::string> names_of(const std::vector<Method>& methods) {
  std::vector<std::string> names;
  for (const Method& method : methods) names.push_back(method.name);
  return names;
}

NamedRun in_folder(const std::string& folder, NamedRun run) {
  run.results.folder = folder + "/" + run.name;
  return run;
}

TEST(Methods, AreSettingsAndRunsThatAreOfNone) {
  const std::vector<NamedRun> runs = {sweep_run({.setting = "a", .case_name = "near", .seed = 1}, "r"),
                                      sweep_run({.setting = "b", .case_name = "near", .seed = 1}, "r"),
                                      sweep_run({.setting = "a", .case_name = "far", .seed = 2}, "r"),
                                      run_of("alone", {right_after(3.0)}),
                                      sweep_run({.setting = "", .seed = 1}, "r")};
  const std::vector<Method> methods = methods_of(runs);
  EXPECT_THAT(names_of(methods), ElementsAre("a", "b", "alone", "toy"));
  ASSERT_EQ(methods[0].runs.size(), 2U);
  EXPECT_EQ(methods[0].runs[1].case_name, "far");
  EXPECT_EQ(methods[0].runs[1].seed, 2U);
  EXPECT_EQ(methods[0].runs[1].index, 2U);
}

TEST(Methods, OfOneNameGoByTheirFolders) {
  const NamedRun run = sweep_run({.setting = "a", .case_name = "near"}, "r");
  EXPECT_THAT(names_of(methods_of({in_folder("x/old", run), in_folder("x/new/", run)})),
              ElementsAre("old/a", "new/a"));
  EXPECT_THAT(names_of(methods_of({in_folder("/x/r", run), in_folder("/y/r", run)})),
              ElementsAre("/x/r/a", "/y/r/a"));
}

TEST(Methods, HaveARunForEachCaseAndSeed) {
  const NamedRun run = sweep_run({.setting = "a", .case_name = "near"}, "r");
  EXPECT_THAT(error_of([&] { return methods_of(std::vector(2, run)); }),
              HasSubstr("provenance.json: error: is of the same setting, case and seed as "
                        "a_near_seed-1; leave one of them out"));
}

TEST(Methods, HaveOneLocalizer) {
  std::vector<NamedRun> runs = {sweep_run({.setting = "a", .case_name = "near", .seed = 2}, "r"),
                                sweep_run({.setting = "a", .case_name = "near", .seed = 1}, "r"),
                                sweep_run({.setting = "a", .case_name = "far", .seed = 1}, "r")};
  const auto set = [&](std::size_t run, const char* path, const char* value) {
    runs[run].results.settings[path] = {value, value};
  };
  set(2, "observations.carmen_log.path", "other.log");
  EXPECT_EQ(methods_of(runs).size(), 1U);
  for (const std::size_t other : {0U, 1U}) {
    set(other, "localizer.contact_epsilon", "0.1");
    EXPECT_THAT(error_of([&] { return methods_of(runs); }),
                HasSubstr("has another localizer.contact_epsilon than a_near_seed-2, and both are of the "
                          "setting 'a'; leave one of them out"));
  }
  set(2, "localizer.contact_epsilon", "0.1");
  EXPECT_EQ(methods_of(runs).size(), 1U);
}

TEST(Methods, AreBaselinesByTheirNames) {
  const std::vector<NamedRun> runs = {sweep_run({.setting = "a", .seed = 1}, "r"),
                                      sweep_run({.setting = "b", .seed = 1}, "r"),
                                      sweep_run({.setting = "b", .seed = 2}, "r")};
  EXPECT_EQ(find_baseline(runs, "b"), 1U);
  EXPECT_EQ(find_baseline(runs, "b__seed-2"), 2U);
  EXPECT_EQ(find_baseline(runs, ""), 0U);
}

TEST(PairedTrials, LieTogetherByPlace) {
  // The same two starts with both seeds: two places of two trials each.
  const std::vector<NamedRun> runs = {
      sweep_run({.setting = "a", .seed = 1}, "rw"), sweep_run({.setting = "a", .seed = 2}, "ru"),
      sweep_run({.setting = "b", .seed = 2}, "uur"), sweep_run({.setting = "b", .seed = 1}, "wr")};
  const PairedTrials paired = pair_trials(runs, methods_of(runs));
  ASSERT_EQ(paired.trials.size(), 4U);
  ASSERT_EQ(paired.places.size(), 2U);
  EXPECT_EQ(paired.places[0].sample, 0);
  EXPECT_EQ(paired.places[0].end, 2U);
  EXPECT_EQ(paired.places[1].begin, 2U);
  const auto outcomes = [&](std::size_t method) {
    std::vector<Outcome> list;
    for (const TrialResult* trial : paired.results[method]) list.push_back(trial->outcome);
    return list;
  };
  EXPECT_THAT(outcomes(0), ElementsAre(Outcome::right, Outcome::right, Outcome::wrong, Outcome::undecided));
  EXPECT_THAT(outcomes(1),
              ElementsAre(Outcome::wrong, Outcome::undecided, Outcome::right, Outcome::undecided));
  EXPECT_THAT(paired.left_out, IsEmpty());
}

TEST(PairedTrials, OfOneSeedEachMayHaveAnyOne) {
  const std::vector<NamedRun> runs = {sweep_run({.setting = "a", .case_name = "near", .seed = 1}, "r"),
                                      sweep_run({.setting = "b", .case_name = "near", .seed = 9}, "r"),
                                      sweep_run({.setting = "b", .case_name = "far", .seed = 9}, "r")};
  const PairedTrials paired = pair_trials(runs, methods_of(runs));
  EXPECT_EQ(paired.trials.size(), 1U);
  EXPECT_THAT(paired.left_out, ElementsAre("far (only b)"));
}

}  // namespace
}  // namespace glocal::test::methods_test
