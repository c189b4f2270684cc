#include "evaluation/leaderboard/board_tables.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <optional>
#include <utility>

#include "evaluation/leaderboard/kept_success.hpp"
#include "evaluation/statistics/statistics.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

/// Results of a method that share a line of a table.
struct Line {
  std::string name;
  std::vector<const CaseResult*> results;
  BoardCounts counts = {};
};

/// "12, 0.2 to 0.5 %": with the 95 % interval of the share.
std::string with_interval(std::size_t n, std::size_t starts) {
  const Proportion share = wilson(n, starts);
  return fmt::format("{}, {:.1f} to {:.1f} %", n, 100.0 * share.low, 100.0 * share.high);
}

template <class Value>
std::optional<double> median_of_right(const Line& line, Value value) {
  std::vector<double> values;
  for (const CaseResult* result : line.results) {
    for (const StartResult& start : result->starts) {
      if (start.outcome == Outcome::right) values.push_back(value(start));
    }
  }
  return median_if_any(std::move(values));
}

std::string or_dash(const std::optional<double>& value, const char* format) {
  return value ? fmt::format(fmt::runtime(format), *value) : "–";
}

std::vector<std::string> row_of(const Line& line) {
  const auto cm = median_of_right(line, [](const StartResult& s) { return s.cm.value_or(0.0); });
  const auto deg = median_of_right(line, [](const StartResult& s) { return s.deg.value_or(0.0); });
  const auto time = median_step_ms(line.results);
  return {line.name,
          std::to_string(line.counts.starts),
          with_interval(line.counts.wrong, line.counts.starts),
          with_interval(line.counts.right, line.counts.starts),
          std::to_string(line.counts.undecided()),
          or_dash(median_of_right(line, [](const StartResult& s) { return static_cast<double>(s.steps); }),
                  "{:g}"),
          or_dash(median_of_right(line, [](const StartResult& s) { return s.way_m; }), "{:.1f} m"),
          cm ? fmt::format("{:.1f} cm, {:.2f}°", *cm, *deg) : "–",
          time ? fmt::format("{:.{}f} ms", *time, *time < 10.0 ? 1 : 0) : "–"};
}

/// "88", or "3 to 91" of what differs.
std::string span_of(std::vector<std::size_t> values) {
  std::sort(values.begin(), values.end());
  return values.front() == values.back() ? std::to_string(values.front())
                                         : fmt::format("{} to {}", values.front(), values.back());
}

std::vector<std::string> drive_row_of(const Line& line, const PublishedFigures* published) {
  std::vector<double> cm, deg;
  std::vector<std::size_t> first, last;
  std::size_t within = 0;
  for (const CaseResult* result : line.results) {
    const WholeDrive& drive = *result->drive;
    first.push_back(drive.first_clusters);
    last.push_back(drive.last_clusters);
    if (drive.localized == 0) continue;
    cm.push_back(drive.cm);
    deg.push_back(drive.deg);
    const bool is_right = result->starts.front().outcome == Outcome::right;
    if (published != nullptr && is_right && drive.cm <= published->translation_cm &&
        drive.deg <= published->rotation_deg)
      ++within;
  }
  const auto errors = [&](double p) {
    return cm.empty() ? "–" : fmt::format("{:.1f} cm, {:.2f}°", quantile(cm, p), quantile(deg, p));
  };
  return {line.name,
          fmt::format("{} of {}", cm.size(), line.results.size()),
          errors(0.5),
          errors(1.0),
          published == nullptr ? "–" : fmt::format("{} of {}", within, line.results.size()),
          span_of(first),
          span_of(last)};
}

/// What is kept of an entry's success in these cases, by levels and over all of them.
std::vector<std::string> kept_row_of(std::string name, const BoardEntry& entry,
                                     const std::vector<DisturbedCase>& cases) {
  const auto percent = [](const KeptSuccess& kept) {
    return kept.share ? fmt::format("{:.0f} %", 100.0 * *kept.share) : "–";
  };
  std::vector<std::string> row = {std::move(name)};
  for (int level = 1; level <= worst_level; ++level)
    row.push_back(percent(kept_success(entry, of_level(cases, level))));
  const KeptSuccess all = kept_success(entry, cases);
  row.push_back(percent(all));
  row.push_back(std::to_string(all.counts.starts));
  row.push_back(with_interval(all.counts.wrong, all.counts.starts));
  return row;
}

bool is_wanted(const BoardTable& table, const std::string& case_name) {
  return table.cases.empty() || std::ranges::find(table.cases, case_name) != table.cases.end();
}

/// A line for each entry, of its results on these cases.
std::vector<Line> lines_of(const std::vector<BoardEntry>& entries, const std::vector<std::string>& cases,
                           const std::string& before) {
  std::vector<Line> lines;
  for (const BoardEntry& entry : entries) {
    Line line{before + entry.label(), {}};
    for (const CaseResult& result : entry.results) {
      if (std::find(cases.begin(), cases.end(), result.case_name) == cases.end()) continue;
      line.results.push_back(&result);
      line.counts.add(result);
    }
    if (line.counts.starts > 0) lines.push_back(std::move(line));
  }
  std::ranges::stable_sort(lines, std::greater<>(), [](const Line& l) { return l.counts.score(); });
  return lines;
}

}  // namespace

Report board_tables(const Suite& suite, const std::vector<BoardEntry>& entries, const BoardTable& table) {
  std::vector<std::string> wanted;
  for (const SuiteCase& one : suite.cases) {
    if (is_wanted(table, one.name)) wanted.push_back(one.name);
  }
  // The same for all lines is in no name.
  const bool many_methods = entries.size() > 1;
  Table starts{{table.by_case ? "case" : "method", "starts", "wrong, 95 %", "right, 95 %", "undecided",
                "steps", "way", "error then", "a step"},
               {}};
  Table drives{{"case", "localized", "largest error since then: median", "largest", "as published",
                "clusters first", "last"},
               {}};
  const auto add = [&](Table& to, std::vector<Line> lines, const std::string& alone, const auto& row) {
    for (Line& line : lines) {
      if (!many_methods && !alone.empty()) line.name = alone;
      to.rows.push_back(row(line));
    }
  };
  if (!table.by_case) add(starts, lines_of(entries, wanted, ""), "", row_of);
  for (const std::string& name : wanted) {
    const std::vector<Line> lines = lines_of(entries, {name}, name + ", ");
    if (table.by_case) add(starts, lines, name, row_of);
    std::vector<Line> whole;
    std::ranges::copy_if(lines, std::back_inserter(whole), [](const Line& line) {
      return std::ranges::all_of(line.results, [](const CaseResult* r) { return r->drive.has_value(); });
    });
    const auto figures = std::ranges::find(suite.published, name, &PublishedFigures::case_name);
    const PublishedFigures* published = figures == suite.published.end() ? nullptr : &*figures;
    add(drives, std::move(whole), name, [&](const Line& line) { return drive_row_of(line, published); });
  }
  Report report{std::move(starts)};
  if (drives.rows.empty()) return report;
  for (const PublishedFigures& p : suite.published) {
    if (!is_wanted(table, p.case_name)) continue;
    drives.rows.push_back({fmt::format("{}, as published", p.case_name), "–", "–",
                           fmt::format("{:.2f} cm, {:.2f}°", p.translation_cm, p.rotation_deg), "–", p.about,
                           "–"});
  }
  report.emplace_back(std::move(drives));
  return report;
}

Report kinds_table(const Suite& suite, const std::vector<BoardEntry>& entries) {
  const std::vector<DisturbedKind> kinds = disturbed_kinds(suite);
  if (kinds.empty())
    throw ConfigError(suite.file, fmt::format("{} has no disturbances; leave --kinds out", suite.id()));
  std::vector<DisturbedCase> all;
  for (const DisturbedKind& kind : kinds) all.insert(all.end(), kind.cases.begin(), kind.cases.end());
  std::vector<const BoardEntry*> best_first;
  for (const BoardEntry& entry : entries) best_first.push_back(&entry);
  std::stable_sort(best_first.begin(), best_first.end(), [&](const BoardEntry* a, const BoardEntry* b) {
    return kept_success(*a, all).share.value_or(0.0) > kept_success(*b, all).share.value_or(0.0);
  });
  Table over_all{{"method"}, {}}, by_kind{{"disturbance, method"}, {}};
  for (Table* table : {&over_all, &by_kind}) {
    for (int level = 1; level <= worst_level; ++level)
      table->header.push_back(fmt::format("level {}", level));
    for (const char* name : {"success kept", "starts", "wrong, 95 %"}) table->header.emplace_back(name);
  }
  for (const BoardEntry* entry : best_first)
    over_all.rows.push_back(kept_row_of(entry->label(), *entry, all));
  for (const DisturbedKind& kind : kinds) {
    for (const BoardEntry* entry : best_first)
      by_kind.rows.push_back(kept_row_of(entries.size() > 1 ? kind.name + ", " + entry->label() : kind.name,
                                         *entry, kind.cases));
  }
  return {std::move(over_all), std::move(by_kind)};
}

Report board_overview(const std::vector<std::string>& suites, const std::vector<BoardEntry>& entries) {
  struct MethodRow {
    std::string name;
    std::vector<std::string> cells;
    double score = 0.0;
  };
  Table table{{"method: wrong / right of starts"}, {}};
  table.header.insert(table.header.end(), suites.begin(), suites.end());
  std::vector<MethodRow> methods;
  for (const BoardEntry& entry : entries) {
    const auto column = std::find(suites.begin(), suites.end(), entry.suite) - suites.begin();
    auto method = std::ranges::find(methods, entry.method, &MethodRow::name);
    if (method == methods.end())
      method = methods.insert(methods.end(), {entry.method, std::vector<std::string>(suites.size(), "–")});
    const BoardCounts counts = counts_of(entry);
    method->cells.at(static_cast<std::size_t>(column)) =
        fmt::format("{} / {} of {}", counts.wrong, counts.right, counts.starts);
    method->score += counts.score();
  }
  std::ranges::stable_sort(methods, std::greater<>(), &MethodRow::score);
  for (MethodRow& method : methods) {
    std::vector<std::string> row = {method.name};
    std::move(method.cells.begin(), method.cells.end(), std::back_inserter(row));
    table.rows.push_back(std::move(row));
  }
  return {std::move(table)};
}

}  // namespace glocal
