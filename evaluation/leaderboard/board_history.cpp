#include "evaluation/leaderboard/board_history.hpp"

#include <exception>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "config/text_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/json_text.hpp"
#include "evaluation/statistics/hypothesis_tests.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

using HistoryJson = nlohmann::ordered_json;

/// No suite has more starts.
constexpr std::size_t most_starts = 1'000'000;

Renewal renewal_of_line(const std::string& line) {
  const HistoryJson json = parse_json(line);
  Renewal renewal{json.at("date"), json.at("revision"), json.at("suite"), json.at("method"), {}};
  BoardCounts& counts = renewal.counts;
  counts.starts = whole_number(json, "starts");
  counts.right = whole_number(json, "right");
  counts.wrong = whole_number(json, "wrong");
  if (counts.starts > most_starts || counts.right > counts.starts ||
      counts.wrong > counts.starts - counts.right || counts.undecided() != whole_number(json, "undecided"))
    throw std::invalid_argument("its numbers do not add up");
  return renewal;
}

}  // namespace

Renewal renewal_of(const BoardEntry& entry) {
  return {entry.provenance.value("date", ""), entry.provenance.value("revision", ""), entry.suite,
          entry.method, counts_of(entry)};
}

std::string to_line(const Renewal& renewal) {
  const HistoryJson line = {{"date", renewal.date},
                            {"revision", renewal.revision},
                            {"suite", renewal.suite},
                            {"method", renewal.method},
                            {"starts", renewal.counts.starts},
                            {"right", renewal.counts.right},
                            {"wrong", renewal.counts.wrong},
                            {"undecided", renewal.counts.undecided()}};
  return line.dump() + "\n";
}

std::vector<Renewal> read_history(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return {};
  if (const auto why = why_unreadable(file)) throw ConfigError(file, *why);
  std::vector<Renewal> renewals;
  std::vector<Fault> faults;
  std::istringstream lines(content_of(file));
  int number = 1;
  for (std::string line; std::getline(lines, line); ++number) {
    try {
      renewals.push_back(renewal_of_line(line));
    } catch (const std::exception& error) {
      faults.push_back({file.string(), number, 0,
                        "is no line of a leaderboard's history (" + reason(error) + "); leave it out"});
    }
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
  return renewals;
}

std::vector<RenewalStep> steps_between(const std::vector<Renewal>& renewals) {
  std::vector<double> p;
  for (std::size_t i = 1; i < renewals.size(); ++i) {
    const BoardCounts& before = renewals[i - 1].counts;
    const BoardCounts& now = renewals[i].counts;
    p.push_back(fisher_exact({before.right, before.starts}, {now.right, now.starts}));
    p.push_back(fisher_exact({before.wrong, before.starts}, {now.wrong, now.starts}));
  }
  p = holm(p);
  std::vector<RenewalStep> steps;
  for (std::size_t i = 0; i < p.size(); i += 2) steps.push_back({p[i], p[i + 1]});
  return steps;
}

}  // namespace glocal
