// Which experiments an experiment file asks for.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/node.hpp"
#include "glocal/experiment.hpp"
#include "glocal/params.hpp"

namespace glocal {

/// The key `variants.sample`.
struct SampleSection {
  int count = 0;
  bool sobol = true;
  std::uint64_t seed = 1;
  RangedChanges ranges;
};
void describe(ParamVisitor& v, SampleSection& s);

/// The key `variants` of an experiment file.
struct VariantsSection {
  NamedChanges list;
  ListedChanges grid;
  ListedChanges zip;
  SampleSection sample;
};
void describe(ParamVisitor& v, VariantsSection& s);

/// The keys of an experiment file that make many experiments of one.
struct Variations {
  PartList methods;
  PartList cases;
  PartList choose_on;
  PartList judge_on;
  NamedChanges disturbances;
  std::string suite;
  double share = 1.0;
  VariantsSection variants;
  SeedList seeds;
};
/// Each is a key of its own, beside those of the experiment.
void describe(ParamVisitor& v, Variations& s);
/// Their names.
[[nodiscard]] bool is_variation(std::string_view key);

/// Of any kind, and of all that they make together.
constexpr std::size_t most_variants = 10000;
/// Values that points of one kind change, all together.
constexpr std::size_t most_changes = 1'000'000;

/// One value and where it goes.
struct Change {
  std::string path;                       ///< localizer.matcher.ransam.iterations
  Place place;                            ///< Where the path is written.
  std::shared_ptr<const YamlNode> value;  ///< Part of what is written: many variants share it.
};

/// What makes a variant of an experiment, but for its seed.
struct VariantChanges {
  std::string setting;
  Place place;  ///< Of the setting's name, or of the values it is made from; of method or case without one.
  std::vector<Change> changes;
  std::string name = {};  ///< Of the variant, without its seed.
  std::string case_name = {};
  CaseRole role = CaseRole::none;
};

/// The name behind which the seed has been put: `NAME_seed-N`.
[[nodiscard]] std::string name_with_seed(const std::string& name, std::uint64_t seed);

/// All settings: those of the list, the combinations of the grid (the last key changing fastest), the rows of
/// zip and what is drawn. A point of grid and zip is named after the last parts of its paths and its values:
/// `iterations-50000_contact_epsilon-0.05`. What is wrong with names, paths, ranges and the number of values
/// goes to `faults`; whether a change makes sense is for the reader to say. `experiment` tells where whole
/// numbers are to be drawn.
[[nodiscard]] std::vector<VariantChanges> settings_of(const VariantsSection& section, AnyParams& experiment,
                                                      std::vector<Fault>& faults);

/// The shortest end of a path (whole parts of it) that no other one of `all` has.
[[nodiscard]] std::string distinct_end(const std::string& path, const std::vector<std::string>& all);

/// Whether a path leads to what is the same for all variants.
[[nodiscard]] bool is_fixed(std::string_view path);

/// The paths of a map, checked; none where there are too many of them, or one is too long to be any. `key` is
/// where the map is.
[[nodiscard]] const std::vector<YamlEntry>& checked_paths(const YamlNode& map, const std::string& key,
                                                          std::vector<Fault>& faults);

/// What an experiment file asks for, of each method with each case.
struct Expansion {
  std::vector<VariantChanges> variants;  ///< The settings; none if there are neither these nor seeds.
  std::vector<std::uint64_t> seeds;      ///< Each variant is run with each; none: with the experiment's.

  /// Of all variants with all seeds.
  [[nodiscard]] std::size_t size() const { return variants.size() * std::max<std::size_t>(seeds.size(), 1); }
};

/// All settings, as in settings_of(), and all seeds. What is wrong goes to `faults`; too many variants are
/// none.
[[nodiscard]] Expansion expand(const Variations& variations, AnyParams& experiment,
                               std::vector<Fault>& faults);

/// The seeds, or other numbers, that are written, in their order; faults call them `what`.
[[nodiscard]] std::vector<std::uint64_t> numbers_of(const SeedList& list, const char* what,
                                                    std::vector<Fault>& faults);

/// Adds a fault for each name that fits no folder, with the longest seed behind it.
void check_full_names(const Expansion& all, std::vector<Fault>& faults);

/// Letters, digits, `_`, `-` and `.`, at most 100, beginning with a letter, a digit or `_`: fit for a folder,
/// and for a command line.
[[nodiscard]] bool is_folder_name(std::string_view name);

}  // namespace glocal
