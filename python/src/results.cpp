#include "python/src/results.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <limits>
#include <nlohmann/json.hpp>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/results/report_blocks.hpp"
#include "evaluation/results/results_folder.hpp"
#include "evaluation/results/summary_text.hpp"
#include "evaluation/sweeps/analysis.hpp"
#include "evaluation/sweeps/comparison_output.hpp"
#include "evaluation/sweeps/sweep_report.hpp"
#include "python/src/seen.hpp"

namespace glocal::python {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// The numbers, truth values or texts of a key, one for each line; those that a line lacks are NaN or empty.
struct TableColumn {
  std::string name;
  std::vector<double> numbers;
  std::vector<std::string> texts;
  bool is_text = false, is_whole = true, is_bool = true;
};

/// Lines of JSON as columns. The keys of a struct within a line are joined with a dot: "pose.x". Lists stay
/// where they are.
class Table {
 public:
  void add(const Json& line) {
    add_members(line, "");
    ++rows_;
    for (TableColumn& column : columns_) fill(column, rows_);
  }

  /// Arrays by name. Numbers lie in memory once, which the arrays view.
  [[nodiscard]] static py::dict arrays(Table table) {
    const auto kept = std::make_shared<const Table>(std::move(table));
    py::dict arrays;
    for (const TableColumn& column : kept->columns_) arrays[py::str(column.name)] = array(column, kept);
    return arrays;
  }

 private:
  static py::object array(const TableColumn& column, const Owner& kept) {
    if (column.is_text)
      return py::module_::import("numpy").attr("array")(py::cast(column.texts), py::arg("dtype") = "str");
    py::array array = numbers(column.numbers, kept);
    if (column.is_bool) return array.attr("astype")("bool");
    if (column.is_whole) return array.attr("astype")("int64");
    return array;
  }

  static void fill(TableColumn& column, std::size_t rows) {
    const std::size_t there = column.is_text ? column.texts.size() : column.numbers.size();
    if (there >= rows) return;
    if (column.is_text) {
      column.texts.resize(rows);
    } else {
      column.numbers.resize(rows, std::numeric_limits<double>::quiet_NaN());
      column.is_whole = column.is_bool = false;
    }
  }

  TableColumn& column_of(const std::string& name) {
    const auto known = std::ranges::find(columns_, name, &TableColumn::name);
    if (known != columns_.end()) return *known;
    columns_.push_back({name, {}, {}});
    return columns_.back();
  }

  void add_members(const Json& json, const std::string& path) {
    for (const auto& [key, value] : json.items()) {
      const std::string name = path.empty() ? key : fmt::format("{}.{}", path, key);
      if (value.is_object()) {
        add_members(value, name);
      } else if (!value.is_array() && !value.is_null()) {
        add_value(column_of(name), value);
      }
    }
  }

  void add_value(TableColumn& column, const Json& value) {
    column.is_text = value.is_string();
    fill(column, rows_);
    if (value.is_string()) {
      column.texts.push_back(value.get<std::string>());
      return;
    }
    column.is_bool = column.is_bool && value.is_boolean();
    column.is_whole = column.is_whole && value.is_number_integer();
    column.numbers.push_back(value.is_boolean() ? (value.get<bool>() ? 1.0 : 0.0) : value.get<double>());
  }

  std::vector<TableColumn> columns_;
  std::size_t rows_ = 0;
};

/// Of a folder: its summary as text, and the tables of trials and of steps.
py::tuple read_folder(const fs::path& folder) {
  Table trials, steps;
  std::string summary;
  {
    const py::gil_scoped_release others_may;
    const StoredRun run = read_results(folder, {.trial = [&](const Json& line) { trials.add(line); },
                                                .step = [&](const Json& line) { steps.add(line); }});
    summary = run.summary.dump();
  }
  return py::make_tuple(summary, Table::arrays(std::move(trials)), Table::arrays(std::move(steps)));
}

/// In short, in full, as Markdown, as CSV and as JSON.
std::tuple<std::string, std::string, std::string, std::string, std::string> compared(
    const std::vector<std::string>& folders, const std::string& baseline, bool times) {
  const std::vector<NamedRun> runs = read_runs(folders);
  if (runs.size() < 2)
    throw ConfigError(folders.empty() ? "" : folders.front(),
                      "there is nothing to compare it with; name two folders of results or more");
  const ComparisonOutput output =
      comparison_output(runs, find_baseline(runs, baseline), times ? measures() : measures_but_time());
  return {as_text(output.brief), as_text(output.full), as_markdown(output.full), output.csv,
          json_text(output.json)};
}

/// As text and as JSON.
std::pair<std::string, std::string> swept(const std::string& folder, std::size_t most_settings,
                                          const std::string& baseline) {
  const std::vector<NamedRun> runs = read_runs(
      {folder}, [](const fs::path& run) { return read_results(run, {}, ResultParts::all_but_steps); });
  const SweepAnalysis analysis = analyse_sweep(runs, {}, baseline);
  return {text_report(analysis, most_settings), json_text(analysis)};
}

std::string text_of_variants(const std::vector<std::pair<std::string, std::string>>& variants) {
  std::vector<std::pair<std::string, Json>> summaries;
  for (const auto& [name, summary] : variants) summaries.emplace_back(name, Json::parse(summary));
  return variants_text(summaries);
}

}  // namespace

void bind_results(py::module_& module) {
  using OthersMay = py::call_guard<py::gil_scoped_release>;
  module.def("read_folder", &read_folder, py::arg("folder"));
  module.def(
      "summary_text", [](const std::string& summary) { return summary_text(Json::parse(summary)); },
      py::arg("summary"));
  module.def("variants_text", &text_of_variants, py::arg("variants"));
  module.def("results_folders", &results_folders, OthersMay(), py::arg("folder"));
  module.def("compare", &compared, OthersMay(), py::arg("folders"), py::arg("baseline"), py::arg("times"));
  module.def("sweep", &swept, OthersMay(), py::arg("folder"), py::arg("most_settings"), py::arg("baseline"));
}

}  // namespace glocal::python
