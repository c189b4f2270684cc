#include "evaluation/comparison/comparability.hpp"

#include <gmock/gmock.h>

#include "evaluation/comparison/runs.hpp"

namespace glocal::test::comparability_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// Two runs of 30 trials, each right, with nothing against them.
class Comparability : public testing::Test {
 protected:
  Comparability() {
    for (const char* name : {"a", "b"}) {
      runs_.push_back(run_of(name, std::vector<TrialResult>(30, right_after(10.0))));
      runs_.back().results.settings = {{"evaluation.max_translation_error", {"0.5", "0.5"}},
                                       {"map.ros_map.path", {"/maps/lab.yaml", "hash of the map"}},
                                       {"observations.carmen_log.path", {"/logs/lab.log", "hash of the log"}},
                                       {"localizer.matcher.ransam.iterations", {name, name}},
                                       {"trials.max_steps", {"60", "60"}}};
    }
  }
  [[nodiscard]] std::vector<std::string> warnings() const { return compare(runs_, 0).warnings; }
  StoredRun& b() { return runs_[1].results; }
  TrialResult& trial(std::size_t index) {
    return std::next(b().trials.begin(), std::ptrdiff_t(index))->second;
  }

  std::vector<NamedRun> runs_;
};

TEST_F(Comparability, SaysNothingWhereOnlyTheLocalizerDiffers) {
  EXPECT_THAT(warnings(), IsEmpty());
}

TEST_F(Comparability, NamesSettingsThatDiffer) {
  b().settings["evaluation.max_translation_error"] = {"0.3", "0.3"};
  b().settings["observations.carmen_log.max_range"] = {"20", "20"};
  b().settings["trials.max_steps"] = {"41", "41"};
  EXPECT_THAT(
      warnings(),
      ElementsAre(HasSubstr("judged by other limits, so right and wrong do not mean the same "
                            "(evaluation.max_translation_error: 0.3 instead of 0.5)"),
                  HasSubstr("other observations (observations.carmen_log.max_range: 20 instead of nothing)"),
                  HasSubstr("trials.max_steps: 41 instead of 60")));
}

TEST_F(Comparability, TellsFilesByTheirContent) {
  b().settings["map.ros_map.path"] = {"/copies/lab.yaml", "hash of the map"};
  EXPECT_THAT(warnings(), IsEmpty());
  b().settings["map.ros_map.path"] = {"/maps/lab.yaml", "hash of another map"};
  EXPECT_THAT(warnings(),
              ElementsAre("b and a were given other maps (map.ros_map.path: /maps/lab.yaml has changed)."));
}

TEST_F(Comparability, ListsOnlyTheFirstOfManySettings) {
  for (const char* key : {"a", "b", "c", "d", "e"}) b().settings[std::string("map.") + key] = {"1", "1"};
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("map.c: 1 instead of nothing, 2 more)")));
}

TEST_F(Comparability, TellsOfInterruptedAndUnjudgedTrials) {
  b().complete = false;
  trial(3) = ended(Outcome::failed);
  trial(4) = ended(Outcome::declared);
  EXPECT_THAT(warnings(), ElementsAre("b was interrupted: later trials are missing.",
                                      HasSubstr("1 trials of b failed with an exception"),
                                      HasSubstr("1 declarations of b have no reference")));
}

TEST_F(Comparability, TellsOfAnotherSeedAndAnotherDrive) {
  b().seed = 2;
  runs_[0].results.trials.begin()->second.start_reference = Pose2{1.0, 2.0, 0.0};
  trial(0).start_reference = Pose2{1.0, 2.1, 0.0};
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("b has seed 2 and a seed 0"),
                                      HasSubstr("At 1 of 30 starts b and a have different reference poses")));
}

TEST_F(Comparability, TellsOfTimesOfAnotherMachine) {
  b().machine.host = "other";
  b().machine.cpu = "CPU";
  b().machine.threads = 4;
  EXPECT_THAT(warnings(),
              ElementsAre(HasSubstr("Times of b and a are not compared: other (CPU), 4 threads")));
}

TEST_F(Comparability, TellsOfTimesTakenSideBySideAndUnderAnotherLoad) {
  b().machine.others_load = 0.4;
  EXPECT_THAT(warnings(), IsEmpty());
  runs_[0].results.machine.others_load = 1.0;
  EXPECT_THAT(warnings(),
              ElementsAre("Times of b and a are not compared: others kept 0.4 processors busy, and "
                          "others kept 1.0 processors busy."));
  b().machine.jobs = 2;
  EXPECT_THAT(warnings(), ElementsAre("Times of b and a are not compared: --jobs 2, and --jobs 1."));
  runs_[0].results.machine.jobs = b().machine.jobs = 0;
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("processes of several numbers of jobs, and")));
}

TEST_F(Comparability, TellsOfTimesWithSeveralNumbersOfThreads) {
  runs_[0].results.machine.threads = b().machine.threads = 0;
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("several numbers of threads, and ")));
}

TEST_F(Comparability, TellsOfTrialsThatReachTheNextStart) {
  // Starts are 100 m apart; 3 of 30 are no more than a tenth.
  for (std::size_t i = 0; i < 3; ++i) trial(i).distance_m = 101.0;
  EXPECT_THAT(warnings(), IsEmpty());
  trial(3).distance_m = 101.0;
  EXPECT_THAT(warnings(), ElementsAre(HasSubstr("Of 30 trials, these go on beyond the next start: 4 of b.")));
}

TEST_F(Comparability, TellsOfFewPlaces) {
  for (NamedRun& run : runs_)
    run.results.trials.erase(std::next(run.results.trials.begin(), 10), run.results.trials.end());
  // Wilson's bound of 10 of 10 is 10 / (10 + 3.84).
  EXPECT_THAT(warnings(),
              ElementsAre("Few places: 10 right of 10 would still leave a success rate of 72 % possible."));
}

}  // namespace
}  // namespace glocal::test::comparability_test
