// Damaged results, read by every command that reads results.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <vector>

#include "app/room.hpp"
#include "evaluation/results/file_io.hpp"
#include "glocal/builtin.hpp"
#include "glocal/run_experiment.hpp"

namespace glocal::test::damaged_results_test {
namespace {

using testing::ContainsRegex;
using testing::HasSubstr;

struct Damage {
  std::string name;
  std::function<void(const fs::path& folder)> inflict;
  std::string fault;  ///< Regular expression: file, line and rule.
};

void write(const fs::path& file, const std::string& text) {
  std::ofstream(file) << text;
}

/// Keeps a share of the file.
std::function<void(const fs::path&)> cut(const char* name, double share) {
  return [=](const fs::path& folder) {
    const auto bytes = static_cast<double>(fs::file_size(folder / name));
    fs::resize_file(folder / name, static_cast<std::uintmax_t>(share * bytes));
  };
}

std::function<void(const fs::path&)> cut_bytes(const char* name, std::size_t bytes) {
  return
      [=](const fs::path& folder) { fs::resize_file(folder / name, fs::file_size(folder / name) - bytes); };
}

std::function<void(const fs::path&)> without_last_line(const char* name) {
  return [=](const fs::path& folder) {
    const std::string text = content_of(folder / name);
    write(folder / name, text.substr(0, text.rfind('\n', text.size() - 2) + 1));
  };
}

std::function<void(const fs::path&)> renamed(const char* name, const std::string& from,
                                             const std::string& to) {
  return [=](const fs::path& folder) {
    std::string text = content_of(folder / name);
    const std::size_t at = text.find(from);
    ASSERT_NE(at, std::string::npos) << from;
    write(folder / name, text.replace(at, from.size(), to));
  };
}

std::vector<Damage> damages() {
  const auto removed = [](const char* name) {
    return [=](const fs::path& folder) { fs::remove(folder / name); };
  };
  std::vector<Damage> all;
  for (const char* name : {"trials.jsonl", "steps.jsonl"}) {
    const std::string file = fmt::format("a/{}:[0-9]+: error: ", name);
    all.push_back(
        {fmt::format("{}, last line cut", name), cut_bytes(name, 10), file + "is no line of results"});
    all.push_back(
        {fmt::format("{}, last line gone", name), without_last_line(name), file + "ends here with"});
    all.push_back(
        {fmt::format("{}, half", name), cut(name, 0.5), file + "(is no line of results|ends here with)"});
    all.push_back({fmt::format("{}, empty", name), cut(name, 0.0), file + "ends here with 0"});
    all.push_back(
        {fmt::format("{}, gone", name), removed(name), fmt::format("a/{}: error: cannot be read", name)});
  }
  for (const char* name : {"summary.json", "provenance.json"}) {
    const std::string file = fmt::format("a/{}:[0-9]+: error: is not as glocal run leaves it", name);
    all.push_back({fmt::format("{}, half", name), cut(name, 0.5), file});
    all.push_back({fmt::format("{}, empty", name), cut(name, 0.0), file});
    all.push_back(
        {fmt::format("{}, gone", name), removed(name), fmt::format("a/{}: error: cannot be read", name)});
  }
  for (const double share : {0.0, 0.3, 0.6, 0.97}) {
    all.push_back({fmt::format("effective.yaml, {}", share), cut("effective.yaml", share),
                   "a/effective.yaml:[0-9]+:[0-9:]* error: "});
  }
  all.push_back({"effective.yaml, last line gone", without_last_line("effective.yaml"),
                 "a/effective.yaml:[0-9]+: error: is cut off"});
  all.push_back(
      {"effective.yaml, gone", removed("effective.yaml"), "a/effective.yaml: error: cannot be read"});
  const std::string again = "now\\); run the experiment again with this version";
  all.push_back({"old key of steps", renamed("steps.jsonl", "\"proposals\"", "\"collisions\""),
                 "a/steps.jsonl:1: error: .*'collisions' is called 'proposals' " + again});
  all.push_back({"old key of steps", renamed("steps.jsonl", "\"points_tested\"", "\"checks\""),
                 "a/steps.jsonl:1: error: .*'checks' is called 'points_tested' " + again});
  all.push_back({"old key of steps",
                 renamed("steps.jsonl", "\"hypotheses\"", "\"evidence\":{\"conflict\":0.5},\"hypotheses\""),
                 "a/steps.jsonl:1: error: .*'conflict' is called 'free_space_violation' " + again});
  return all;
}

class DamagedResults : public Room {
 protected:
  /// All commands that read results, on folder a; b is whole.
  [[nodiscard]] std::vector<std::string> commands() const {
    const std::string a = file("a");
    return {"compare " + a + " " + file("b"),
            "report " + a + " -o " + file("report.html") + " --force",
            "figures " + a + " -o " + file("figures") + " --python true",
            "explain " + a + " --trial 0 --step 0",
            "reliability " + a,
            "summarize " + a};
  }

  void expect_all(int exit_code, const std::string& why) const {
    for (const std::string& command : commands()) {
      const Answer answer = run(command);
      EXPECT_EQ(answer.exit_code, exit_code) << why << ": " << command << "\n" << answer.err;
    }
  }
};

TEST_F(DamagedResults, AreRefusedByEveryCommandWithFileAndLine) {
  good(run_room("whole"));
  fs::copy("whole", "b", fs::copy_options::recursive);
  fs::copy("whole", "a", fs::copy_options::recursive);
  expect_all(0, "whole");
  for (const Damage& damage : damages()) {
    fs::remove_all("a");
    fs::copy("whole", "a", fs::copy_options::recursive);
    damage.inflict("a");
    for (const std::string& command : commands()) {
      const Answer answer = run(command);
      // It reads of steps what they took, whatever their other keys are called.
      if (damage.name == "old key of steps" && command.starts_with("compare ")) {
        EXPECT_EQ(answer.exit_code, 0) << command << "\n" << answer.err;
        continue;
      }
      EXPECT_EQ(answer.exit_code, 2) << damage.name << ": " << command;
      EXPECT_EQ(answer.out, "") << damage.name << ": " << command;
      EXPECT_THAT(answer.err, ContainsRegex(damage.fault)) << damage.name << ": " << command;
    }
  }
}

TEST_F(DamagedResults, OfAnInterruptedRunAreResults) {
  Catalog catalog;
  register_builtin_strategies(catalog);
  for (const char* folder : {"a", "b"}) {
    std::size_t finished = 0;
    RunObserver observer;
    observer.trial = [&](const TrialEnd&) { ++finished; };
    observer.stop = [&] { return finished == 2; };
    const RunResult result = run_experiment("room.yaml", {}, catalog, {.out = folder}, observer);
    EXPECT_FALSE(result.complete);
    ASSERT_EQ(json(std::string(folder) + "/summary.json")["trials"]["count"], 2);
  }
  expect_all(0, "interrupted");
}

TEST_F(DamagedResults, AreNotKeptByALaterRun) {
  write_experiment("trials: {every_scan: 9, max_steps: 3}\n",
                   "variants: {list: {one: {}, two: {seed: 2}}}\n");
  good(run_room("all"));
  cut("summary.json", 0.5)("all/one");
  without_last_line("steps.jsonl")("all/two");
  const std::string refused = refusal(run_room("all"));
  EXPECT_THAT(refused, ContainsRegex("all/one/summary.json:[0-9]+: error: is not as glocal run leaves it"));
  EXPECT_THAT(refused, ContainsRegex("all/two/steps.jsonl:[0-9]+: error: ends here with"));
  EXPECT_THAT(refused, HasSubstr("2 errors"));
  good(run_room("all", "--quiet --force"));
  good(run("summarize all"));
  cut("provenance.json", 0.5)("all/one");
  EXPECT_THAT(refusal(run_room("all")), HasSubstr("its provenance.json is damaged"));
}

}  // namespace
}  // namespace glocal::test::damaged_results_test
