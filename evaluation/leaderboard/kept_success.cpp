#include "evaluation/leaderboard/kept_success.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

#include "evaluation/statistics/statistics.hpp"

namespace glocal {
namespace {

/// "people-3" as kind and level; none if it is something else.
std::optional<DisturbedCase> kind_and_level(const std::string& text) {
  const std::size_t at = text.rfind('-');
  if (at == std::string::npos || at == 0) return std::nullopt;
  const std::string level = text.substr(at + 1);
  if (level.size() != 1 || level[0] < '1' || level[0] > '0' + worst_level) return std::nullopt;
  return DisturbedCase{.name = "", .place = "", .kind = text.substr(0, at), .level = level[0] - '0'};
}

std::optional<DisturbedCase> as_disturbed(const Suite& suite, const std::string& name) {
  for (const SuiteCase& place : suite.cases) {
    if (!name.starts_with(place.name + "_")) continue;
    auto found = kind_and_level(name.substr(place.name.size() + 1));
    if (!found) continue;
    found->name = name;
    found->place = place.name;
    return found;
  }
  return std::nullopt;
}

double right_share(const BoardCounts& counts) {
  return static_cast<double>(counts.right) / static_cast<double>(counts.starts);
}

}  // namespace

std::vector<DisturbedKind> disturbed_kinds(const Suite& suite) {
  std::vector<DisturbedKind> kinds;
  for (const SuiteCase& one : suite.cases) {
    auto disturbed = as_disturbed(suite, one.name);
    if (!disturbed) continue;
    auto kind = std::ranges::find(kinds, disturbed->kind, &DisturbedKind::name);
    if (kind == kinds.end()) kind = kinds.insert(kinds.end(), {disturbed->kind, {}});
    kind->cases.push_back(std::move(*disturbed));
  }
  return kinds;
}

std::vector<DisturbedCase> of_level(const std::vector<DisturbedCase>& cases, int level) {
  std::vector<DisturbedCase> found;
  std::copy_if(cases.begin(), cases.end(), std::back_inserter(found),
               [&](const DisturbedCase& one) { return one.level == level; });
  return found;
}

KeptSuccess kept_success(const BoardEntry& entry, const std::vector<DisturbedCase>& cases) {
  KeptSuccess kept;
  std::vector<double> shares;
  for (const DisturbedCase& one : cases) {
    BoardCounts disturbed, clean;
    for (const CaseResult& result : entry.results) {
      if (result.case_name == one.place) clean.add(result);
      if (result.case_name != one.name) continue;
      disturbed.add(result);
      kept.counts.add(result);
    }
    if (disturbed.starts > 0 && clean.right > 0)
      shares.push_back(right_share(disturbed) / right_share(clean));
  }
  if (!shares.empty()) kept.share = mean(shares);
  return kept;
}

}  // namespace glocal
