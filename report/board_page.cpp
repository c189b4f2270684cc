#include "report/board_page.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <utility>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/leaderboard/kept_success.hpp"
#include "evaluation/results/proportions.hpp"
#include "report/report_data.hpp"

namespace glocal {
namespace {

using BoardJson = nlohmann::ordered_json;

BoardJson json_of_counts(const BoardCounts& counts) {
  const auto rate = [&](std::size_t n) { return to_json(wilson(n, counts.starts)); };
  return {{"starts", counts.starts},
          {"wrong", counts.wrong},
          {"right", counts.right},
          {"undecided", counts.undecided()},
          {"wrong_rate", rate(counts.wrong)},
          {"right_rate", rate(counts.right)},
          {"undecided_rate", rate(counts.undecided())}};
}

/// What an entry says of where it comes from; nothing where it says it otherwise.
std::string text_at(const BoardJson& provenance, const char* key) {
  const auto found = provenance.find(key);
  return found != provenance.end() && found->is_string() ? found->get<std::string>() : "";
}

/// The results as the entry's file has them, but for ways, which nothing here shows.
BoardJson json_of_results(const BoardEntry& entry) {
  BoardJson results = BoardJson::parse(to_text(entry)).at("results");
  for (std::size_t i = 0; i < results.size(); ++i) {
    results[i].erase("m");
    if (entry.share < 1.0) results[i]["numbers"] = entry.results[i].numbers;
  }
  return results;
}

BoardJson json_of_renewals(const BoardEntry& entry, const std::vector<Renewal>& history) {
  std::vector<Renewal> own;
  std::copy_if(history.begin(), history.end(), std::back_inserter(own), [&](const Renewal& renewal) {
    return renewal.suite == entry.suite && renewal.method == entry.method;
  });
  const std::vector<RenewalStep> steps = steps_between(own);
  BoardJson renewals = BoardJson::array();
  for (std::size_t i = 0; i < own.size(); ++i) {
    BoardJson renewal = json_of_counts(own[i].counts);
    renewal["date"] = own[i].date;
    renewal["revision"] = own[i].revision;
    if (i > 0) {
      const auto& [p_right, p_wrong] = steps[i - 1];
      renewal["p_right"] = p_right;
      renewal["p_wrong"] = p_wrong;
      renewal["significant"] = std::min(p_right, p_wrong) < significance;
    }
    renewals.push_back(std::move(renewal));
  }
  return renewals;
}

/// The success that is kept with each kind of disturbance, from level 1 on; null where it is unknown.
BoardJson json_of_kept(const BoardEntry& entry, const std::vector<DisturbedKind>& kinds) {
  BoardJson kept = BoardJson::array();
  for (const DisturbedKind& kind : kinds) {
    BoardJson levels = BoardJson::array();
    for (int level = 1; level <= worst_level; ++level) {
      const auto share = kept_success(entry, of_level(kind.cases, level)).share;
      levels.push_back(share ? BoardJson(*share) : BoardJson());
    }
    kept.push_back(std::move(levels));
  }
  return kept;
}

BoardJson json_of_entry(const BoardEntry& entry, const Suite& suite, const std::vector<DisturbedKind>& kinds,
                        const std::vector<Renewal>& history) {
  BoardJson cases = BoardJson::array();
  std::vector<const CaseResult*> all;
  for (const SuiteCase& one : suite.cases) {
    BoardCounts counts;
    for (const CaseResult& result : entry.results) {
      if (result.case_name != one.name) continue;
      counts.add(result);
      all.push_back(&result);
    }
    cases.push_back(json_of_counts(counts));
  }
  BoardJson json = {{"method", entry.method},
                    {"label", entry.label()},
                    {"cpu", text_at(entry.provenance, "cpu")},
                    {"imported", entry.provenance.contains("imported_sha256")},
                    {"all", json_of_counts(counts_of(entry))},
                    {"cases", std::move(cases)},
                    {"results", json_of_results(entry)},
                    {"kept", json_of_kept(entry, kinds)},
                    {"renewals", json_of_renewals(entry, history)}};
  if (const auto ms = median_step_ms(all)) json["step_ms"] = *ms;
  return json;
}

/// The names of all methods, the best over all suites first.
std::vector<std::string> ranked(const std::vector<SuiteBoard>& boards) {
  std::map<std::string, double> scores;
  for (const SuiteBoard& board : boards) {
    for (const BoardEntry& entry : board.entries) scores[entry.method] += counts_of(entry).score();
  }
  std::vector<std::string> names;
  for (const auto& [name, score] : scores) names.push_back(name);
  std::stable_sort(names.begin(), names.end(),
                   [&](const std::string& a, const std::string& b) { return scores.at(a) > scores.at(b); });
  return names;
}

}  // namespace

PageData board_page(const std::vector<SuiteBoard>& boards, const std::vector<Renewal>& history) {
  PageData page{report_head()};
  page.head["methods"] = ranked(boards);
  page.head["significance"] = significance;
  page.head["suites"] = BoardJson::array();
  for (const auto& [suite, entries] : boards) {
    std::vector<const BoardEntry*> best_first;
    for (const BoardEntry& entry : entries) best_first.push_back(&entry);
    std::stable_sort(best_first.begin(), best_first.end(), [](const BoardEntry* a, const BoardEntry* b) {
      return counts_of(*a).score() > counts_of(*b).score();
    });
    BoardJson json = {{"suite", suite.id()},
                      {"cases", BoardJson::array()},
                      {"disturbances", BoardJson::array()},
                      {"entries", BoardJson::array()}};
    for (const SuiteCase& one : suite.cases) json["cases"].push_back(one.name);
    const std::vector<DisturbedKind> kinds = disturbed_kinds(suite);
    for (const DisturbedKind& kind : kinds) json["disturbances"].push_back(kind.name);
    for (const BoardEntry* entry : best_first)
      json["entries"].push_back(json_of_entry(*entry, suite, kinds, history));
    page.head["suites"].push_back(std::move(json));
  }
  return page;
}

}  // namespace glocal
