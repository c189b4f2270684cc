// A small experiment, and what its runs leave.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/program.hpp"

namespace glocal::test {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The lines of a file, each a value.
inline std::vector<Json> json_lines(const fs::path& file) {
  std::vector<Json> all;
  std::ifstream lines(file);
  for (std::string line; std::getline(lines, line);) all.push_back(Json::parse(line));
  return all;
}

/// Times are all that may differ between two runs of the same experiment.
inline Json without_times(Json json) {
  for (const char* key : {"stage_ms", "stage_cpu_ms", "step_ms", "answer_ms", "peak_rss_mb", "others_load"})
    json.erase(key);
  if (json.contains("map")) {
    json["map"].erase("build_ms");
    json["map"].erase("index_ms");
    if (json["map"].contains("index")) json["map"]["index"].erase("build_ms");
  }
  return json;
}

class Room : public CommandLine {
 protected:
  Room() {
    write_world();
    write_experiment("trials: {every_scan: 6, max_steps: 5}\n");
  }

  /// The same again when it is turned by 180 degrees about (6, 3).
  void write_symmetric_world() const {
    folder_.write("world.yaml",
                  "size: [12, 6]\n"
                  "walls:\n"
                  "  - {points: [[0, 0], [12, 0], [12, 6], [0, 6]], closed: true}\n"
                  "  - {points: [[4, 0], [4, 2]]}\n"
                  "  - {points: [[8, 6], [8, 4]]}\n"
                  "free_from: [[1, 1]]\n"
                  "way_points: [[2, 3], [10, 3], [10, 1.5]]\n");
  }

  /// `more` are further keys of the experiment.
  void write_experiment(const std::string& trials, const std::string& more = "") const {
    std::ofstream(file("room.yaml")) << "schema: 1\n"
                                        "name: room\n"
                                        "map: {simulation: {world: world.yaml}}\n"
                                        "observations: {simulation: {world: world.yaml}}\n"
                                     << trials << "localizer: {matcher: {ransam: {iterations: 20000}}}\n"
                                     << more;
  }

  [[nodiscard]] Answer run_room(const std::string& out, const std::string& options = "--quiet") const {
    return run("run " + file("room.yaml") + " " + options + " --out " + file(out));
  }

  [[nodiscard]] Json json(const std::string& name) const { return Json::parse(content(file(name))); }

  /// All lines, without their times.
  [[nodiscard]] std::string lines(const std::string& name) const {
    std::string text;
    for (const Json& line : json_lines(file(name))) text += without_times(line).dump() + "\n";
    return text;
  }

  /// What the journals of a folder have of finished trials: the rest of each line, by the trial's identity.
  [[nodiscard]] std::multimap<std::string, std::string> finished_trials(const std::string& journals) const {
    std::multimap<std::string, std::string> trials;
    std::error_code none;
    for (const auto& journal : fs::directory_iterator(file(journals), none)) {
      if (journal.path().extension() == ".index") continue;
      std::ifstream in(journal.path());
      for (std::string line; std::getline(in, line);) {
        // Half a line at the end does not count.
        if (!in.eof() && line.find(" trial ") == 8) trials.emplace(line.substr(15, 32), line.substr(48));
      }
    }
    return trials;
  }

  void expect_same_results(const std::string& a, const std::string& b) const {
    EXPECT_EQ(lines(a + "/steps.jsonl"), lines(b + "/steps.jsonl"));
    EXPECT_EQ(content(file(a + "/trials.jsonl")), content(file(b + "/trials.jsonl")));
    EXPECT_EQ(without_times(json(a + "/summary.json")), without_times(json(b + "/summary.json")));
    for (const char* folder : {"/trajectories", "/maps"}) {
      std::size_t files = 0;
      for (const auto& entry : fs::recursive_directory_iterator(file(a) + folder)) {
        if (!entry.is_regular_file()) continue;
        const fs::path other = fs::path(file(b)) / fs::relative(entry.path(), file(a));
        EXPECT_EQ(content(entry.path()), content(other)) << other;
        ++files;
      }
      EXPECT_GT(files, 0U) << folder;
    }
  }
};

}  // namespace glocal::test
