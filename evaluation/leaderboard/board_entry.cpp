#include "evaluation/leaderboard/board_entry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <system_error>
#include <utility>

#include "config/text_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/statistics/statistics.hpp"
#include "glocal/error.hpp"
#include "glocal/pose2.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int entry_format = 1;
constexpr std::string_view outcome_letters = "rwudf";  // in the order of Outcome

double rounded(double value, double parts) {
  return std::round(value * parts) / parts;
}

Outcome outcome_of_letter(char letter) {
  const std::size_t at = outcome_letters.find(letter);
  if (at == std::string_view::npos) throw std::invalid_argument(fmt::format("'{}' is no outcome", letter));
  return static_cast<Outcome>(at);
}

/// "key": [of each start]
template <class Value>
std::string column(const CaseResult& result, const char* key, Value value) {
  std::string text;
  for (const StartResult& start : result.starts) {
    const std::optional<double> number = value(start);
    text += (text.empty() ? "" : ",") + (number ? fmt::format("{}", *number) : "null");
  }
  return fmt::format("\"{}\": [{}]", key, text);
}

std::string text_of_result(const CaseResult& result) {
  std::string outcome;
  for (const StartResult& start : result.starts)
    outcome += outcome_letters[static_cast<std::size_t>(start.outcome)];
  const char* const next = result.starts.size() == 1 ? ", " : ",\n   ";
  std::string text =
      fmt::format("  {{\"case\": {}, \"seed\": {}", Json(result.case_name).dump(), result.seed);
  if (result.step_ms) text += fmt::format(", \"ms\": {}", *result.step_ms);
  if (const auto& d = result.drive)
    text +=
        fmt::format(", \"localized\": {}, \"largest_cm\": {}, \"largest_deg\": {}, \"clusters\": [{}, {}]",
                    d->localized, d->cm, d->deg, d->first_clusters, d->last_clusters);
  text += fmt::format("{}\"outcome\": \"{}\"", next, outcome);
  text += next + column(result, "steps",
                        [](const StartResult& s) { return std::optional(static_cast<double>(s.steps)); });
  text += next + column(result, "m", [](const StartResult& s) { return std::optional(s.way_m); });
  text += next + column(result, "cm", [](const StartResult& s) { return s.cm; });
  text += next + column(result, "deg", [](const StartResult& s) { return s.deg; });
  return text + "}";
}

std::optional<double> number_at(const Json& column, std::size_t i) {
  const Json& value = column.at(i);
  if (value.is_null()) return std::nullopt;
  if (!value.is_number()) throw std::invalid_argument("a figure is no number");
  return value.get<double>();
}

CaseResult result_of(const Json& json, double share) {
  CaseResult result{
      .case_name = json.at("case"), .seed = whole_number(json, "seed"), .numbers = {}, .starts = {}};
  if (json.contains("ms")) result.step_ms = json.at("ms").get<double>();
  if (json.contains("localized")) {
    const Json& clusters = json.at("clusters");
    result.drive = WholeDrive{whole_number(json, "localized"), json.at("largest_cm").get<double>(),
                              json.at("largest_deg").get<double>(), whole_number(clusters, std::size_t{0}),
                              whole_number(clusters, std::size_t{1})};
  }
  const std::string outcome = json.at("outcome");
  result.numbers = numbers_in_share(result.case_name, result.seed, share, outcome.size());
  for (const char* key : {"steps", "m", "cm", "deg"}) {
    if (!json.at(key).is_array() || json.at(key).size() != outcome.size())
      throw std::invalid_argument(fmt::format("'{}' has not as many values as 'outcome'", key));
  }
  for (std::size_t i = 0; i < outcome.size(); ++i)
    result.starts.push_back({outcome_of_letter(outcome[i]), whole_number(json.at("steps"), i),
                             json.at("m").at(i).get<double>(), number_at(json.at("cm"), i),
                             number_at(json.at("deg"), i)});
  return result;
}

}  // namespace

StartResult start_result(Outcome outcome, std::size_t steps, double way_m,
                         const std::optional<PoseError>& error) {
  StartResult result{.outcome = outcome, .steps = steps, .way_m = rounded(way_m, 10.0), .cm = {}, .deg = {}};
  if (error) {
    result.cm = rounded(error->translation_m * 100.0, 10.0);
    result.deg = rounded(degrees(error->rotation_rad), 100.0);
  }
  return result;
}

WholeDrive whole_drive(std::size_t localized, double translation_m, double rotation_deg,
                       std::size_t first_clusters, std::size_t last_clusters) {
  return {localized, rounded(translation_m * 100.0, 100.0), rounded(rotation_deg, 1000.0), first_clusters,
          last_clusters};
}

const StartResult* CaseResult::find(std::size_t number) const {
  const auto found = std::lower_bound(numbers.begin(), numbers.end(), number);
  return found == numbers.end() || *found != number
             ? nullptr
             : &starts.at(static_cast<std::size_t>(found - numbers.begin()));
}

std::vector<std::size_t> numbers_in_share(const std::string& case_name, std::uint64_t seed, double share,
                                          std::size_t n) {
  constexpr std::size_t most = 1'000'000;
  std::vector<std::size_t> numbers;
  for (std::size_t start = 0; numbers.size() < n; ++start) {
    if (start == most) throw std::invalid_argument("'share' is too small for so many starts");
    if (is_in_share(case_name, seed, start, share)) numbers.push_back(start);
  }
  return numbers;
}

const CaseResult* BoardEntry::find(const std::string& case_name, std::uint64_t seed) const {
  const auto found = std::find_if(results.begin(), results.end(), [&](const CaseResult& r) {
    return r.case_name == case_name && r.seed == seed;
  });
  return found == results.end() ? nullptr : &*found;
}

std::string BoardEntry::command(const std::string& suite_named) const {
  return fmt::format("glocal run --suite {} --method {}{}", suite_named, method,
                     share < 1.0 ? fmt::format(" --share {}", share) : "");
}

std::string BoardEntry::label() const {
  return share < 1.0 ? fmt::format("{} (share {})", method, share) : method;
}

double BoardCounts::score() const {
  return (static_cast<double>(right) - static_cast<double>(wrong)) /
         static_cast<double>(std::max<std::size_t>(starts, 1));
}

void BoardCounts::add(const CaseResult& result) {
  for (const StartResult& start : result.starts) {
    ++starts;
    right += start.outcome == Outcome::right ? 1 : 0;
    wrong += start.outcome == Outcome::wrong ? 1 : 0;
  }
}

BoardCounts counts_of(const BoardEntry& entry) {
  BoardCounts counts;
  for (const CaseResult& result : entry.results) counts.add(result);
  return counts;
}

std::optional<double> median_step_ms(const std::vector<const CaseResult*>& results) {
  std::vector<double> ms;
  for (const CaseResult* result : results) {
    if (result->step_ms) ms.insert(ms.end(), result->starts.size(), *result->step_ms);
  }
  return median_if_any(std::move(ms));
}

void require_whole(BoardEntry& entry, const Suite& suite, const fs::path& file) {
  std::vector<Fault> faults;
  const auto lacks = [&](const std::string& what) {
    faults.push_back({file.string(), 0, 0, fmt::format("{}: {}", suite.id(), what)});
  };
  if (!suite.is_pinned) lacks("is not pinned yet; glocal leaderboard pin tells what to add to its file");
  std::vector<CaseResult> ordered;
  for (const SuiteCase& one : suite.cases) {
    for (const std::uint64_t seed : suite.seeds) {
      const CaseResult* result = entry.find(one.name, seed);
      const std::size_t starts = starts_in_share(one, seed, entry.share).size();
      if (result == nullptr && starts == 0) continue;  // None of its starts is in the share.
      if (result == nullptr) {
        lacks(fmt::format("there is no result for the case {} with seed {}; run all of the suite", one.name,
                          seed));
      } else if (result->starts.size() != starts) {
        lacks(fmt::format("the case {} with seed {} has {} starts here, and should have {}", one.name, seed,
                          result->starts.size(), starts));
      } else {
        ordered.push_back(*result);
      }
    }
  }
  if (faults.empty() && ordered.size() != entry.results.size())
    lacks("there are results of other cases or seeds than the suite's");
  if (!faults.empty()) throw ConfigError(std::move(faults));
  entry.results = std::move(ordered);
}

fs::path entry_file(const fs::path& board, const std::string& suite, const std::string& method) {
  return board / suite / (method + ".json");
}

std::vector<fs::path> entry_files(const fs::path& board, const std::string& suite) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(board / suite, ignored)) {
    if (entry.path().extension() == ".json") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

std::string to_text(const BoardEntry& entry) {
  std::string results;
  for (const CaseResult& result : entry.results)
    results += (results.empty() ? "" : ",\n") + text_of_result(result);
  return fmt::format(
      "{{\n \"format\": {},\n \"suite\": {},\n \"method\": {},\n{} \"provenance\": {},\n"
      " \"results\": [\n{}\n ]\n}}\n",
      entry_format, Json(entry.suite).dump(), Json(entry.method).dump(),
      entry.share < 1.0 ? fmt::format(" \"share\": {},\n", entry.share) : "", entry.provenance.dump(),
      results);
}

BoardEntry read_entry(const fs::path& file) {
  if (const auto why = why_unreadable(file)) throw ConfigError(file, *why);
  try {
    const Json json = parse_json(content_of(file));
    if (json.at("format") != entry_format) throw std::invalid_argument("it is of another version");
    BoardEntry entry{
        json.at("suite"), json.at("method"), json.value("share", 1.0), json.at("provenance"), {}};
    if (!(entry.share > 0.0 && entry.share <= 1.0)) throw std::invalid_argument("'share' is not in (0, 1]");
    for (const Json& result : json.at("results")) entry.results.push_back(result_of(result, entry.share));
    return entry;
  } catch (const std::exception& error) {
    throw ConfigError(file,
                      fmt::format("is no entry of a leaderboard ({}); glocal leaderboard add writes it anew",
                                  reason(error)));
  }
}

}  // namespace glocal
