// The methods, cases and suites that glocal comes with, each a file of its own.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace glocal {

/// What an experiment is made of besides values of its own: a localizer, a place to try it, or many of these.
enum class PartKind { method, the_case, suite };
/// "method", "case", "suite".
[[nodiscard]] const char* to_string(PartKind kind);

struct BuiltinPart {
  std::string name;
  std::filesystem::path file;
  std::string about;  ///< Its first comment, a sentence.
};

/// Where the library lies that this is in.
[[nodiscard]] std::filesystem::path library_folder();

/// The module of a plugin of this tree, as it is built or installed; none if it is not there.
[[nodiscard]] std::optional<std::filesystem::path> builtin_plugin(const std::string& name);

/// The folder of all that is built in: $GLOCAL_CONFIGS, or else share/glocal/configs beside the library.
[[nodiscard]] std::filesystem::path configs_folder();

/// Those of a kind, by name: NAME.yaml in configs/methods, configs/cases or configs/suites.
[[nodiscard]] std::vector<BuiltinPart> builtin_parts(PartKind kind);
[[nodiscard]] std::optional<BuiltinPart> find_builtin_part(PartKind kind, const std::string& name);

}  // namespace glocal
