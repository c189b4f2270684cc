// What the documentation says holds: links lead somewhere, named functions exist, commands run, examples are
// accepted.
#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "app/program.hpp"
#include "glocal/catalog.hpp"
#include "raters/share_of_best.hpp"

namespace glocal::test::docs_test {
namespace {

namespace fs = std::filesystem;

const fs::path root = GLOCAL_SOURCE_DIR;

/// A fenced block of a document.
struct Block {
  std::string language;
  std::string text;
};

std::string read(const fs::path& file) {
  std::ostringstream text;
  text << std::ifstream(file).rdbuf();
  return text.str();
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

std::vector<fs::path> documents() {
  std::vector<fs::path> files = {root / "README.md", root / "CONTRIBUTING.md", root / "CHANGELOG.md"};
  for (const auto& entry : fs::directory_iterator(root / "docs")) {
    if (entry.path().extension() == ".md") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// All that is written here, not built.
std::vector<fs::path> files_of_project() {
  std::vector<fs::path> files;
  for (auto at = fs::recursive_directory_iterator(root); at != fs::recursive_directory_iterator(); ++at) {
    const std::string name = at->path().filename();
    if (at->is_directory() && (name.starts_with(".") || name == "build" || name == "node_modules"))
      at.disable_recursion_pending();
    if (at->is_regular_file()) files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

/// What says what lives in a folder.
std::vector<fs::path> readmes_of_folders() {
  std::vector<fs::path> files = files_of_project();
  std::erase_if(files, [](const fs::path& file) {
    return file.filename() != "README.md" || file.parent_path() == root ||
           file.parent_path() == root / "docs";
  });
  return files;
}

std::vector<fs::path> documents_and_readmes() {
  std::vector<fs::path> files = documents();
  for (const fs::path& readme : readmes_of_folders()) files.push_back(readme);
  return files;
}

std::vector<Block> blocks_of(const fs::path& document, const std::string& language) {
  std::vector<Block> blocks;
  bool open = false;
  for (const std::string& line : lines_of(read(document))) {
    if (line.starts_with("```")) {
      open = !open;
      if (open) blocks.push_back({line.substr(3), ""});
    } else if (open) {
      blocks.back().text += line + "\n";
    }
  }
  EXPECT_FALSE(open) << document << ": a fenced block is not closed";
  std::erase_if(blocks, [&](const Block& b) { return b.language != language; });
  return blocks;
}

std::vector<std::smatch> matches(const std::string& text, const std::string& pattern) {
  const std::regex regex(pattern);
  return {std::sregex_iterator(text.begin(), text.end(), regex), {}};
}

bool has_data_sets() {
  const char* folder = std::getenv("GLOCAL_DATASETS");
  return folder != nullptr && *folder != '\0';
}

TEST(Docs, LinksLeadToFiles) {
  std::size_t links = 0;
  for (const fs::path& document : documents_and_readmes()) {
    const std::string text = read(document);
    for (const std::smatch& match : matches(text, R"(\]\(([^)#]+)(#[^)]*)?\))")) {
      const std::string target = match[1];
      if (target.find("://") != std::string::npos) continue;
      ++links;
      EXPECT_TRUE(fs::exists(document.parent_path() / target)) << document << " links to " << target;
    }
  }
  EXPECT_GT(links, 0U);
}

/// A heading as GitHub names it in links: the second of two alike has "-1" at its end.
std::set<std::string> anchors_of(const fs::path& document) {
  std::set<std::string> anchors;
  std::map<std::string, int> seen;
  bool in_block = false;
  for (const std::string& line : lines_of(read(document))) {
    if (line.starts_with("```")) in_block = !in_block;
    if (in_block || !line.starts_with("#")) continue;
    const std::string heading = std::regex_replace(line, std::regex("^#+ |–|…|’"), "");
    std::string name;
    for (const char c : heading) {
      const auto byte = static_cast<unsigned char>(c);
      if (c == ' ' || c == '-') name += '-';
      if (std::isalnum(byte) != 0 || c == '_' || byte >= 0x80)
        name += static_cast<char>(byte < 0x80 ? std::tolower(byte) : byte);
    }
    const int before = seen[name]++;
    anchors.insert(before > 0 ? name + "-" + std::to_string(before) : name);
  }
  return anchors;
}

TEST(Docs, LinksLeadToHeadings) {
  std::map<fs::path, std::set<std::string>> known;
  std::size_t links = 0;
  for (const fs::path& document : documents_and_readmes()) {
    const std::string text = read(document);
    for (const std::smatch& match : matches(text, R"(\]\(([^)#:]*)#([^)]+)\))")) {
      const fs::path target = match[1].length() == 0 ? document : document.parent_path() / match[1].str();
      if (target.extension() != ".md") continue;
      if (!known.contains(target)) known[target] = anchors_of(target);
      ++links;
      EXPECT_TRUE(known[target].contains(match[2])) << document << " links to " << match[0];
    }
  }
  EXPECT_GT(links, 100U);
}

TEST(Docs, NamedFunctionsExist) {
  for (const fs::path& document : documents()) {
    const std::string text = read(document);
    for (const std::smatch& match : matches(text, R"(`([a-z_0-9/]+\.[ch]pp):([A-Za-z_:]+)`)")) {
      const fs::path source = root / match[1].str();
      const std::string function = match[2];
      ASSERT_TRUE(fs::exists(source)) << document << " names " << source;
      EXPECT_TRUE(std::regex_search(read(source), std::regex("\\b" + function + "\\(")))
          << document << " names " << function << " in " << source;
    }
  }
}

TEST(Docs, FilesThatReadmesOfFoldersNameExist) {
  std::set<std::string> names;
  for (const fs::path& file : files_of_project()) names.insert(file.filename());
  std::size_t named = 0;
  for (const fs::path& readme : readmes_of_folders()) {
    const std::string text = read(readme);
    for (const std::smatch& match : matches(text, R"(`(?:[a-z_0-9/]+/)?([a-z_0-9-]+\.[ch]pp)[`:])")) {
      ++named;
      EXPECT_TRUE(names.contains(match[1])) << readme << " names " << match[1];
    }
  }
  EXPECT_GT(named, 100U);
}

TEST(Docs, ScriptsAndTheirOptionsExist) {
  std::size_t scripts = 0;
  for (const fs::path& document : documents()) {
    for (const Block& block : blocks_of(document, "sh")) {
      for (const std::string& line : lines_of(block.text)) {
        if (!line.starts_with("scripts/")) continue;
        ++scripts;
        std::istringstream words(line.substr(0, line.find(" #")));
        std::string script;
        words >> script;
        ASSERT_TRUE(fs::exists(root / script)) << document << " calls " << script;
        const std::string text = read(root / script);
        for (std::string word; words >> word;) {
          if (!word.starts_with("--")) continue;
          EXPECT_NE(text.find(word), std::string::npos) << document << ": " << script << " has no " << word;
        }
      }
    }
  }
  EXPECT_GT(scripts, 1U);
}

TEST(Docs, EveryEquationHasItsFunction) {
  const std::string text = read(root / "docs/method.md");
  for (int equation = 1; equation <= 10; ++equation) {
    const std::string row = "\\n\\| " + std::to_string(equation) + R"( \|[^\n]*`[a-z_0-9/]+\.[ch]pp:[^\n]*)";
    EXPECT_TRUE(std::regex_search(text, std::regex(row))) << "equation " << equation;
  }
}

/// Examples and commands of documents. The test's folder has a copy of configs/ and an empty docs/.
class DocsExamples : public CommandLine {
 protected:
  DocsExamples() { go_to(folder_.path()); }

  /// Works in this folder from now on; it is made for that.
  static void go_to(const fs::path& folder) {
    fs::create_directories(folder / "docs");
    fs::copy(root / "configs", folder / "configs", fs::copy_options::recursive);
    fs::current_path(folder);
  }

  /// Saves the YAML examples that begin with a comment naming their file. Returns the names of experiments.
  static std::vector<std::string> save_examples(const fs::path& document) {
    std::vector<std::string> experiments;
    for (const Block& block : blocks_of(document, "yaml")) {
      std::smatch name;
      const bool named = std::regex_search(block.text, name, std::regex(R"(^# (configs/\S+\.yaml))"));
      const bool experiment = block.text.find("schema: 1\n") != std::string::npos;
      EXPECT_TRUE(named || !experiment) << document << ": an experiment does not say its file:\n"
                                        << block.text;
      if (!named) continue;
      std::ofstream(name[1].str()) << block.text;
      if (experiment) experiments.push_back(name[1]);
    }
    return experiments;
  }

  /// The lines of the document's shell blocks that call the program, without its name and without comments.
  static std::vector<std::string> commands_of(const fs::path& document) {
    std::vector<std::string> commands;
    for (const Block& block : blocks_of(document, "sh")) {
      for (const std::string& line : lines_of(block.text)) {
        if (line.starts_with("glocal ")) commands.push_back(line.substr(7, line.find(" #") - 7));
      }
    }
    return commands;
  }

  /// The words of a command that match, apart from options.
  static std::vector<std::string> words_like(const std::string& command, const std::string& pattern) {
    std::vector<std::string> words;
    for (const std::smatch& match : matches(command, R"((?:^|\s)()" + pattern + R"()(?=\s|$))"))
      words.push_back(match[1]);
    return words;
  }

  /// A command as it is tried out. Runs are restricted where they would take minutes, and draw no progress;
  /// how far local maps drift is not measured, only the experiments are checked.
  static std::string tried(const std::string& command) {
    if (command.starts_with("mapping ")) {
      std::string check = "check";
      for (const std::string& word : words_like(command, R"(--(?:set|method|case) \S+|\S+\.yaml)"))
        check += " " + word;
      return check;
    }
    if (command.starts_with("run ")) {
      // Thirteen variants on 42 starts, a sweep of 48 runs, and a thousand single scans on a large map: fewer
      // steps and starts do.
      if (command.find("/intel_variants.yaml") != std::string::npos)
        return command + " --quiet --set trials.max_steps=1 --set trials.every_m=50";
      if (command.find("/sim_sweep.yaml") != std::string::npos)
        return command + " --quiet --set trials.every_m=25";
      if (command.find("--case willow_single") != std::string::npos)
        return command + " --quiet --set trials.every_scan=100";
      return command + " --quiet";
    }
    if (command.starts_with("figures ") && !has_matplotlib()) return command + " --python true";
    return command;
  }

  static bool has_matplotlib() {
    return std::system(
               "python3 -c 'import matplotlib' 2>/dev/null || "
               "/usr/bin/python3 -c 'import matplotlib' 2>/dev/null") == 0;
  }

  static bool needs_data_sets(const std::string& command) {
    if (command.find("$GLOCAL_DATASETS") != std::string::npos) return true;
    std::vector<std::string> experiments = words_like(command, R"(\S+\.yaml)");
    // results/NAME is where the experiment of that name leaves its results.
    for (const std::string& folder : words_like(command, R"(results/\w+)"))
      experiments.push_back("configs/experiments/" + folder.substr(8) + ".yaml");
    for (const std::string& option : words_like(command, R"(--case \w+)"))
      experiments.push_back("configs/cases/" + option.substr(7) + ".yaml");
    return std::any_of(experiments.begin(), experiments.end(), names_data_sets);
  }

  /// Whether this file names some, or one that it takes its case from.
  static bool names_data_sets(const std::string& file) {
    if (!fs::exists(file)) return false;
    const std::string text = read(file);
    if (text.find("\"data:") != std::string::npos) return true;
    const std::vector<std::smatch> cases = matches(text, R"((?:^|\n)(?:cases|extends): (\w+))");
    return std::any_of(cases.begin(), cases.end(), [](const std::smatch& match) {
      return names_data_sets("configs/cases/" + match[1].str() + ".yaml");
    });
  }

  void expect_success(const std::string& command, const fs::path& document) const {
    const Answer answer = run(command);
    EXPECT_EQ(answer.exit_code, 0) << document << ": glocal " << command << "\n" << answer.err;
  }

  /// Runs the experiments whose results a command reads, where no earlier command of the page has done so.
  void make_results_for(const std::string& command, const fs::path& document) const {
    if (command.starts_with("run ")) return;
    for (const std::string& folder : words_like(command, R"(results/\w+)")) {
      const std::string experiment = "configs/experiments/" + folder.substr(8) + ".yaml";
      if (!fs::exists(folder) && fs::exists(experiment)) expect_success(tried("run " + experiment), document);
    }
  }

  /// The folder that a command leaves its results in, if it says so.
  static std::vector<std::string> outs_of(const std::string& command) {
    std::vector<std::string> folders;
    for (const std::smatch& match : matches(command, R"(--out (results/\S+))")) folders.push_back(match[1]);
    return folders;
  }

  /// Whether a folder is one of these, or holds one of them.
  static bool is_in(const std::string& folder, const std::set<std::string>& folders) {
    return std::any_of(folders.begin(), folders.end(), [&](const std::string& one) {
      return one == folder || one.starts_with(folder + "/");
    });
  }

  /// Tries out the commands of a document that need the data sets, or those that do not: one after the other,
  /// in a folder of its own.
  void try_out(const fs::path& document, bool with_data_sets) const {
    go_to(folder_.path() / "pages" / document.stem());
    std::vector<std::string> commands;
    for (const std::string& experiment : save_examples(document)) commands.push_back("check " + experiment);
    for (const std::string& command : commands_of(document)) commands.push_back(command);
    std::set<std::string> from_data_sets;  // Folders of results.
    for (const std::string& command : commands) {
      bool needs = needs_data_sets(command);
      for (const std::string& folder : words_like(command, R"(results/\S+)"))
        needs = needs || is_in(folder, from_data_sets);
      const std::vector<std::string> outs = outs_of(command);
      if (needs) from_data_sets.insert(outs.begin(), outs.end());
      if (needs != with_data_sets) continue;
      make_results_for(command, document);
      expect_success(tried(command), document);
    }
  }
};

/// Each page by itself.
class DocsPages : public DocsExamples, public testing::WithParamInterface<std::string> {};

TEST_P(DocsPages, CommandsAndExperimentsWork) {
  try_out(root / GetParam(), false);
}

TEST_P(DocsPages, CommandsAndExperimentsWithDataSetsWork) {
  if (!has_data_sets()) GTEST_SKIP() << "GLOCAL_DATASETS is not set";
  try_out(root / GetParam(), true);
}

std::vector<std::string> pages() {
  std::vector<std::string> names;
  for (const fs::path& document : documents()) names.push_back(fs::relative(document, root));
  return names;
}

INSTANTIATE_TEST_SUITE_P(Docs, DocsPages, testing::ValuesIn(pages()), [](const auto& page) {
  return std::regex_replace(page.param, std::regex("[^A-Za-z0-9]"), "_");
});

/// What stands behind `<!-- table: COMMAND -->` is what the command prints.
TEST_F(DocsExamples, TablesAreWhatTheirCommandsPrint) {
  std::size_t tables = 0;
  for (const fs::path& document : documents()) {
    const std::string text = read(document);
    constexpr std::string_view begin = "<!-- table: glocal ", mid = " -->\n", end = "<!-- /table -->";
    for (std::size_t at = text.find(begin); at != std::string::npos;
         at = text.find(begin, at + 1), ++tables) {
      const std::size_t command = at + begin.size();
      const std::size_t table = text.find(mid, command) + mid.size();
      const Answer answer = good(run(text.substr(command, table - mid.size() - command)));
      EXPECT_EQ(text.substr(table, text.find(end, table) - table), answer.out)
          << document << ": scripts/tables writes it anew";
    }
  }
  EXPECT_GT(tables, 0U);
}

/// A table of a document.
struct Table {
  std::size_t line = 0;  ///< Of its head; from 1 on.
  std::string above;     ///< The line before it.
  bool is_made = false;  ///< Whether it stands between `<!-- table: COMMAND -->` and `<!-- /table -->`.
  std::vector<std::string> rows;
};

std::string trimmed(const std::string& text, const char* what) {
  const std::size_t first = text.find_first_not_of(what);
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(what) + 1 - first);
}

std::vector<Table> tables_of(const fs::path& document) {
  std::vector<Table> tables;
  const std::vector<std::string> lines = lines_of(read(document));
  bool in_block = false, is_made = false, in_table = false;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    const std::string line = trimmed(lines[i], " ");
    if (line.starts_with("```")) in_block = !in_block;
    if (line.starts_with("<!-- table: ")) is_made = true;
    if (line == "<!-- /table -->") is_made = false;
    const bool is_row = !in_block && line.starts_with("|");
    if (is_row && !in_table) tables.push_back({i + 1, i > 0 ? lines[i - 1] : "", is_made, {}});
    if (is_row && in_table && !line.starts_with("|--") && !line.starts_with("|:-"))
      tables.back().rows.push_back(line);
    in_table = is_row;
  }
  return tables;
}

/// Whether a cell of the row, apart from the first, begins with a digit.
bool has_number(const std::string& row) {
  std::istringstream cells(std::regex_replace(row, std::regex(R"(\\\|)"), "/"));
  std::string cell;
  for (int i = 0; std::getline(cells, cell, '|'); ++i) {
    const std::string text = trimmed(cell, " *");
    if (i > 1 && !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0) return true;
  }
  return false;
}

bool has_numbers(const Table& table) {
  return 2 * std::count_if(table.rows.begin(), table.rows.end(), has_number) >
         static_cast<std::ptrdiff_t>(table.rows.size());
}

/// Whether a page says of all its tables that nothing makes them any more.
bool is_of_the_past(const fs::path& document) {
  return document.filename() == "tried.md" &&
         read(document).substr(0, 1000).find("cannot be made again") != std::string::npos;
}

class DocsTables : public DocsExamples {
 protected:
  /// Whether a command begins with something that is there. Variables, and what measures, may come first.
  [[nodiscard]] bool is_there(const std::string& written) const {
    const std::regex first(R"(^(\w+=("[^"]*"|\S+) |perf record |strace -f |time (-v )?)+)");
    const std::string command = std::regex_replace(written, first, "");
    const auto begins = [&](const char* pattern) {
      std::smatch match;
      return std::regex_search(command, match, std::regex(pattern)) ? match[1].str() : "";
    };
    if (const std::string script = begins(R"(^(scripts/\w+)( |$|,))"); !script.empty())
      return fs::exists(root / script);
    if (const std::string subcommand = begins(R"(^glocal ([a-z-]+)( |$))"); !subcommand.empty())
      return run(subcommand + " --help").exit_code == 0;
    if (const std::string tests = begins("^build/release/tests/test_([a-z_]+)"); !tests.empty())
      return read(root / "tests/CMakeLists.txt").find("glocal_add_tests(" + tests + " ") != std::string::npos;
    if (const std::string benchmark = begins("^build/release/bench/(bench_[a-z_]+)"); !benchmark.empty())
      return fs::exists(root / "bench" / (benchmark + ".cpp"));
    return command.starts_with("ctest ");
  }
};

TEST_F(DocsTables, NumbersSayHowTheyAreMade) {
  const std::regex marker(R"( *<!-- measured: (.+) \(\d{4}-\d\d-\d\d, [0-9a-f]{7}\) -->)");
  std::size_t measured = 0;
  for (const fs::path& document : documents()) {
    if (is_of_the_past(document)) continue;
    for (const Table& table : tables_of(document)) {
      std::smatch match;
      const bool is_marked = std::regex_match(table.above, match, marker);
      measured += is_marked ? 1 : 0;
      EXPECT_TRUE(is_marked || table.is_made || !has_numbers(table))
          << document.string() << ":" << table.line
          << ": <!-- measured: COMMAND (DATE, REVISION) --> is missing above this table";
      EXPECT_TRUE(!is_marked || is_there(match[1]))
          << document.string() << ":" << table.line << ": there is no " << match[1];
    }
  }
  EXPECT_GT(measured, 20U);
}

/// Every command that reads results is on some page, and is run as it is written there.
TEST(Docs, CommandsThatReadResultsAreShown) {
  std::string text = "\n";
  for (const fs::path& document : documents()) {
    for (const Block& block : blocks_of(document, "sh")) text += block.text;
  }
  EXPECT_GT(matches(text, "\nglocal ").size(), 40U);
  for (const char* command : {"explain", "reliability", "compare", "report", "figures", "summarize", "sweep"})
    EXPECT_NE(text.find(std::string("\nglocal ") + command + " "), std::string::npos) << command;
}

/// All keys of a JSON value, at any depth.
void collect_keys(const nlohmann::json& json, std::set<std::string>& keys) {
  for (const auto& [key, value] : json.items()) {
    if (json.is_object()) keys.insert(key);
    if (value.is_structured()) collect_keys(value, keys);
  }
}

/// Each name is in the document: as a heading, or in code.
void expect_described(const std::set<std::string>& names, const fs::path& document) {
  const std::string text = read(document);
  for (const std::string& name : names) {
    EXPECT_TRUE(std::regex_search(text, std::regex("(`|### )" + name + "(`|/|\n)"))) << name;
  }
}

TEST_F(DocsExamples, WhatARunLeavesIsDescribed) {
  const fs::path document = root / "docs/file-formats.md";
  save_examples(document);
  good(run(
      "run configs/experiments/room.yaml --quiet --out a --set localizer.matcher.ransam.iterations=5000"));
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator("a")) names.insert(entry.path().filename());
  collect_keys(nlohmann::json::parse(read("a/summary.json")), names);
  for (const char* file : {"a/trials.jsonl", "a/steps.jsonl"}) {
    for (const std::string& line : lines_of(read(file))) collect_keys(nlohmann::json::parse(line), names);
  }
  const auto provenance = nlohmann::json::parse(read("a/provenance.json"));
  for (const auto& [key, value] : provenance.items()) names.insert(key);
  EXPECT_GT(names.size(), 40U);
  for (const char* part_of_pose : {"x", "y", "theta"}) names.erase(part_of_pose);
  expect_described(names, document);
}

TEST_F(DocsExamples, WhatCompareWritesIsDescribed) {
  const fs::path document = root / "docs/file-formats.md";
  save_examples(document);
  for (const char* folder : {"a", "b"}) {
    good(run(std::string("run configs/experiments/room.yaml --quiet --set trials.every_scan=5 --set "
                         "trials.whole=false --set trials.max_steps=4 --set "
                         "localizer.matcher.ransam.iterations=5000 --out ") +
             folder));
  }
  good(run("compare a b -o c.json -o c.csv"));
  std::set<std::string> names;
  collect_keys(nlohmann::json::parse(read("c.json")), names);
  std::istringstream columns(lines_of(read("c.csv")).front());
  for (std::string column; std::getline(columns, column, ',');) names.insert(column);
  EXPECT_GT(names.size(), 40U);
  expect_described(names, document);
}

TEST_F(DocsExamples, WhatSweepWritesIsDescribed) {
  const fs::path document = root / "docs/file-formats.md";
  save_examples(document);
  good(
      run("run configs/experiments/room.yaml --quiet --out a --set trials.max_steps=1 --set "
          "trials.whole=false --set trials.every_scan=9 --set output.steps=false --set 'choose_on={near: "
          "{}}' --set 'judge_on={far: {}}' --set 'variants.grid={localizer.matcher.ransam.iterations: [100, "
          "20000], localizer.contact_epsilon: [0.1, 0.2]}'"));
  const Answer answer = good(run("sweep a --json"));
  nlohmann::json json = nlohmann::json::parse(answer.out);
  ASSERT_TRUE(json.contains("chance"));
  for (nlohmann::json& setting : json["settings"]) setting["values"].clear();
  std::set<std::string> names;
  collect_keys(json, names);
  EXPECT_GT(names.size(), 25U);
  expect_described(names, document);
}

/// Of a key of all steps of a run: the median in the first steps of the trials, in their last ones, and the
/// most.
std::vector<double> first_last_and_most(const fs::path& results, const std::string& key) {
  std::vector<double> first, last;
  double most = 0.0;
  for (const std::string& line : lines_of(read(results / "steps.jsonl"))) {
    const auto step = nlohmann::json::parse(line);
    const auto value = step.at(key).get<double>();
    if (step.at("step") == 0) {
      first.push_back(value);
      last.push_back(value);
    }
    last.back() = value;
    most = std::max(most, value);
  }
  const auto median = [](std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return (values.at((values.size() - 1) / 2) + values.at(values.size() / 2)) / 2.0;
  };
  return {median(first), median(last), most};
}

TEST_F(DocsExamples, NumbersToExpectAreThoseOfRuns) {
  const std::string page = read(root / "docs/writing-a-strategy.md");
  const std::vector<std::smatch> rows = matches(page, R"(\n\| `(--method \w+ --case \w+)` \|([^\n]*))");
  ASSERT_EQ(rows.size(), 3U);
  for (const std::smatch& row : rows) {
    const std::string run_options = row[1];
    if (needs_data_sets(run_options) && !has_data_sets()) continue;
    fs::remove_all("numbers");
    good(run("run " + run_options + " --quiet --out numbers --set output.maps=none"));
    fs::path results;
    for (const auto& entry : fs::directory_iterator("numbers")) {
      if (entry.is_directory()) results = entry.path();
    }
    const std::string cells = row[2];
    const std::vector<std::smatch> shown = matches(cells, R"([0-9]+)");
    std::vector<double> measured;
    for (const char* key : {"proposals", "hypotheses", "clusters", "local_map_points"}) {
      for (const double value : first_last_and_most(results, key)) measured.push_back(value);
    }
    ASSERT_EQ(shown.size(), measured.size()) << run_options;
    // Whoever reads them wants to know how many digits they have.
    for (std::size_t i = 0; i < shown.size(); ++i)
      EXPECT_NEAR(std::stod(shown[i].str()), measured[i], 1.0 + 0.3 * measured[i])
          << run_options << ", number " << i;
  }
}

TEST(DocsStrategy, IsShownAsItIsCompiledHere) {
  const fs::path example = root / "tests/docs/example/raters";
  const std::vector<Block> shown = blocks_of(root / "docs/writing-a-strategy.md", "cpp");
  for (const char* file : {"share_of_best.hpp", "share_of_best.cpp"}) {
    const std::string code = read(example / file);
    EXPECT_TRUE(std::any_of(shown.begin(), shown.end(), [&](const Block& b) { return b.text == code; }))
        << file;
  }
  const std::vector<Block> excerpts = blocks_of(root / "README.md", "cpp");
  ASSERT_EQ(excerpts.size(), 1U);
  EXPECT_NE(read(example / "share_of_best.cpp").find(excerpts.front().text), std::string::npos);
}

TEST(DocsStrategy, DoesWhatItSays) {
  Catalog catalog;
  catalog.threshold_policies.add<raters::ShareOfBest>("share_of_best",
                                                      "A share of the last step's best quality.");
  const auto policy = catalog.threshold_policies.make(catalog.threshold_policies.choose("share_of_best"), {});
  EXPECT_DOUBLE_EQ(policy->omega_max(), 0.4);
  policy->update({Hypothesis{.map_from_local = {}, .quality = 1.0, .score = 0.9},
                  Hypothesis{.map_from_local = {}, .quality = 1.0, .score = 0.5}});
  EXPECT_DOUBLE_EQ(policy->omega_max(), 0.8 * 0.9);
  policy->update({});
  EXPECT_DOUBLE_EQ(policy->omega_max(), 0.4);
  policy->update({Hypothesis{.map_from_local = {}, .quality = 1.0, .score = 0.9}});
  policy->reset();
  EXPECT_DOUBLE_EQ(policy->omega_max(), 0.4);
}

}  // namespace
}  // namespace glocal::test::docs_test
