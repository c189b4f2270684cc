// Every file in configs/ is good.
#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <vector>

#include "app/program.hpp"
#include "files.hpp"

namespace glocal::test::configs_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> names_in(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(fs::path(GLOCAL_SOURCE_DIR) / "configs" / folder)) {
    if (entry.path().extension() == ".yaml") names.push_back(entry.path().stem());
  }
  std::sort(names.begin(), names.end());
  return names;
}

std::string path_of(const std::string& folder, const std::string& name) {
  return fs::path(GLOCAL_SOURCE_DIR) / "configs" / folder / (name + ".yaml");
}

std::string name_of(const testing::TestParamInfo<std::string>& info) {
  return info.param;
}

class ConfigsTest : public CommandLine {
 protected:
  /// A file with all methods and cases that it is made of.
  static std::string text_with_parts(const std::string& file) {
    std::string text = content(file);
    const std::string own = text;
    const std::regex parts("(?:methods|cases|extends): (\\w+)");
    for (std::sregex_iterator part(own.begin(), own.end(), parts); part != std::sregex_iterator(); ++part) {
      for (const char* folder : {"methods", "cases"}) {
        const std::string named = path_of(folder, (*part)[1]);
        if (named != file && fs::exists(named)) text += text_with_parts(named);
      }
    }
    return text;
  }

  /// Why what stands in this text cannot be read here; empty if it can.
  static std::string why_not_here(const std::string& text) {
    std::smatch plugin;
    if (std::regex_search(text, plugin, std::regex("plugin:(\\w+)")) &&
        !fs::exists(fs::path(GLOCAL_PLUGINS_FOLDER) / ("glocal_" + plugin[1].str() + ".so")))
      return "its plugin is not built: the package it brings is not installed";
    if (text.find("data:") != std::string::npos && dataset("").empty()) return "GLOCAL_DATASETS is not set";
    return "";
  }
};

class Experiments : public ConfigsTest, public testing::WithParamInterface<std::string> {};

TEST_P(Experiments, OpenWithWhatTheyShow) {
  const std::string text = content(path_of("experiments", GetParam()));
  EXPECT_THAT(text, testing::StartsWith("# "));
  EXPECT_GT(text.find('\n'), 20U);
  EXPECT_THAT(text, testing::HasSubstr("\nname: " + GetParam() + "\n"));
}

TEST_P(Experiments, PassTheCheck) {
  const std::string file = path_of("experiments", GetParam());
  if (const std::string why = why_not_here(text_with_parts(file)); !why.empty()) GTEST_SKIP() << why;
  const Answer answer = good(run("check " + file));
  EXPECT_THAT(answer.out, testing::HasSubstr(": ok, "));
}

INSTANTIATE_TEST_SUITE_P(Configs, Experiments, testing::ValuesIn(names_in("experiments")), name_of);

/// Whether a method or a case is about points in space.
bool is_in_space(const std::string& text) {
  return std::regex_search(text, std::regex("motion: |points: space|point_cloud:|lidar3d/"));
}

class Methods : public ConfigsTest, public testing::WithParamInterface<std::string> {};

TEST_P(Methods, PassTheCheckWithACase) {
  const std::string text = text_with_parts(path_of("methods", GetParam()));
  EXPECT_THAT(text, testing::StartsWith("# "));
  const std::string one_case = is_in_space(text) ? "building_single" : "paper_simulation";
  const std::string why = why_not_here(text + content(path_of("cases", one_case)));
  if (!why.empty()) GTEST_SKIP() << why;
  good(run("check --method " + GetParam() + " --case " + one_case));
}

INSTANTIATE_TEST_SUITE_P(Configs, Methods, testing::ValuesIn(names_in("methods")), name_of);

class Cases : public ConfigsTest, public testing::WithParamInterface<std::string> {};

TEST_P(Cases, PassTheCheckWithAMethod) {
  const std::string text = text_with_parts(path_of("cases", GetParam()));
  EXPECT_THAT(text, testing::StartsWith("# "));
  if (const std::string why = why_not_here(text); !why.empty()) GTEST_SKIP() << why;
  good(run("check --method " + std::string(is_in_space(text) ? "lidar_free" : "indexed") + " --case " +
           GetParam()));
}

INSTANTIATE_TEST_SUITE_P(Configs, Cases, testing::ValuesIn(names_in("cases")), name_of);

class Suites : public ConfigsTest, public testing::WithParamInterface<std::string> {};

/// What is in files of data sets shows when they are loaded: the tests of the leaderboard do that.
TEST_P(Suites, HaveTheCasesThatTheyPin) {
  EXPECT_THAT(content(path_of("suites", GetParam())), testing::StartsWith("# "));
  const Answer answer =
      run("run --method paper --suite " + GetParam() + " --share 1e-12 --out " + file("nothing"));
  if (answer.err.find("GLOCAL_DATASETS, which is not set") != std::string::npos)
    GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  EXPECT_THAT(answer.err, testing::HasSubstr("has no start"));
  EXPECT_THAT(answer.err, testing::EndsWith("1 error\n"));
}

INSTANTIATE_TEST_SUITE_P(Configs, Suites, testing::ValuesIn(names_in("suites")), name_of);

class Worlds : public CommandLine, public testing::WithParamInterface<std::string> {};

TEST_P(Worlds, OpenWithWhatTheyAre) {
  EXPECT_THAT(content(path_of("worlds", GetParam())), testing::StartsWith("# "));
}

TEST_P(Worlds, AreUsed) {
  const auto is_used_in = [&](const char* folder) {
    const std::vector<std::string> names = names_in(folder);
    return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
      return content(path_of(folder, name)).find("worlds/" + GetParam() + ".yaml") != std::string::npos;
    });
  };
  EXPECT_TRUE(is_used_in("cases") || is_used_in("experiments"));
}

INSTANTIATE_TEST_SUITE_P(Configs, Worlds, testing::ValuesIn(names_in("worlds")), name_of);

}  // namespace
}  // namespace glocal::test::configs_test
