// How settings, cases and seeds make the variants of an experiment file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "config/scalars.hpp"
#include "config/variants.hpp"

namespace glocal {
namespace {

constexpr std::array<std::string_view, 4> variation_keys = {"variants", "seeds", "choose_on", "judge_on"};

/// One end of a range of seeds.
std::optional<std::uint64_t> end_of_range(const YamlNode& range, const std::string& text,
                                          std::vector<Fault>& faults) {
  std::uint64_t seed = 0;
  YamlNode node = make_node(NodeKind::scalar, range.place);
  node.text = text;
  const Refusal refusal = text.empty() ? Refusal("one end is missing") : take_value(node, {.doc = ""}, seed);
  if (!refusal) return seed;
  faults.push_back(
      fault_at(range.place, fmt::format("seeds: '{}' is no range such as 1..30: {}", range.text, *refusal)));
  return std::nullopt;
}

/// First and last seed of an item: a number, or a range of them.
std::optional<std::pair<std::uint64_t, std::uint64_t>> range_of(const YamlNode& item,
                                                                std::vector<Fault>& faults) {
  const std::size_t dots =
      item.kind == NodeKind::scalar && !item.quoted ? item.text.find("..") : std::string::npos;
  if (dots == std::string::npos) {
    std::uint64_t seed = 0;
    const Refusal refusal = take_value(item, {.doc = ""}, seed);
    if (!refusal) return std::pair(seed, seed);
    faults.push_back(fault_at(item.place, "seeds: " + *refusal + "; a range is written as 1..30"));
    return std::nullopt;
  }
  const auto first = end_of_range(item, item.text.substr(0, dots), faults);
  if (!first) return std::nullopt;
  const auto last = end_of_range(item, item.text.substr(dots + 2), faults);
  if (!last) return std::nullopt;
  if (*first <= *last) return std::pair(*first, *last);
  faults.push_back(
      fault_at(item.place, fmt::format("seeds: {0}..{1} runs backwards; write {1}..{0}", *first, *last)));
  return std::nullopt;
}

/// The cases by which to choose, and those by which to judge; the changes of each are those of a setting.
std::vector<VariantChanges> cases_of(const Variations& variations, std::vector<Fault>& faults) {
  std::vector<VariantChanges> cases = named_settings(variations.choose_on, "choose_on", faults);
  for (VariantChanges& one : cases) one.role = CaseRole::choose;
  std::vector<VariantChanges> judging = named_settings(variations.judge_on, "judge_on", faults);
  for (VariantChanges& one : judging) one.role = CaseRole::judge;
  if (cases.empty() && !judging.empty()) {
    faults.push_back(fault_at(judging.front().place,
                              "judge_on: there is no choose_on; say there by which cases to choose what is "
                              "judged here"));
  }
  std::move(judging.begin(), judging.end(), std::back_inserter(cases));
  check_names(cases, "choose_on, judge_on", faults);
  return cases;
}

/// The first change to each path.
std::vector<const Change*> each_path(const std::vector<VariantChanges>& variants) {
  std::set<std::string_view> seen;
  std::vector<const Change*> paths;
  for (const VariantChanges& variant : variants) {
    for (const Change& change : variant.changes) {
      if (seen.insert(change.path).second) paths.push_back(&change);
    }
  }
  return paths;
}

/// A change to what this path leads to, to a part of it, or to what it is a part of; null if there is none.
const Change* overlapping(const std::string& path, const std::map<std::string_view, const Change*>& changes) {
  for (std::size_t end = path.find('.');; end = path.find('.', end + 1)) {
    const auto above = changes.find(std::string_view(path).substr(0, end));
    if (above != changes.end()) return above->second;
    if (end == std::string::npos) break;
  }
  const std::string begin = path + ".";
  const auto below = changes.lower_bound(begin);
  return below != changes.end() && below->first.starts_with(begin) ? below->second : nullptr;
}

/// What a case changes is the case's alone; otherwise a result would not tell which of the two it is of.
void check_overlaps(const std::vector<VariantChanges>& settings, const std::vector<VariantChanges>& cases,
                    std::vector<Fault>& faults) {
  std::map<std::string_view, const Change*> of_cases;
  for (const Change* change : each_path(cases)) of_cases.emplace(change->path, change);
  for (const Change* change : each_path(settings)) {
    const Change* other = overlapping(change->path, of_cases);
    if (other == nullptr) continue;
    faults.push_back(fault_at(
        change->place,
        fmt::format("variants: '{}' is for the cases to change (line {}); leave it out in one of the two",
                    other->path, other->place.line)));
  }
}

void check_seed_changes(const std::vector<VariantChanges>& variants, std::vector<Fault>& faults) {
  for (const Change* change : each_path(variants)) {
    if (change->path == "seed") {
      faults.push_back(fault_at(change->place, "seed: is changed here, and `seeds` is given; leave one out"));
    }
  }
}

std::size_t count_changes(const std::vector<VariantChanges>& variants) {
  std::size_t n = 0;
  for (const VariantChanges& variant : variants) n += variant.changes.size();
  return n;
}

/// Each setting with each case.
std::vector<VariantChanges> cross(const std::vector<VariantChanges>& settings,
                                  const std::vector<VariantChanges>& cases) {
  std::vector<VariantChanges> variants;
  for (const VariantChanges& setting : settings) {
    for (const VariantChanges& one : cases) {
      variants.push_back(setting);
      variants.back().case_name = one.setting;
      variants.back().role = one.role;
      variants.back().case_changes = one.changes;
    }
  }
  return variants;
}

/// Names that are too long, or that two have, only together with their cases and seeds.
void check_full_names(const std::vector<VariantChanges>& variants, const std::vector<std::uint64_t>& seeds,
                      std::vector<Fault>& faults) {
  const bool have_cases = !variants.empty() && !variants.front().case_name.empty();
  if (have_cases) check_names(variants, "variants", faults);
  if (seeds.empty()) return;
  const std::uint64_t longest = *std::max_element(seeds.begin(), seeds.end());
  for (const VariantChanges& variant : variants) {
    const std::string name = name_with_seed(name_of(variant), longest);
    if (is_folder_name(name)) continue;
    faults.push_back(
        fault_at(variant.place, fmt::format("variants: '{}' is too long for a folder's name, which "
                                            "has at most 100 letters; variants.list lets you "
                                            "choose shorter ones",
                                            name)));
  }
}

}  // namespace

std::vector<std::uint64_t> seeds_of(const SeedList& list, std::vector<Fault>& faults) {
  std::vector<std::uint64_t> seeds;
  if (!list.written || list.written->kind == NodeKind::null || list.written->kind == NodeKind::invalid)
    return seeds;
  const YamlNode& written = *list.written;
  std::set<std::uint64_t> seen;
  for (const YamlNode& item : written.kind == NodeKind::list ? written.items : std::vector{written}) {
    if (item.kind == NodeKind::invalid) continue;
    const auto range = range_of(item, faults);
    if (!range) continue;
    const auto [first, last] = *range;
    if (last - first >= most_variants - seeds.size()) {
      faults.push_back(
          fault_at(item.place, fmt::format("seeds: more than {} seeds; leave some out", most_variants)));
      return {};
    }
    for (std::uint64_t k = 0; k <= last - first; ++k) {
      if (seen.insert(first + k).second) {
        seeds.push_back(first + k);
      } else {
        faults.push_back(
            fault_at(item.place, fmt::format("seeds: {} is there twice; give each seed once", first + k)));
        break;
      }
    }
  }
  return seeds;
}

void describe(ParamVisitor& v, Variations& s) {
  v.field("variants", s.variants,
          {.doc = "Experiments that differ in some values, for `glocal run` to compare."});
  v.field("seeds", s.seeds,
          {.doc = "Each variant is run with each of these seeds, which take the place of `seed`."});
  v.field("choose_on", s.choose_on,
          {.doc = "Cases, such as logs with their maps: each variant is run on each of them, and the best is "
                  "chosen by them. They are written as in variants.list."});
  v.field("judge_on", s.judge_on,
          {.doc = "Further cases, by which what was chosen is judged; nothing is chosen by them."});
}

bool is_variation(std::string_view key) {
  return std::find(variation_keys.begin(), variation_keys.end(), key) != variation_keys.end();
}

const char* to_string(CaseRole role) {
  switch (role) {
    case CaseRole::choose:
      return "choose";
    case CaseRole::judge:
      return "judge";
    case CaseRole::none:
      break;
  }
  return "none";
}

std::string name_of(const VariantChanges& variant) {
  return variant.setting + (variant.setting.empty() || variant.case_name.empty() ? "" : "_") +
         variant.case_name;
}

std::string name_with_seed(const std::string& name, std::uint64_t seed) {
  return fmt::format("{}{}seed-{}", name, name.empty() ? "" : "_", seed);
}

Expansion expand(const Variations& variations, AnyParams& experiment, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  Expansion all{settings_of(variations.variants, experiment, faults), seeds_of(variations.seeds, faults)};
  const std::vector<VariantChanges> cases = cases_of(variations, faults);
  check_overlaps(all.variants, cases, faults);
  if (!all.seeds.empty()) {
    check_seed_changes(all.variants, faults);
    check_seed_changes(cases, faults);
  }
  if (all.variants.empty() && !cases.empty()) all.variants.push_back({"", cases.front().place, {}});
  if (all.variants.empty() && !all.seeds.empty())
    all.variants.push_back({"", variations.seeds.written->place, {}});
  const auto at_least_one = [](std::size_t n) { return std::max<std::size_t>(n, 1); };
  const std::size_t n = all.variants.size() * at_least_one(cases.size()) * at_least_one(all.seeds.size());
  if (n > most_variants && (!cases.empty() || !all.seeds.empty())) {
    faults.push_back(fault_at(
        all.variants.front().place,
        fmt::format("variants: {} settings, {} cases and {} seeds make {} variants, at most {} are allowed; "
                    "leave some out",
                    all.variants.size(), cases.size(), all.seeds.size(), n, most_variants)));
    return {};
  }
  const std::size_t changes =
      count_changes(all.variants) * cases.size() + count_changes(cases) * all.variants.size();
  if (changes > most_changes) {
    faults.push_back(fault_at(
        cases.front().place,
        fmt::format("choose_on, judge_on: variants and cases change {} values in all; leave some out",
                    changes)));
    return {};
  }
  if (!cases.empty()) all.variants = cross(all.variants, cases);
  // Faults of the parts say more than those of the names that they make.
  if (faults.size() == before) check_full_names(all.variants, all.seeds, faults);
  return all;
}

}  // namespace glocal
