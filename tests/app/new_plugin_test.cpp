// glocal new-plugin: what it refuses. That what it writes builds and runs, the test of the package shows.
#include <gmock/gmock.h>

#include <filesystem>

#include "app/program.hpp"

namespace glocal::test::new_plugin_test {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

class NewPluginCommand : public CommandLine {
 protected:
  [[nodiscard]] fs::path folder() const { return folder_.path() / "new"; }

  void expect_refused(const std::string& arguments, const std::string& words) const {
    const Answer answer = run("new-plugin " + arguments + " -o " + folder().string());
    EXPECT_EQ(answer.exit_code, 2) << arguments;
    EXPECT_THAT(answer.err, HasSubstr(words));
    EXPECT_FALSE(fs::exists(folder())) << arguments;
  }
};

TEST_F(NewPluginCommand, WritesFilesWithoutPlaceholders) {
  const Answer answer = good(run("new-plugin verdict_rule very_sure -o " + folder().string()));
  EXPECT_THAT(answer.out, HasSubstr("ctest --test-dir"));
  for (const char* name : {"CMakeLists.txt", "very_sure.cpp", "experiment.yaml", "world.yaml"}) {
    EXPECT_THAT(content(folder() / name), AllOf(Not(HasSubstr("@")), Not(testing::IsEmpty()))) << name;
  }
  EXPECT_THAT(content(folder() / "very_sure.cpp"), HasSubstr("class VerySure final : public VerdictRule"));
  EXPECT_THAT(content(folder() / "experiment.yaml"), HasSubstr("  verdict_rule: very_sure\n"));
}

TEST_F(NewPluginCommand, WritesPythonForEveryKindThatThereIs) {
  for (const char* kind : {"matcher", "clusterer", "rater", "threshold_policy", "verdict_rule", "verifier",
                           "local_mapper", "map_source", "observation_source"}) {
    const std::string out = folder().string() + "/" + kind;
    fs::create_directories(folder());
    ASSERT_EQ(run(std::string("new-plugin --python ") + kind + " very_sure -o " + out).exit_code, 0) << kind;
    const std::string text = content(out + "/very_sure.py");
    EXPECT_THAT(text, AllOf(Not(HasSubstr("@NAME")), Not(HasSubstr("@CLASS")))) << kind;
    EXPECT_THAT(text, HasSubstr("@glocal.register(\"very_sure\")\nclass VerySure(glocal.")) << kind;
    EXPECT_THAT(content(out + "/test_very_sure.py"),
                HasSubstr(std::string("\"") + kind + "\", \"very_sure\""))
        << kind;
    EXPECT_THAT(content(out + "/experiment.yaml"), HasSubstr("plugins: [very_sure.py]\n")) << kind;
    EXPECT_FALSE(fs::exists(out + "/CMakeLists.txt")) << kind;
  }
}

TEST_F(NewPluginCommand, TheFolderIsCalledAsTheStrategyUnlessItIsNamed) {
  good(run("new-plugin rater my_rater"));
  EXPECT_TRUE(fs::exists("my_rater/my_rater.cpp"));
}

TEST_F(NewPluginCommand, RefusesWhatCannotBeBuilt) {
  expect_refused("--python contact_index mine",
                 "there are no strategies of the kind contact_index in Python");
  expect_refused("matchers mine", "unknown kind 'matchers' (did you mean 'matcher'?)");
  expect_refused("matcher MyMatcher", "small letters");
  expect_refused("matcher 2nd", "beginning with a letter");
  expect_refused("matcher ../mine", "small letters");
  expect_refused("matcher test", "'test' is a target of CMake's own");
  expect_refused("matcher ransam", "there is a matcher 'ransam' already, from glocal");
}

TEST_F(NewPluginCommand, LeavesAFolderThatIsInUseAlone) {
  fs::create_directory(folder());
  std::ofstream(folder() / "thesis.txt") << "unfinished\n";
  EXPECT_THAT(refusal(run("new-plugin matcher mine -o " + folder().string())),
              HasSubstr(folder().string() +
                        ": error: the folder exists and is not empty; choose another one with --out\n"));
  EXPECT_EQ(content(folder() / "thesis.txt"), "unfinished\n");
  EXPECT_FALSE(fs::exists(folder() / "mine.cpp"));
}

}  // namespace
}  // namespace glocal::test::new_plugin_test
