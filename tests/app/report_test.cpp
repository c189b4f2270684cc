// glocal report.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

#include "app/room.hpp"
#include "evaluation/results/pcd.hpp"
#include "report/numbers.hpp"
#include "report/unpacked.hpp"

namespace glocal::test::report_test {
namespace {

using testing::HasSubstr;
using testing::Not;

class ReportCommand : public Room {
 protected:
  /// The data in a page.
  [[nodiscard]] Json data_of(const std::string& name) const { return whole(data_in(content(file(name)))); }

  [[nodiscard]] Answer report(const std::string& folders, const std::string& options = "") const {
    return run("report " + folders + " -o " + file("report.html") + " " + options);
  }

  void expect_refused(const std::string& folders, const std::string& why) const {
    const Answer answer = report(folders);
    EXPECT_EQ(answer.exit_code, 2) << folders;
    EXPECT_EQ(answer.out, "") << folders;
    EXPECT_THAT(answer.err, HasSubstr(why)) << folders;
    EXPECT_FALSE(fs::exists(file("report.html"))) << folders;
  }
};

/// To the five digits that a page has, or to half a unit.
void expect_near(const Json& shown, const Json& exact, const std::string& what, double half_unit = 0.0) {
  ASSERT_TRUE(shown.is_number() && exact.is_number()) << what;
  const auto value = exact.get<double>();
  EXPECT_NEAR(shown.get<double>(), value, half_unit > 0.0 ? half_unit : 5.1e-5 * std::abs(value)) << what;
}

/// Poses are exact to 1 mm and 0.0001 rad.
constexpr double half_millimetre = 0.000501;

void expect_pose(const Json& columns, std::size_t i, const Json& line, const char* pose) {
  for (const char* key : {"x", "y", "theta"}) {
    if (line.contains(pose)) {
      expect_near(columns[pose][key][i], line[pose][key], fmt::format("{} of {}", key, pose),
                  half_millimetre);
    } else {
      EXPECT_TRUE(columns[pose][key][i].is_null());
    }
  }
}

/// One line of steps.jsonl against the columns.
void expect_step(const Json& columns, const Json& line) {
  const std::size_t i = line["step"];
  EXPECT_EQ(columns["step"][i], i);
  double ms = 0.0;
  for (const char* stage : {"local_map", "match", "cluster", "rate"})
    ms += line["stage_ms"][stage].get<double>();
  expect_near(columns["step_ms"][i], ms, "step_ms");
  expect_near(columns["match_ms"][i], line["stage_ms"]["match"], "match_ms");
  for (const char* key : {"local_map_points", "proposals", "hypotheses", "clusters", "verdict"})
    EXPECT_EQ(columns[key][i], line[key]) << key;
  for (const char* key : {"omega_best", "score_best", "omega_max"})
    expect_near(columns[key][i], line[key], key);
  for (const char* key : {"omega_place", "translation_error_m", "rotation_error_deg", "confidence"}) {
    if (line.contains(key)) {
      expect_near(columns[key][i], line[key], key);
    } else {
      EXPECT_TRUE(columns[key][i].is_null()) << key;
    }
  }
  EXPECT_EQ(columns["sentences"][columns["why"][i].get<std::size_t>()], line["why"]);
  for (const char* pose : {"estimate", "reference", "local_from_robot"}) expect_pose(columns, i, line, pose);
  const Json candidates = line.value("candidates", Json::array());
  ASSERT_EQ(columns["candidates"][i].size(), 3 * candidates.size());
  for (std::size_t c = 0; c < candidates.size(); ++c)
    expect_near(columns["candidates"][i][3 * c + 1], candidates[c]["y"], "candidate", half_millimetre);
  const Json evidence = line.value("evidence", Json::object());
  for (const auto& [name, column] : columns["evidence"].items()) {
    if (evidence.contains(name)) {
      expect_near(column[i], evidence[name], name);
    } else {
      EXPECT_TRUE(column[i].is_null()) << name;
    }
  }
  const Json& best = columns["best"];
  const std::size_t first = best["first"][i];
  ASSERT_EQ(best["first"][i + 1].get<std::size_t>() - first, line["best"].size());
  for (std::size_t c = 0; c < line["best"].size(); ++c) {
    const Json& cluster = line["best"][c];
    for (const char* key : {"x", "y", "theta"})
      expect_near(best[key][first + c], cluster["pose"][key], "cluster's pose", half_millimetre);
    EXPECT_EQ(best["size"][first + c], cluster["size"]);
    for (const char* key : {"r", "r_normalised"}) expect_near(best[key][first + c], cluster[key], key);
  }
}

using Millimetres = std::set<std::pair<long, long>>;

Millimetres points_of(const std::string& file) {
  const Points points = read_pcd(file);
  Millimetres rounded;
  for (std::size_t i = 0; i < points.size(); ++i)
    rounded.emplace(std::lround(1000.0 * points.x[i]), std::lround(1000.0 * points.y[i]));
  return rounded;
}

TEST_F(ReportCommand, HasEveryLineMapAndScanOfTheRun) {
  write_experiment("trials: {every_scan: 6, max_steps: 5}\n", "output: {maps: all}\n");
  good(run_room("a"));
  good(run_room("b", "--quiet --set localizer.verdict_rule=staged_margin"));
  const Answer answer = good(report("a b"));
  EXPECT_EQ(answer.out, file("report.html") + "\n");
  const Json data = data_of("report.html");
  EXPECT_EQ(data["maps"].size(), 1U);
  EXPECT_EQ(data["comparison"]["baseline"], "a");
  for (const std::size_t r : {0U, 1U}) {
    const Json& run = data["runs"][r];
    const std::string name = r == 0 ? "a" : "b";
    EXPECT_EQ(run["name"], name);
    EXPECT_EQ(run["summary"], json(name + "/summary.json"));
    EXPECT_EQ(run["provenance"], json(name + "/provenance.json"));
    std::size_t n = 0;
    for (const Json& line : json_lines(file(name + "/trials.jsonl"))) {
      Json trial = run["trials"][n++];
      for (const char* more : {"columns", "local_map", "scans"}) EXPECT_EQ(trial.erase(more), 1U) << more;
      if (line.contains("pose")) {
        EXPECT_EQ(trial["changes"], json(fmt::format("{}/maps/trial_{:04}/changes.json", name, n - 1)));
        trial.erase("changes");
      }
      EXPECT_EQ(trial, with_short_numbers(line, "stamp"));
    }
    EXPECT_EQ(run["trials"].size(), n);
    std::vector<std::size_t> seen(n);
    for (const Json& step : json_lines(file(name + "/steps.jsonl"))) {
      const std::size_t trial = step["trial"];
      expect_step(run["trials"][trial]["columns"], step);
      ++seen[trial];
    }
    for (std::size_t trial = 0; trial < n; ++trial)
      EXPECT_EQ(run["trials"][trial]["columns"]["step"].size(), seen[trial]);
  }

  Millimetres map;
  for (std::size_t i = 0; i < data["maps"][0]["x"].size(); ++i)
    map.emplace(data["maps"][0]["x"][i], data["maps"][0]["y"][i]);
  EXPECT_EQ(map, points_of("a/maps/global.pcd"));
  std::size_t steps = 0;
  for (const Json& trial : data["runs"][0]["trials"]) {
    const Json& lives = trial["local_map"];
    const Json& scans = trial["scans"];
    ASSERT_EQ(lives["steps"], trial["columns"]["step"]);
    ASSERT_EQ(scans["steps"], trial["columns"]["step"]);
    const auto recorded = [&](const char* kind, std::size_t step) {
      return points_of(
          file(fmt::format("a/maps/trial_{:04}/{}_{:04}.pcd", trial["trial"].get<int>(), kind, step)));
    };
    for (std::size_t step = 0; step < lives["steps"].size(); ++step, ++steps) {
      Millimetres there, hits;
      for (std::size_t i = 0; i < lives["x"].size(); ++i) {
        if (lives["from"][i] <= step && step < lives["to"][i]) there.emplace(lives["x"][i], lives["y"][i]);
      }
      EXPECT_EQ(there, recorded("step", step));
      for (std::size_t i = scans["first"][step]; i < scans["first"][step + 1]; ++i)
        hits.emplace(scans["x"][i], scans["y"][i]);
      EXPECT_EQ(hits, recorded("scan", step));
    }
  }
  EXPECT_GT(steps, 10U);
}

TEST_F(ReportCommand, TakesFoldersOfRunsAndNamesWhatever) {
  write_experiment("trials: {every_scan: 12, max_steps: 3}\n");
  const std::string name = "a<b & \xff";
  good(run("run room.yaml --quiet --out 'all/" + name + "'"));
  good(run_room("all/plain"));
  good(report("all", "--baseline plain --clusters 2"));
  const Json data = data_of("report.html");
  EXPECT_EQ(data["runs"][0]["name"], "a<b & \xef\xbf\xbd");
  EXPECT_EQ(data["comparison"]["baseline"], "plain");
  EXPECT_THAT(content("report.html"), HasSubstr("<title>a&lt;b &amp; \xef\xbf\xbd, plain</title>"));
  for (const Json& trial : data["runs"][1]["trials"])
    EXPECT_LE(trial["columns"]["best"]["x"].size(), 2 * trial["columns"]["step"].size());
}

TEST_F(ReportCommand, RefusesWhatItCannotShowInOneGo) {
  good(run_room("a"));
  good(run_room("b"));
  expect_refused("missing", "is no folder");
  expect_refused("a a/../a", "is named twice");
  expect_refused("a b --baseline c", "names none, or more than one, of the methods");
  expect_refused("a --clusters=-1", "-1");
  fs::resize_file("a/steps.jsonl", fs::file_size("a/steps.jsonl") - 100);
  fs::remove("b/summary.json");
  const std::string both = "a b";
  expect_refused(both, "a/steps.jsonl:");
  expect_refused(both, "b/summary.json: error: cannot be read");
  expect_refused(both, "2 errors");
}

TEST_F(ReportCommand, ReplacesAFileOnlyByForce) {
  good(run_room("a"));
  std::ofstream("report.html") << "mine";
  EXPECT_THAT(refusal(report("a")), HasSubstr("--force"));
  EXPECT_EQ(content("report.html"), "mine");
  good(report("a", "--force"));
  EXPECT_THAT(content("report.html"), Not(HasSubstr("mine")));
}

TEST_F(ReportCommand, IsSmallForAWholeDrive) {
  const std::string experiment = GLOCAL_SOURCE_DIR "/configs/experiments/paper_simulation.yaml";
  good(run("run " + experiment + " --quiet --set localizer.matcher.ransam.iterations=20000 --out a"));
  good(report("a"));
  const Json data = data_of("report.html");
  const Json& trial = data["runs"][0]["trials"][0];
  EXPECT_EQ(trial["local_map"]["steps"].size(), 136U);
  EXPECT_EQ(trial["scans"]["steps"].size(), 136U);
  EXPECT_LT(fs::file_size("report.html"), 3'000'000U);
}

}  // namespace
}  // namespace glocal::test::report_test
