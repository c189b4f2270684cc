// Experiments as products: methods × cases, each from a file of its own.
#pragma once

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "config/builtin_parts.hpp"
#include "config/node.hpp"
#include "config/suites.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// A method or a case.
struct ExperimentPart {
  std::string name;
  Place place;                     ///< Where the experiment names it.
  YamlNode tree;                   ///< Its keys: those of an experiment.
  CaseRole role = CaseRole::none;  ///< Of a case.
  bool is_fixed = false;           ///< Given without a list: not one of several, so that no name tells it.
};

/// What an experiment file names as `methods`, `cases`, and lists in `choose_on` and `judge_on`.
struct Products {
  std::vector<ExperimentPart> methods, cases;
  bool given = false;                            ///< Whether the file names any, be it wrongly.
  std::shared_ptr<const Suite> suite = nullptr;  ///< That cases and seeds are of; null if they are of none.
  double share = 1.0;                            ///< Of the suite's starts.
};

/// The file of what `value` names: one that is built in, or a file. Appends to `faults` where there is none.
[[nodiscard]] std::optional<std::filesystem::path> part_file(PartKind kind, const YamlNode& value,
                                                             std::vector<Fault>& faults);

/// Whether an experiment must leave a key to its suite.
[[nodiscard]] bool is_key_of_suite(std::string_view key);

/// Whether a path leads to one of these keys.
[[nodiscard]] bool names_parts(std::string_view path);

/// An experiment that has a localizer, or a map and a drive, of its own is of one method or case: those that
/// overrides name take its place.
void drop_replaced(YamlNode& experiment, const std::vector<Override>& of_parts);

/// Takes these keys out of the tree of an experiment file, and reads the files that they name. A method is a
/// map with `localizer` and perhaps `plugins`; a case has `map`, `observations`, `trials` and perhaps
/// `evaluation`. What the experiment says itself, a part may leave out. Either may extend another one, of
/// which it gives other values. A `suite` has cases, of which the experiment may name some, and seeds, which
/// stay in the tree. What is wrong goes to `faults`, at the file where it stands; `params` are an
/// experiment's.
[[nodiscard]] Products take_products(YamlNode& experiment, AnyParams& params, std::vector<Fault>& faults);

/// The keys of a method, by its name or file. Throws ConfigError.
[[nodiscard]] YamlNode read_method(const std::string& name, AnyParams& params);

/// The experiment of one of each; null for none. Values that the experiment itself gives take the place of
/// those of method and case, part by part; its plugins are added to the method's.
[[nodiscard]] YamlNode joined(const YamlNode& experiment, const ExperimentPart* method,
                              const ExperimentPart* one_case, AnyParams& params, std::vector<Fault>& faults);

}  // namespace glocal
