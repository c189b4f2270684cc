// Which folder may include which: docs/architecture.md says why. And that folders say what is in them.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace glocal::test::layers_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = GLOCAL_SOURCE_DIR;

const std::set<std::string> strategy_folders = {"sources",    "local_mappers", "matchers",
                                                "clustering", "raters",        "verifiers"};

const std::map<std::string, std::set<std::string>> layers_below = {
    {"framework", {}},
    {"evaluation", {"framework"}},
    {"report", {"evaluation", "framework"}},
    {"app",
     {"report", "evaluation", "framework", "sources", "local_mappers", "matchers", "clustering", "raters",
      "verifiers", "python"}},
    {"python", {"evaluation", "framework"}}};

/// Made when glocal is built.
const std::map<std::string, std::string> generated = {{"version.hpp", "framework/src/version.hpp"}};

/// The folder of this depth that a file is in, from 0; empty if there is none.
std::string folder_at(const fs::path& file, int depth) {
  const auto parts = std::distance(file.begin(), file.end());
  return depth + 1 < parts ? std::next(file.begin(), depth)->string() : "";
}

bool is_public(const fs::path& file) {
  return folder_at(file, 1) == "include";
}

/// What matchers of all families share, and verifiers with them.
const std::set<std::string> shared_by_families = {"box_search", "common", "surfels"};

/// Why matchers of one family may not include this file of another one; empty if they may.
std::string fault_between_families(const fs::path& file, const fs::path& included) {
  const std::string family = folder_at(file, 1);
  const std::string other = folder_at(included, 1);
  // What is in no family registers them all.
  if (family.empty() || other == family || shared_by_families.contains(other)) return "";
  return "a family of matchers includes only itself and what all share";
}

/// Why a file may not include another; empty if it may. Paths begin at the root.
std::string fault_of(const fs::path& file, const fs::path& included) {
  const std::string layer = folder_at(file, 0);
  const std::string other = folder_at(included, 0);
  if (const auto below = layers_below.find(layer); below != layers_below.end()) {
    return layer == other || below->second.contains(other) ? ""
                                                           : fmt::format("{} lies below {}", layer, other);
  }
  if (other == "framework" && is_public(included)) return "";
  const bool is_own = layer == other && (layer != "plugins" || folder_at(file, 1) == folder_at(included, 1) ||
                                         folder_at(included, 1) == "common");
  if (layer == "verifiers" && shared_by_families.contains(folder_at(included, 1))) return "";
  if (!is_own) return "strategies include only the framework's public headers and their own folder";
  return layer == "matchers" ? fault_between_families(file, included) : "";
}

/// The file that an #include leads to; none if it is not of this tree.
std::optional<fs::path> resolved(const fs::path& file, const std::string& name) {
  if (const auto made = generated.find(name); made != generated.end()) return made->second;
  for (const fs::path& folder : {file.parent_path(), fs::path(), fs::path("framework/include"),
                                 fs::path("framework/src"), fs::path("evaluation/include")}) {
    if (fs::exists(root / folder / name)) return (folder / name).lexically_normal();
  }
  return std::nullopt;
}

std::vector<fs::path> files_in(const std::string& folder) {
  std::vector<fs::path> files;
  for (auto entry = fs::recursive_directory_iterator(root / folder);
       entry != fs::recursive_directory_iterator(); ++entry) {
    const fs::path name = entry->path().filename();
    if (name == "node_modules" || name == "__pycache__") entry.disable_recursion_pending();
    if (entry->is_regular_file()) files.push_back(fs::relative(entry->path(), root));
  }
  return files;
}

std::vector<fs::path> files_in(const std::string& folder, const std::set<std::string>& extensions) {
  std::vector<fs::path> files = files_in(folder);
  std::erase_if(files, [&](const fs::path& file) { return !extensions.contains(file.extension()); });
  return files;
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::vector<std::string> lines;
  std::ifstream stream(root / file);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Layers, EveryIncludePointsDownwards) {
  const std::regex include(R"re(\s*#\s*include\s*(["<])([^">]+)[">].*)re");
  std::size_t checked = 0;
  std::set<std::string> folders = strategy_folders;
  folders.insert("plugins");
  for (const auto& [layer, below] : layers_below) folders.insert(layer);
  for (const std::string& folder : folders) {
    for (const fs::path& file : files_in(folder, {".cpp", ".hpp"})) {
      for (const std::string& line : lines_of(file)) {
        std::smatch found;
        if (!std::regex_match(line, found, include)) continue;
        const auto included = resolved(file, found[2]);
        EXPECT_TRUE(included || found[1] == "<") << file << " includes what is nowhere: " << found[2];
        if (!included) continue;
        ++checked;
        EXPECT_EQ(fault_of(file, *included), "") << file << " includes " << *included;
      }
    }
  }
  EXPECT_GT(checked, 500U);
}

TEST(Layers, TheCheckFindsWhatPointsUpwards) {
  const std::string strategy = "strategies include only the framework's public headers and their own folder";
  const std::string family = "a family of matchers includes only itself and what all share";
  for (const auto& [file, included, fault] : {
           std::array<std::string, 3>{"framework/src/error.cpp", "framework/include/glocal/error.hpp", ""},
           {"framework/src/error.cpp", "evaluation/include/glocal/outcome.hpp",
            "framework lies below evaluation"},
           {"framework/include/glocal/points.hpp", "raters/softmax.hpp", "framework lies below raters"},
           {"evaluation/results/summary.cpp", "framework/src/config/reader.hpp", ""},
           {"evaluation/results/summary.cpp", "report/page.hpp", "evaluation lies below report"},
           {"evaluation/results/summary.cpp", "matchers/mcl/mcl.hpp", "evaluation lies below matchers"},
           {"report/page.cpp", "app/commands.hpp", "report lies below app"},
           {"app/run.cpp", "report/page.hpp", ""},
           {"app/run.cpp", "matchers/mcl/mcl.hpp", ""},
           {"raters/softmax.cpp", "framework/include/glocal/rng.hpp", ""},
           {"raters/softmax.cpp", "raters/normalise.hpp", ""},
           {"raters/softmax.cpp", "framework/src/config/reader.hpp", strategy},
           {"raters/softmax.cpp", "evaluation/include/glocal/outcome.hpp", strategy},
           {"raters/softmax.cpp", "clustering/dbscan.hpp", strategy},
           {"raters/softmax.cpp", "matchers/common/merge.hpp", strategy},
           {"verifiers/whole_map.cpp", "matchers/box_search/search_boxes.hpp", ""},
           {"verifiers/whole_map.cpp", "matchers/mcl/mcl.hpp", strategy},
           {"plugins/pcl/icp.cpp", "plugins/pcl/clouds.hpp", ""},
           {"plugins/pcl/icp.cpp", "plugins/octomap/tree_file.hpp", strategy},
           {"plugins/pcl/plugin.cpp", "plugins/common/feature_matcher.hpp", ""},
           {"plugins/common/feature_matcher.hpp", "plugins/pcl/clouds.hpp", strategy},
           {"matchers/register.cpp", "matchers/mcl/mcl.hpp", ""},
           {"matchers/mcl/mcl.cpp", "matchers/common/merge.hpp", ""},
           {"matchers/mcl/mcl.cpp", "matchers/ransam/ransam.hpp", family},
           {"matchers/mcl/mcl.cpp", "matchers/surfels/surfels.hpp", ""},
           {"matchers/common/merge.cpp", "matchers/ransam/ransam.hpp", family},
           {"matchers/surfels/surfels.cpp", "matchers/ransam/ransam.hpp", family},
           {"matchers/indexed_ransam/indexed_ransam.cpp", "matchers/grid_search/exhaustive.hpp", family},
           {"matchers/indexed_ransam/indexed_ransam.cpp", "matchers/box_search/search_boxes.hpp", ""},
       }) {
    EXPECT_EQ(fault_of(file, included), fault) << file << " includes " << included;
  }
  EXPECT_EQ(resolved("app/main.cpp", "glocal/error.hpp"), "framework/include/glocal/error.hpp");
  EXPECT_EQ(resolved("plugins/pcl/icp.cpp", "clouds.hpp"), "plugins/pcl/clouds.hpp");
  EXPECT_EQ(resolved("app/main.cpp", "no_such_file.hpp"), std::nullopt);
}

/// What a file brought reaches a terminal only as what can be printed.
TEST(Layers, TheProgramPrintsInOnePlace) {
  const std::regex prints(
      R"(fmt::print|fmt::println|std::(cout|cerr|clog)|\b(printf|puts|fputs|fwrite|fprintf|putchar)\()");
  std::size_t found_in_its_place = 0;
  for (const fs::path& file : files_in("app", {".cpp", ".hpp"})) {
    for (const std::string& line : lines_of(file)) {
      if (!std::regex_search(line, prints)) continue;
      const bool is_the_place = file == "app/standard_streams.cpp";
      found_in_its_place += is_the_place ? 1 : 0;
      EXPECT_TRUE(is_the_place) << file << ": " << line << "\nanswer() and say() print, and spdlog by them";
    }
  }
  EXPECT_GT(found_in_its_place, 2U);
  // Libraries print nothing.
  for (const std::string folder : {"framework", "sources", "local_mappers", "matchers", "clustering",
                                   "raters", "verifiers", "evaluation", "report"}) {
    for (const fs::path& file : files_in(folder, {".cpp", ".hpp"})) {
      for (const std::string& line : lines_of(file))
        EXPECT_FALSE(std::regex_search(line, prints)) << file << ": " << line;
    }
  }
}

/// What every strategy rests on must stay the smaller part of glocal.
TEST(Layers, TheFrameworkIsAtMostAThirdOfTheCode) {
  const std::set<std::string> code = {".cpp", ".hpp", ".ts", ".py", ".in", ".mjs", ".css"};
  std::size_t all = 0;
  std::size_t framework = 0;
  for (const char* folder :
       {"app", "bench", "clustering", "cmake", "evaluation", "examples", "framework", "local_mappers",
        "matchers", "plugins", "raters", "report", "scripts", "sources", "verifiers"}) {
    for (const fs::path& file : files_in(folder, code)) {
      const std::size_t lines = lines_of(file).size();
      all += lines;
      framework += folder == std::string("framework") ? lines : 0;
    }
  }
  const double share = static_cast<double>(framework) / static_cast<double>(all);
  fmt::print("framework: {} of {} lines of code outside of tests, {:.1f} %\n", framework, all, 100.0 * share);
  EXPECT_GT(framework, 1000U);
  EXPECT_LE(share, 1.0 / 3.0);
}

/// Whether a file is explained elsewhere: data, and tests in folders that mirror those of the sources.
bool needs_no_readme(const fs::path& file) {
  const fs::path folder = file.parent_path();
  if (folder == "bench/results" || folder == "docs/images" || folder.parent_path() == "tests/fuzz/corpus")
    return true;
  const std::string mirrored = folder_at(file, 0) == "tests" ? folder_at(file, 1) : "";
  return !mirrored.empty() && fs::exists(root / mirrored);
}

TEST(Layers, AFolderOfManyFilesBeginsWithAReadme) {
  std::set<std::string> folders = {"bench",    "cmake",   "configs", "docs",
                                   "examples", "plugins", "scripts", "tests"};
  folders.insert(strategy_folders.begin(), strategy_folders.end());
  for (const auto& [layer, below] : layers_below) folders.insert(layer);
  std::map<fs::path, std::size_t> files;
  for (const std::string& folder : folders) {
    for (const fs::path& file : files_in(folder)) files[file.parent_path()] += needs_no_readme(file) ? 0 : 1;
  }
  std::size_t checked = 0;
  for (const auto& [folder, count] : files) {
    if (count <= 5) continue;
    ++checked;
    EXPECT_TRUE(fs::exists(root / folder / "README.md"))
        << folder << " has " << count << " files: say what lives there, and what to read first";
  }
  EXPECT_GT(checked, 40U);
}

}  // namespace
}  // namespace glocal::test::layers_test
