// glocal complete, glocal completion.
#include <gmock/gmock.h>

#include <sstream>

#include "app/program.hpp"

namespace glocal::test::completion_test {
namespace {

using testing::AllOf;
using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::StartsWith;

class Completion : public CommandLine {
 protected:
  /// What may be typed in place of the last of these words, without what is said of it.
  std::vector<std::string> candidates(const std::string& words) const {
    const Answer answer = run("complete -- " + words);
    EXPECT_EQ(answer.exit_code, 0) << words;
    EXPECT_EQ(answer.err, "") << words;
    std::vector<std::string> found;
    std::istringstream lines(answer.out);
    for (std::string line; std::getline(lines, line);) found.push_back(line.substr(0, line.find('\t')));
    return found;
  }
};

TEST_F(Completion, OffersCommandsWithWhatTheyDo) {
  EXPECT_THAT(candidates("''"), AllOf(Contains("run"), Contains("map"), Not(Contains("complete"))));
  EXPECT_THAT(candidates("ru"), ElementsAre("run"));
  EXPECT_THAT(candidates("map con"), ElementsAre("convert"));
  EXPECT_THAT(run("complete -- ru").out, StartsWith("run\tRun an experiment"));
  EXPECT_THAT(candidates("nothing-like-it"), IsEmpty());
}

TEST_F(Completion, OffersTheOptionsOfTheCommand) {
  EXPECT_THAT(candidates("run --see"), ElementsAre("--seeds", "--seed"));
  EXPECT_THAT(candidates("run a.yaml --out b --se"), ElementsAre("--seeds", "--set", "--seed"));
  EXPECT_THAT(candidates("describe --plu"), ElementsAre("--plugin"));
  EXPECT_THAT(candidates("map build --plu"), ElementsAre("--plugin"));
  EXPECT_THAT(candidates("map build --fo"), Not(IsEmpty()));
}

TEST_F(Completion, OffersValuesWhereTheyAreKnown) {
  EXPECT_THAT(candidates("completion ''"), ElementsAre("bash", "zsh", "fish"));
  EXPECT_THAT(candidates("list mat"), ElementsAre("matcher"));
  EXPECT_THAT(candidates("new-plugin local"), ElementsAre("local_mapper"));
  EXPECT_THAT(candidates("contract matcher rans"), ElementsAre("ransac", "ransam"));
  EXPECT_THAT(candidates("run --method indexed_"), ElementsAre("indexed_single", ":files"));
  EXPECT_THAT(candidates("run --case paper_l"), ElementsAre("paper_lab", ":files"));
  EXPECT_THAT(candidates("describe rans"), ElementsAre("ransac", "ransam"));
  EXPECT_THAT(candidates("describe trial"), ElementsAre("trials"));
  EXPECT_THAT(candidates("help summ"), ElementsAre("summarize"));
  EXPECT_THAT(candidates("prepare --poses-of r"), ElementsAre("robot"));
  EXPECT_THAT(candidates("prepare --poses-of=r"), ElementsAre("--poses-of=robot"));
}

TEST_F(Completion, OffersFilesWhereAnyMayStand) {
  EXPECT_THAT(candidates("run ''"), ElementsAre(":files"));
  EXPECT_THAT(candidates("run x --out res"), ElementsAre(":files"));
  EXPECT_THAT(candidates("compare a b c"), ElementsAre(":files"));
  EXPECT_THAT(candidates("-- run x"), ElementsAre(":files"));
  EXPECT_THAT(candidates("run x --jobs ''"), IsEmpty()) << "a number";
  EXPECT_THAT(candidates("run x y"), IsEmpty()) << "one experiment";
}

TEST_F(Completion, FollowsThePathsOfSet) {
  EXPECT_THAT(candidates("run --set localizer.mat"), ElementsAre("localizer.matcher=", "localizer.matcher."));
  EXPECT_THAT(candidates("run --set localizer.matcher.ransam.it"),
              ElementsAre("localizer.matcher.ransam.iterations="));
  EXPECT_THAT(candidates("run --set=localizer.matcher=rans"),
              ElementsAre("--set=localizer.matcher=ransac", "--set=localizer.matcher=ransam"));
  EXPECT_THAT(candidates("run --set output.steps="), ElementsAre("output.steps=true", "output.steps=false"));
  EXPECT_THAT(candidates("run --set no.such."), IsEmpty());
  EXPECT_THAT(candidates("describe localizer.matcher.ransam.it"),
              ElementsAre("localizer.matcher.ransam.iterations"));
}

TEST_F(Completion, WritesTheScriptOfAShell) {
  EXPECT_THAT(run("completion bash").out, HasSubstr("complete -F _glocal glocal\n"));
  EXPECT_THAT(run("completion zsh").out, StartsWith("#compdef glocal\n"));
  EXPECT_THAT(run("completion fish").out, HasSubstr("complete -c glocal "));
  EXPECT_EQ(run("completion tcsh").exit_code, 2);
}

TEST_F(Completion, OfAnyPartOfALineIsAnswered) {
  const std::string line = "run --set localizer.matcher=ransam room.yaml --jobs 2 --out results/a";
  for (std::size_t n = 0; n <= line.size(); ++n) {
    const std::string typed = line.substr(0, n);
    good(run("complete -- " + typed + (typed.empty() || typed.back() == ' ' ? "''" : "")));
  }
}

}  // namespace
}  // namespace glocal::test::completion_test
