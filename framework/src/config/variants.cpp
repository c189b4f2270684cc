#include "config/variants.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <string_view>
#include <utility>

#include "config/sample.hpp"

namespace glocal {
namespace {

constexpr std::size_t most_paths = 1000;
constexpr std::size_t longest_name = 100;

/// Letters and digits that need no thought in a name.
bool is_word(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_';
}

/// A path with the values to try for it.
struct Axis {
  const YamlEntry* written;
  std::string label;  ///< The end of the path, as far as it tells this axis from the others.

  [[nodiscard]] std::size_t size() const { return written->value.items.size(); }
};

/// The scalars of a value, one after the other: `0.5`, `staged_margin`, `0-0.3`. What is too long for a name
/// is cut, but not to one that would do.
std::string text_of(const YamlNode& value) {
  std::string text;
  const auto is_full = [&] { return text.size() > longest_name; };
  const auto add = [&](const std::string& part) {
    text += (text.empty() ? "" : "-") + part.substr(0, longest_name + 1);
  };
  if (value.kind == NodeKind::scalar) add(value.text);
  for (std::size_t i = 0; i < value.items.size() && !is_full(); ++i) add(text_of(value.items[i]));
  for (std::size_t i = 0; i < value.entries.size() && !is_full(); ++i) {
    const YamlEntry& entry = value.entries[i];
    add(entry.key);
    if (entry.value.kind != NodeKind::null) add(text_of(entry.value));
  }
  if (text.empty()) text = "none";
  std::replace_if(
      text.begin(), text.end(), [](char c) { return !is_word(c) && c != '-' && c != '.'; }, '-');
  return text;
}

void check_path(const YamlEntry& entry, const std::string& key, std::vector<Fault>& faults) {
  if (!is_fixed(entry.key)) return;
  add_fault(faults, entry.place, "{}: '{}' is the same for all variants and cannot be changed", key,
            entry.key.substr(0, entry.key.find('.')));
}

std::vector<Axis> axes_of(const ListedChanges& changes, std::vector<Fault>& faults) {
  std::vector<Axis> axes;
  if (!changes.written) return axes;
  const std::vector<YamlEntry>& entries = checked_paths(*changes.written, "variants", faults);
  std::vector<std::string> paths;
  for (const YamlEntry& entry : entries) paths.push_back(entry.key);
  for (const YamlEntry& entry : entries) axes.push_back({&entry, distinct_end(entry.key, paths)});
  return axes;
}

/// A change to this value, which is part of what is written.
Change change_of(const YamlEntry& path, const YamlNode& value,
                 const std::shared_ptr<const YamlNode>& written) {
  return {path.key, path.place, {written, &value}};
}

/// The variant that takes value at[i] of axis i.
VariantChanges point(const std::vector<Axis>& axes, const std::vector<std::size_t>& at,
                     const std::shared_ptr<const YamlNode>& written) {
  VariantChanges variant;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    const YamlEntry& path = *axes[i].written;
    const YamlNode& value = path.value.items[at[i]];
    if (variant.setting.size() <= longest_name)
      variant.setting += (i == 0 ? "" : "_") + axes[i].label + "-" + text_of(value);
    variant.changes.push_back(change_of(path, value, written));
  }
  variant.place = variant.changes.back().value->place;
  return variant;
}

/// Says so if there are too many points, or too many changes in all of them.
bool are_too_many(std::size_t points, const std::vector<Axis>& axes, const char* section, const char* what,
                  std::vector<Fault>& faults) {
  const std::size_t changes = points * axes.size();
  if (points <= most_variants && changes <= most_changes) return false;
  const std::string excess = points > most_variants ? fmt::format("has more than {} {}", most_variants, what)
                                                    : fmt::format("changes {} values in all", changes);
  add_fault(faults, axes.front().written->place, "variants.{}: {}; leave some values out", section, excess);
  return true;
}

/// What is changed by names, in the order of the file.
void add_list(const NamedChanges& list, std::vector<VariantChanges>& variants, std::vector<Fault>& faults) {
  if (!list.written) return;
  const std::size_t size = list.written->entries.size();
  if (size > most_variants) {
    add_fault(faults, list.written->place,
              "variants.list: has {} variants, at most {} are allowed; leave some out", size, most_variants);
    return;
  }
  for (const YamlEntry& named : list.written->entries) {
    VariantChanges variant{named.key, named.place, {}};
    for (const YamlEntry& entry : checked_paths(named.value, "variants", faults))
      variant.changes.push_back(change_of(entry, entry.value, list.written));
    variants.push_back(std::move(variant));
  }
}

void add_grid(const ListedChanges& grid, std::vector<VariantChanges>& variants, std::vector<Fault>& faults) {
  const std::vector<Axis> axes = axes_of(grid, faults);
  if (axes.empty()) return;
  std::size_t points = 1;
  for (const Axis& axis : axes) points = std::min(points * axis.size(), most_variants + 1);
  if (are_too_many(points, axes, "grid", "combinations", faults)) return;
  std::vector<std::size_t> at(axes.size());
  for (std::size_t k = 0; k < points; ++k) {
    variants.push_back(point(axes, at, grid.written));
    // Counts on, the last axis fastest.
    for (std::size_t i = axes.size(); i-- > 0;) {
      at[i] = (at[i] + 1) % axes[i].size();
      if (at[i] != 0) break;
    }
  }
}

void add_zip(const ListedChanges& zip, std::vector<VariantChanges>& variants, std::vector<Fault>& faults) {
  const std::vector<Axis> axes = axes_of(zip, faults);
  if (axes.empty()) return;
  const std::size_t rows = axes.front().size();
  if (are_too_many(rows, axes, "zip", "rows", faults)) return;
  bool even = true;
  for (const Axis& axis : axes) {
    if (axis.size() == rows) continue;
    even = false;
    add_fault(faults, axis.written->value.place,
              "variants.zip: {} values for '{}', but {} for '{}'; give equally many", axis.size(),
              axis.written->key, rows, axes.front().written->key);
  }
  for (std::size_t row = 0; even && row < rows; ++row) {
    variants.push_back(point(axes, std::vector<std::size_t>(axes.size(), row), zip.written));
  }
}

/// Adds a fault for each setting that is there twice, or whose name fits no folder.
void check_settings(const std::vector<VariantChanges>& variants, std::vector<Fault>& faults) {
  std::map<std::string, int> first_lines;
  for (const VariantChanges& variant : variants) {
    const auto [first, is_new] = first_lines.try_emplace(variant.setting, variant.place.line);
    if (!is_new) {
      add_fault(faults, variant.place, "variants: '{}' is there twice (first in line {})", variant.setting,
                first->second);
    } else if (!is_folder_name(variant.setting)) {
      add_fault(faults, variant.place,
                "variants: '{}' is no name for a folder: at most 100 letters, digits, '_', '-' and '.', "
                "beginning with a letter, a digit or '_'; variants.list lets you choose names",
                variant.setting);
    }
  }
}

}  // namespace

void describe(ParamVisitor& v, VariantsSection& s) {
  v.field("list", s.list, {.doc = "Each has a name, and values by their paths, written as for `--set`."});
  v.field("grid", s.grid, {.doc = "Every combination of the values listed for each path."});
  v.field("zip", s.zip, {.doc = "The first values of all paths, then the second of all, and so on."});
  v.field("sample", s.sample, {.doc = "Values drawn from ranges, all of them anew for each setting."});
}

const std::vector<YamlEntry>& checked_paths(const YamlNode& map, const std::string& key,
                                            std::vector<Fault>& faults) {
  constexpr std::size_t longest_path = 1000;
  static const std::vector<YamlEntry> none;
  if (map.entries.size() > most_paths) {
    add_fault(faults, map.place, "{}: {} paths at once, at most {} are allowed; change fewer", key,
              map.entries.size(), most_paths);
    return none;
  }
  for (const YamlEntry& entry : map.entries) {
    check_path(entry, key, faults);
    if (entry.key.size() <= longest_path) continue;
    add_fault(faults, entry.place, "{}: a path of {} letters is none; write it as a.b.c", key,
              entry.key.size());
  }
  const bool are_short =
      std::ranges::all_of(map.entries, [](const YamlEntry& e) { return e.key.size() <= longest_path; });
  return are_short ? map.entries : none;
}

std::vector<VariantChanges> settings_of(const VariantsSection& section, AnyParams& experiment,
                                        std::vector<Fault>& faults) {
  std::vector<VariantChanges> variants;
  add_list(section.list, variants, faults);
  add_grid(section.grid, variants, faults);
  add_zip(section.zip, variants, faults);
  std::vector<VariantChanges> drawn = sampled_settings(section.sample, experiment, faults);
  std::move(drawn.begin(), drawn.end(), std::back_inserter(variants));
  check_settings(variants, faults);
  return variants;
}

std::string distinct_end(const std::string& path, const std::vector<std::string>& all) {
  for (std::size_t dot = path.rfind('.'); dot != std::string::npos && dot > 0;
       dot = path.rfind('.', dot - 1)) {
    std::string end = path.substr(dot + 1);
    const auto same = std::ranges::count_if(
        all, [&](const std::string& other) { return other == end || other.ends_with("." + end); });
    if (same == 1) return end;
  }
  return path;
}

bool is_fixed(std::string_view path) {
  constexpr std::array<std::string_view, 3> fixed = {"schema", "name", "plugins"};
  const std::string_view first = path.substr(0, path.find('.'));
  return is_variation(first) || std::ranges::find(fixed, first) != fixed.end();
}

bool is_folder_name(std::string_view name) {
  return !name.empty() && name.size() <= longest_name && is_word(name.front()) &&
         std::ranges::all_of(name, [](char c) { return is_word(c) || c == '-' || c == '.'; });
}

}  // namespace glocal
