#include "config/sample.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <boost/random/sobol.hpp>
#include <charconv>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "config/field_docs.hpp"
#include "config/reader.hpp"
#include "config/scalars.hpp"
#include "glocal/rng.hpp"

namespace glocal {
namespace {

/// With the direction numbers of S. Joe and F. Y. Kuo, "Constructing Sobol sequences with better
/// two-dimensional projections", SIAM J. Sci. Comput. 30 (2008) 2635-2654.
using Sobol = boost::random::sobol_engine<std::uint32_t, 32>;
constexpr std::size_t most_dimensions = boost::random::default_sobol_table::max_dimension;

/// Both ends of a range of numbers, as bounded as the field that they are for.
struct Ends {
  FieldInfo field = {.doc = ""};
  bool is_whole = false;
  double from = 0.0, to = 0.0;
  std::string scale = "linear";
};

void describe_end(ParamVisitor& v, const char* name, const Ends& ends, double& value) {
  FieldInfo info = ends.field;
  info.doc = "an end of the range";
  info.required = true;
  if (!ends.is_whole) {
    v.field(name, value, info);
    return;
  }
  int whole = 0;
  v.field(name, whole, info);
  value = whole;
}

void describe(ParamVisitor& v, Ends& e) {
  describe_end(v, "from", e, e.from);
  describe_end(v, "to", e, e.to);
  v.field(
      "scale", e.scale,
      {.doc = "Whether equal differences or equal ratios are equally likely.", .choices = {"linear", "log"}});
  v.require(e.from < e.to, "to", "must be above from");
  v.require(e.scale != "log" || e.from > 0.0, "from", "must be above 0 where the scale is log");
}

/// What the values of a path are drawn from.
struct Range {
  const YamlEntry* written;
  const YamlNode* choices = nullptr;  ///< A list; null if numbers are drawn.
  Ends ends = {};
};

bool is_number(FieldType type) {
  return type == FieldType::whole || type == FieldType::unsigned_whole || type == FieldType::number ||
         type == FieldType::number_or_auto;
}

/// [a, b] as {from: a, to: b}.
YamlNode with_named_ends(const YamlNode& pair) {
  YamlNode map = make_node(NodeKind::map, pair.place);
  map.entries.push_back({"from", pair.items[0].place, pair.items[0]});
  map.entries.push_back({"to", pair.items[1].place, pair.items[1]});
  return map;
}

/// Why a range has not the form of any; none if it has.
std::optional<std::string> why_no_range(const YamlNode& value) {
  const std::string forms = "expected [from, to], {from: a, to: b, scale: log} or {choices: [a, b]}, got ";
  if (value.kind == NodeKind::list)
    return value.items.size() == 2 ? std::nullopt : std::optional(forms + counted(value.items.size()));
  return value.kind == NodeKind::map ? std::nullopt : std::optional(forms + name_of(value));
}

/// The list that a range chooses from; null if it is none, or has faults.
const YamlNode* choices_of(const YamlNode& value, std::vector<Fault>& faults) {
  for (const YamlEntry& entry : value.entries) {
    if (entry.key != "choices")
      add_fault(faults, entry.place, "choices stand alone; leave '{}' out", entry.key);
  }
  const YamlNode& list = find_entry(value, "choices")->value;
  if (list.kind == NodeKind::list && !list.items.empty()) return &list;
  add_fault(faults, list.place, "choices: expected a list of values, got {}",
            list.kind == NodeKind::list ? counted(0) : name_of(list));
  return nullptr;
}

std::optional<Range> read_range(const YamlEntry& entry, AnyParams& experiment, std::vector<Fault>& faults) {
  const YamlNode& value = entry.value;
  if (value.kind == NodeKind::invalid) return std::nullopt;
  if (const auto why = why_no_range(value)) {
    add_fault(faults, value.place, "{}", *why);
    return std::nullopt;
  }
  if (find_entry(value, "choices") != nullptr) {
    const YamlNode* choices = choices_of(value, faults);
    return choices == nullptr ? std::nullopt : std::optional(Range{&entry, choices});
  }
  // A path that leads nowhere is for the reader to refuse.
  const std::optional<PathEnd> end = find_path(experiment, entry.key);
  const FieldDoc* field = end && end->strategy == nullptr ? &end->field : nullptr;
  if (field != nullptr && !is_number(field->type)) {
    add_fault(faults, value.place, "expected {{choices: [a, b]}}, as the values are not numbers ({})",
              type_name(*field));
    return std::nullopt;
  }
  ParamsOf<Ends> params;
  Ends& ends = params.value;
  if (field != nullptr) ends.field = field->info;
  if (field != nullptr && field->type == FieldType::unsigned_whole)
    ends.field.min = std::max(ends.field.min, 0.0);
  ends.is_whole =
      field != nullptr && (field->type == FieldType::whole || field->type == FieldType::unsigned_whole);
  const std::size_t before = faults.size();
  read_params(value.kind == NodeKind::list ? with_named_ends(value) : value, params, faults);
  return faults.size() == before ? std::optional(Range{&entry, nullptr, std::move(ends)}) : std::nullopt;
}

/// All ranges; none if one has a fault.
std::vector<Range> read_ranges(const YamlNode& written, AnyParams& experiment, std::vector<Fault>& faults) {
  const std::size_t before = faults.size();
  std::vector<Range> ranges;
  for (const YamlEntry& entry : checked_paths(written, "variants.sample", faults)) {
    if (is_fixed(entry.key)) continue;
    std::vector<Fault> found;
    if (auto range = read_range(entry, experiment, found)) ranges.push_back(*std::move(range));
    for (Fault& fault : found) {
      fault.message = "variants.sample: " + entry.key + ": " + fault.message;
      faults.push_back(std::move(fault));
    }
  }
  return faults.size() == before ? ranges : std::vector<Range>();
}

/// The value of the scale at u of [0, 1).
double scaled(const std::string& scale, double from, double to, double u) {
  return scale == "log" ? std::exp(std::lerp(std::log(from), std::log(to), u)) : std::lerp(from, to, u);
}

/// Each whole number's share of the scale begins at the number itself.
std::string whole_at(const Ends& ends, double u) {
  const double value = std::floor(scaled(ends.scale, ends.from, ends.to + 1.0, u));
  return fmt::format("{:.0f}", std::clamp(value, ends.from, ends.to));
}

/// So many digits are enough for any parameter, and are the same on any platform.
std::string number_at(const Ends& ends, double u) {
  std::string text = fmt::format("{:.6g}", scaled(ends.scale, ends.from, ends.to, u));
  double rounded = 0.0;
  std::from_chars(text.data(), text.data() + text.size(), rounded);
  return rounded >= ends.from && rounded <= ends.to ? text : to_yaml(std::clamp(rounded, ends.from, ends.to));
}

std::shared_ptr<const YamlNode> value_at(const Range& range, double u,
                                         const std::shared_ptr<const YamlNode>& written) {
  if (range.choices != nullptr) {
    const auto n = static_cast<double>(range.choices->items.size());
    return {written, &range.choices->items[static_cast<std::size_t>(u * n)]};
  }
  return std::make_shared<const YamlNode>(make_scalar(
      range.written->value.place, range.ends.is_whole ? whole_at(range.ends, u) : number_at(range.ends, u)));
}

/// Points one after the other, by their coordinates, each in [0, 1).
class UnitPoints {
 public:
  UnitPoints(const SampleSection& section, std::size_t dimensions)
      : rng_(section.seed), dimensions_(dimensions) {
    if (section.sobol) sobol_.emplace(dimensions);
  }

  /// Points of Sobol's sequence are shifted digit by digit (Cranley and Patterson's shift in base 2): the
  /// corner of the cube, which the sequence begins with, is no better than other places.
  [[nodiscard]] std::vector<double> next() {
    std::vector<double> u(dimensions_);
    for (std::size_t d = 0; d < dimensions_; ++d) {
      if (!sobol_) {
        u[d] = rng_.stream({index_, d}).uniform();
        continue;
      }
      const auto shift = static_cast<std::uint32_t>(rng_.stream({d}).next() >> 32U);
      // Boost leaves the corner out.
      const std::uint32_t x = index_ == 0 ? 0 : (*sobol_)();
      u[d] = static_cast<double>(x ^ shift) * 0x1.0p-32;
    }
    ++index_;
    return u;
  }

 private:
  Rng rng_;
  std::size_t dimensions_;
  std::uint32_t index_ = 0;
  std::optional<Sobol> sobol_;  ///< None: random points.
};

/// Whether so many ranges can be drawn from.
bool can_draw(const SampleSection& section, std::vector<Fault>& faults) {
  const YamlNode& written = *section.ranges.written;
  const std::size_t n = written.entries.size();
  if (section.sobol && n > most_dimensions) {
    add_fault(faults, written.place,
              "variants.sample: {} ranges, but Sobol's sequence has at most {} dimensions here; leave some "
              "out, or draw at random with sobol: false",
              n, most_dimensions);
    return false;
  }
  if (n * static_cast<std::size_t>(section.count) <= most_changes) return true;
  add_fault(faults, written.place, "variants.sample: changes {} values in all; draw fewer points",
            n * static_cast<std::size_t>(section.count));
  return false;
}

}  // namespace

void describe(ParamVisitor& v, SampleSection& s) {
  v.field("count", s.count,
          {.doc = "How many settings to draw.", .min = 0.0, .max = static_cast<double>(most_variants)});
  v.field(
      "sobol", s.sobol,
      {.doc = "Whether to take points of Sobol's sequence, which fill the ranges evenly; otherwise they are "
              "drawn at random."});
  v.field("seed", s.seed, {.doc = "Of the points; it has nothing to do with the experiment's."});
  v.field(
      "ranges", s.ranges,
      {.doc = "What to draw from for each path: [from, to], {from: a, to: b, scale: log} or {choices: [a, "
              "b]}."});
  const bool has_ranges = s.ranges.written && !s.ranges.written->entries.empty();
  v.require(has_ranges == (s.count > 0), "", "count and ranges must be given together");
}

std::vector<VariantChanges> sampled_settings(const SampleSection& section, AnyParams& experiment,
                                             std::vector<Fault>& faults) {
  std::vector<VariantChanges> settings;
  const std::shared_ptr<const YamlNode>& written = section.ranges.written;
  if (!written || section.count == 0 || !can_draw(section, faults)) return settings;
  const std::vector<Range> ranges = read_ranges(*written, experiment, faults);
  if (ranges.empty()) return settings;
  UnitPoints points(section, ranges.size());
  for (int i = 0; i < section.count; ++i) {
    const std::vector<double> u = points.next();
    VariantChanges setting{fmt::format("sample-{:04}", i + 1), written->place, {}};
    for (std::size_t d = 0; d < ranges.size(); ++d) {
      const YamlEntry& path = *ranges[d].written;
      setting.changes.push_back({path.key, path.place, value_at(ranges[d], u[d], written)});
    }
    settings.push_back(std::move(setting));
  }
  return settings;
}

}  // namespace glocal
