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
    const Answer answer = run("new-plugin " + arguments + " " + folder().string());
    EXPECT_EQ(answer.exit_code, 2) << arguments;
    EXPECT_THAT(answer.err, HasSubstr(words));
    EXPECT_FALSE(fs::exists(folder())) << arguments;
  }
};

TEST_F(NewPluginCommand, WritesFilesWithoutPlaceholders) {
  const Answer answer = run("new-plugin verdict_rule very_sure " + folder().string());
  ASSERT_EQ(answer.exit_code, 0) << answer.err;
  EXPECT_THAT(answer.out, HasSubstr("ctest --test-dir"));
  for (const char* name : {"CMakeLists.txt", "very_sure.cpp", "experiment.yaml", "world.yaml"}) {
    EXPECT_THAT(content(folder() / name), AllOf(Not(HasSubstr("@")), Not(testing::IsEmpty()))) << name;
  }
  EXPECT_THAT(content(folder() / "very_sure.cpp"), HasSubstr("class VerySure final : public VerdictRule"));
  EXPECT_THAT(content(folder() / "experiment.yaml"), HasSubstr("  verdict_rule: very_sure\n"));
}

TEST_F(NewPluginCommand, RefusesWhatCannotBeBuilt) {
  expect_refused("matchers mine", "unknown kind 'matchers' (did you mean 'matcher'?)");
  expect_refused("matcher MyMatcher", "small letters");
  expect_refused("matcher 2nd", "beginning with a letter");
  expect_refused("matcher ../mine", "small letters");
  expect_refused("matcher ransam", "there is a matcher 'ransam' already, from glocal");
}

TEST_F(NewPluginCommand, LeavesAFolderThatIsInUseAlone) {
  fs::create_directory(folder());
  std::ofstream(folder() / "thesis.txt") << "unfinished\n";
  const Answer answer = run("new-plugin matcher mine " + folder().string());
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_THAT(answer.err, HasSubstr(folder().string()));
  EXPECT_EQ(content(folder() / "thesis.txt"), "unfinished\n");
  EXPECT_FALSE(fs::exists(folder() / "mine.cpp"));
}

}  // namespace
}  // namespace glocal::test::new_plugin_test
