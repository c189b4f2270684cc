#include "config/other_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string_view>

namespace glocal {
namespace {

/// A kind of file, by keys that it must have and an experiment does not, at its top.
struct OtherFile {
  std::array<std::string_view, 2> keys;
  std::string_view what;  ///< With {} for the file.
};

constexpr std::array<OtherFile, 4> other_files = {
    {{{"image", "resolution"},
      "is a map, as a map server reads it, and no experiment; an experiment names it, as map: {{ros_map: "
      "{{path: "
      "{0}}}}}, and drives through it with observations: {{simulation: {{map: {0}}}}}"},
     {{"size", "walls"},
      "is a simulated world, and no experiment; an experiment names it, as map: {{simulation: {{world: "
      "{0}}}}} "
      "and observations: {{simulation: {{world: {0}}}}}"},
     {{"map", "observations"}, "is a case, and no experiment: --case {0} --method NAME"},
     {{"localizer", "localizer"}, "is a method, and no experiment: --method {0} --case NAME"}}};

}  // namespace

std::optional<std::string> why_no_experiment(const YamlNode& tree) {
  const auto has_key = [&](std::string_view key) { return find_entry(tree, key) != nullptr; };
  if (tree.kind != NodeKind::map || has_key("schema") || has_key("name")) return std::nullopt;
  const auto found = std::ranges::find_if(
      other_files, [&](const OtherFile& file) { return std::ranges::all_of(file.keys, has_key); });
  if (found == other_files.end()) return std::nullopt;
  return fmt::format(fmt::runtime(found->what), tree.place.origin->label);
}

}  // namespace glocal
