// How settings and seeds make the variants of an experiment file.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <optional>
#include <set>
#include <string_view>
#include <utility>

#include "config/scalars.hpp"
#include "config/variants.hpp"

namespace glocal {
namespace {

constexpr std::array<std::string_view, 9> variation_keys = {
    "methods", "cases", "choose_on", "judge_on", "disturbances", "suite", "share", "variants", "seeds"};

constexpr std::array case_role_names = {"none", "choose", "judge"};
static_assert(case_role_names.size() == static_cast<std::size_t>(CaseRole::judge) + 1);

/// One end of a range of numbers.
std::optional<std::uint64_t> end_of_range(const YamlNode& range, const std::string& text, const char* what,
                                          std::vector<Fault>& faults) {
  std::uint64_t seed = 0;
  const YamlNode node = make_scalar(range.place, text);
  const Refusal refusal = text.empty() ? Refusal("one end is missing") : take_value(node, {.doc = ""}, seed);
  if (!refusal) return seed;
  add_fault(faults, range.place, "{}: '{}' is no range such as 1..30: {}", what, range.text, *refusal);
  return std::nullopt;
}

/// First and last number of an item: a number, or a range of them.
std::optional<std::pair<std::uint64_t, std::uint64_t>> range_of(const YamlNode& item, const char* what,
                                                                std::vector<Fault>& faults) {
  const std::size_t dots =
      item.kind == NodeKind::scalar && !item.quoted ? item.text.find("..") : std::string::npos;
  if (dots == std::string::npos) {
    std::uint64_t seed = 0;
    const Refusal refusal = take_value(item, {.doc = ""}, seed);
    if (!refusal) return std::pair(seed, seed);
    add_fault(faults, item.place, "{}: {}; a range is written as 1..30", what, *refusal);
    return std::nullopt;
  }
  const auto first = end_of_range(item, item.text.substr(0, dots), what, faults);
  if (!first) return std::nullopt;
  const auto last = end_of_range(item, item.text.substr(dots + 2), what, faults);
  if (!last) return std::nullopt;
  if (*first <= *last) return std::pair(*first, *last);
  add_fault(faults, item.place, "{2}: {0}..{1} runs backwards; write {1}..{0}", *first, *last, what);
  return std::nullopt;
}

void check_seed_changes(const std::vector<VariantChanges>& variants, std::vector<Fault>& faults) {
  for (const VariantChanges& variant : variants) {
    for (const Change& change : variant.changes) {
      if (change.path != "seed") continue;
      add_fault(faults, change.place, "seed: is changed here, and `seeds` is given; leave one out");
      return;
    }
  }
}

}  // namespace

std::vector<std::uint64_t> numbers_of(const SeedList& list, const char* what, std::vector<Fault>& faults) {
  std::vector<std::uint64_t> seeds;
  if (!list.written || list.written->kind == NodeKind::null || list.written->kind == NodeKind::invalid)
    return seeds;
  const YamlNode& written = *list.written;
  std::set<std::uint64_t> seen;
  for (const YamlNode& item : written.kind == NodeKind::list ? written.items : std::vector{written}) {
    if (item.kind == NodeKind::invalid) continue;
    const auto range = range_of(item, what, faults);
    if (!range) continue;
    const auto [first, last] = *range;
    if (last - first >= most_variants - seeds.size()) {
      add_fault(faults, item.place, "{0}: more than {1} {0}; leave some out", what, most_variants);
      return {};
    }
    for (std::uint64_t k = 0; k <= last - first; ++k) {
      if (seen.insert(first + k).second) {
        seeds.push_back(first + k);
      } else {
        add_fault(faults, item.place, "{}: {} is there twice; give each once", what, first + k);
        break;
      }
    }
  }
  return seeds;
}

void describe(ParamVisitor& v, Variations& s) {
  v.field(
      "methods", s.methods,
      {.doc = "Localizers, each of which meets each case: names of built-in ones (`glocal list methods`), "
              "files, or `name: {localizer, plugins}`. With `extends: NAME` one says only what it has "
              "other than NAME."});
  v.field("cases", s.cases,
          {.doc = "What the methods are tried on: names of built-in cases (`glocal list cases`), files, or "
                  "`name: {map, observations, trials, evaluation}`, perhaps with `extends`."});
  v.field("choose_on", s.choose_on, {.doc = "Cases in place of `cases`, by which the best is chosen."});
  v.field("judge_on", s.judge_on,
          {.doc = "Further cases, by which what was chosen is judged; nothing is chosen by them."});
  v.field(
      "disturbances", s.disturbances,
      {.doc = "Each case is run as it is, and with each of these: `observations: {KIND: levels}` and `map: "
              "{KIND: levels}`, kinds and levels as the sources `disturbed` have them."});
  v.field(
      "suite", s.suite,
      {.doc =
           "A suite in place of cases and seeds: its name and version (`glocal list suites`), as planar@1, "
           "or its file. `cases` then chooses some of its cases."});
  v.field("share", s.share,
          {.doc = "Which share of the suite's starts is run: the same ones for all methods.",
           .max = 1.0,
           .above = 0.0});
  v.field("variants", s.variants,
          {.doc = "Experiments that differ in some values, for `glocal run` to compare."});
  v.field("seeds", s.seeds,
          {.doc = "Each variant is run with each of these seeds, which take the place of `seed`."});
}

bool is_variation(std::string_view key) {
  return std::ranges::find(variation_keys, key) != variation_keys.end();
}

const char* to_string(CaseRole role) {
  return case_role_names[static_cast<std::size_t>(role)];
}

std::string name_with_seed(const std::string& name, std::uint64_t seed) {
  return fmt::format("{}{}seed-{}", name, name.empty() ? "" : "_", seed);
}

Expansion expand(const Variations& variations, AnyParams& experiment, std::vector<Fault>& faults) {
  Expansion all{settings_of(variations.variants, experiment, faults),
                numbers_of(variations.seeds, "seeds", faults)};
  if (!all.seeds.empty()) check_seed_changes(all.variants, faults);
  if (all.variants.empty() && !all.seeds.empty())
    all.variants.push_back({"", variations.seeds.written->place, {}});
  if (all.size() > most_variants && !all.seeds.empty()) {
    add_fault(faults, all.variants.front().place,
              "variants: {} settings and {} seeds make {} variants, at most {} are allowed; leave some out",
              all.variants.size(), all.seeds.size(), all.size(), most_variants);
    return {};
  }
  return all;
}

void check_full_names(const Expansion& all, std::vector<Fault>& faults) {
  for (const VariantChanges& variant : all.variants) {
    const std::string name =
        all.seeds.empty() ? variant.name : name_with_seed(variant.name, *std::ranges::max_element(all.seeds));
    if (name.empty() || is_folder_name(name)) continue;
    add_fault(faults, variant.place,
              "variants: '{}' is too long for a folder's name, which has at most 100 letters; variants.list, "
              "and names for methods and cases (NAME: file), let you choose shorter ones",
              name);
  }
}

}  // namespace glocal
