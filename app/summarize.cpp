// glocal summarize: what runs have come to, a row for each.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/number_text.hpp"
#include "evaluation/results/stored_figures.hpp"
#include "evaluation/results/summary_text.hpp"

namespace glocal::app {
namespace {

using Json = nlohmann::ordered_json;

struct SummarizeOptions {
  std::vector<std::string> folders;
  std::string name;
  std::string steps;
  bool pool = false;
  bool json = false;
  bool no_head = false;
};

/// The trials of a row: of one run, or of several.
struct Row {
  std::string name;
  std::vector<std::string> folders = {};
  bool complete = true;
  bool has_steps = true;
  std::vector<TrialFigures> trials = {};
};

/// "100:200".
StepRange range_of(const std::string& text) {
  if (text.empty()) return {};
  const std::size_t colon = std::min(text.find(':'), text.size() - 1);
  const auto from = number_of<std::size_t>(text.substr(0, colon));
  const auto to = number_of<std::size_t>(text.substr(colon + 1));
  if (!from || !to || *to <= *from)
    throw ConfigError("--steps " + text,
                      "is no range of steps; give the first one and the one behind the last, as in 100:200");
  return {*from, *to};
}

std::vector<Row> rows_of(const SummarizeOptions& options) {
  const StepRange range = range_of(options.steps);
  std::vector<Row> rows;
  const auto runs = read_runs(options.folders, [&](const std::filesystem::path& folder) {
    Row row{.name = "", .folders = {folder.string()}};
    StoredRun run = read_figures(folder, range, row.trials);
    row.complete = run.complete;
    row.has_steps = run.has_steps;
    rows.push_back(std::move(row));
    return run;
  });
  for (std::size_t i = 0; i < rows.size(); ++i) rows[i].name = runs[i].name;
  return rows;
}

Row pooled(const std::vector<Row>& rows) {
  Row all{.name = "all"};
  for (const Row& row : rows) {
    all.folders.insert(all.folders.end(), row.folders.begin(), row.folders.end());
    all.trials.insert(all.trials.end(), row.trials.begin(), row.trials.end());
    all.complete = all.complete && row.complete;
    all.has_steps = all.has_steps && row.has_steps;
  }
  return all;
}

Json to_json(const Row& row) {
  Summary summary;
  for (const TrialFigures& trial : row.trials) summary.add(trial);
  Json json = {{"name", row.name}, {"folders", row.folders}, {"complete", row.complete}};
  json.update(summary.figures());
  // What is not known is not 0.
  if (json.at("steps") == 0) {
    for (const char* key : {"after_declaration", "step_ms", "answer_ms", "stage_ms"}) json.erase(key);
  }
  if (!row.has_steps) json.erase("steps");
  return json;
}

double median(const Json& row, const char* key) {
  return row.at(key).at("median").get<double>();
}

/// Adding 0 turns -0 into 0.
std::string per_cent(const Json& share) {
  const auto of = [&](const char* key) { return 100.0 * share.at(key).get<double>() + 0.0; };
  return fmt::format("{:.1f} % ({:.1f} to {:.1f} %)", of("value"), of("low"), of("high"));
}

std::string markdown_head() {
  return "| run | starts | right | wrong | undecided | wrong (95 % interval) | steps, way to localize "
         "(median) | error then (median) | a step (median) |\n|---|---|---|---|---|---|---|---|---|\n";
}

std::string markdown_row(const Json& row) {
  const Json& trials = row.at("trials");
  const bool any_right = trials.at("right") != 0;
  const bool is_judged =
      any_right || trials.at("wrong") != 0 || !trials.contains("declared_without_reference");
  const std::string wrong = is_judged ? per_cent(row.at("false_rate")) : "–";
  const std::string way = any_right ? fmt::format("{:g}, {:.1f} m", median(row, "steps_to_localize"),
                                                  median(row, "distance_to_localize_m"))
                                    : "–";
  const std::string error =
      any_right ? fmt::format("{:.1f} cm, {:.2f}°", 100.0 * median(row, "translation_error_m"),
                              median(row, "rotation_error_deg"))
                : "–";
  const std::string step = row.contains("step_ms") ? fmt::format("{:.1f} ms", median(row, "step_ms")) : "–";
  return fmt::format("| {}{} | {} | {} | {} | {} | {} | {} | {} | {} |\n", row.at("name").get<std::string>(),
                     row.at("complete") ? "" : " (interrupted)", trials.at("count").dump(),
                     trials.at("right").dump(), trials.at("wrong").dump(), undecided_cell(trials), wrong, way,
                     error, step);
}

void summarize(const SummarizeOptions& options) {
  std::vector<Row> rows = rows_of(options);
  if (options.pool) rows = {pooled(rows)};
  if (!options.name.empty() && rows.size() > 1) {
    throw ConfigError(
        "--name " + options.name,
        fmt::format("there are {} rows; name one folder of results, or pool them with --pool", rows.size()));
  }
  if (!options.name.empty()) rows.front().name = options.name;
  Json json = Json::array();
  for (const Row& row : rows) json.push_back(to_json(row));
  if (options.json) {
    answer("{}\n", json_text(json, 2));
    return;
  }
  if (!options.no_head) answer(markdown_head());
  for (const Json& row : json) answer(markdown_row(row));
}

}  // namespace

void add_summarize(CLI::App& app, Context& /*context*/) {
  auto options = std::make_shared<SummarizeOptions>();
  CLI::App* command =
      app.add_subcommand("summarize", "Count outcomes of runs, with intervals and medians, as a table.");
  command->add_option("DIR", options->folders, "Folders of results, or folders that hold some")->required();
  command->add_flag("--pool", options->pool, "One row, over the trials of all folders together");
  command->add_flag("--json", options->json, "All numbers as JSON");
  command->add_option("--name", options->name, "What the row is called (default: the folder's name, or all)");
  command->add_option("--steps", options->steps,
                      "Only the times of these steps of each trial, FROM:TO (default: of all)");
  command->add_flag("--no-head", options->no_head, "Rows without the table's head");
  command->callback([options] { summarize(*options); });
}

}  // namespace glocal::app
