// Which variants an experiment file asks for.
#pragma once

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "config/node.hpp"
#include "glocal/params.hpp"

namespace glocal {

/// The key `variants` of an experiment file.
struct VariantsSection {
  NamedChanges list;
  ListedChanges grid;
  ListedChanges zip;
};
void describe(ParamVisitor& v, VariantsSection& s);

/// One value and where it goes.
struct Change {
  std::string path;                       ///< localizer.matcher.ransam.iterations
  Place place;                            ///< Where the path is written.
  std::shared_ptr<const YamlNode> value;  ///< Part of what is written: many variants share it.
};

/// What makes a variant of an experiment.
struct VariantChanges {
  std::string name;
  Place place;  ///< Of the name, or of the values it is made from.
  std::vector<Change> changes;
};

/// All variants: those of the list, the combinations of the grid (the last key changing fastest) and the rows
/// of zip. A point of grid and zip is named after the last parts of its paths and its values:
/// `iterations-50000_contact_epsilon-0.05`. What is wrong with names, paths and the number of values goes to
/// `faults`; whether a change makes sense is for the reader to say.
[[nodiscard]] std::vector<VariantChanges> expand(const VariantsSection& section, std::vector<Fault>& faults);

/// Letters, digits, `_`, `-` and `.`, at most 100, beginning with a letter, a digit or `_`: fit for a folder,
/// and for a command line.
[[nodiscard]] bool is_folder_name(std::string_view name);

}  // namespace glocal
