#include "config/builtin_parts.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdlib>
#include <fstream>
#include <system_error>

#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

constexpr std::array part_kind_names = {"method", "case", "suite"};
static_assert(part_kind_names.size() == static_cast<std::size_t>(PartKind::suite) + 1);

std::string folder_of(PartKind kind) {
  return to_string(kind) + std::string("s");
}

/// What stands behind '#' in the lines that a file begins with, up to the first full stop.
std::string first_comment(const fs::path& file) {
  std::ifstream lines(file);
  std::string about;
  for (std::string line; std::getline(lines, line) && line.starts_with("#");) {
    about += line.substr(std::min<std::size_t>(line.find_first_not_of("# "), line.size())) + " ";
    if (const std::size_t end = about.find(". "); end != std::string::npos) return about.substr(0, end + 1);
  }
  return about;
}

}  // namespace

const char* to_string(PartKind kind) {
  return part_kind_names[static_cast<std::size_t>(kind)];
}

fs::path library_folder() {
  Dl_info library{};
  if (dladdr(reinterpret_cast<void*>(&library_folder), &library) == 0) return {};
  return fs::absolute(library.dli_fname).parent_path();
}

std::optional<fs::path> builtin_plugin(const std::string& name) {
  for (const char* folder : {"../plugins", "glocal"}) {
    fs::path file = (library_folder() / folder / ("glocal_" + name + ".so")).lexically_normal();
    std::error_code ignored;
    if (fs::is_regular_file(file, ignored)) return file;
  }
  return std::nullopt;
}

fs::path configs_folder() {
  std::error_code ignored;
  if (const char* given = std::getenv("GLOCAL_CONFIGS"); given != nullptr) {
    if (!fs::is_directory(given, ignored))
      throw ConfigError("GLOCAL_CONFIGS",
                        fmt::format("names '{}', which is no folder; unset it, or name one with methods/, "
                                    "cases/ and suites/",
                                    given));
    return given;
  }
  // Debian has a folder for each kind of processor below lib.
  for (const char* up : {"..", "../.."}) {
    fs::path configs = (library_folder() / up / "share/glocal/configs").lexically_normal();
    if (fs::is_directory(configs, ignored)) return configs;
  }
  return {};
}

std::vector<BuiltinPart> builtin_parts(PartKind kind) {
  std::vector<BuiltinPart> parts;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(configs_folder() / folder_of(kind), ignored)) {
    if (entry.path().extension() == ".yaml")
      parts.push_back({entry.path().stem().string(), entry.path(), first_comment(entry.path())});
  }
  std::ranges::sort(parts, {}, &BuiltinPart::name);
  return parts;
}

std::optional<BuiltinPart> find_builtin_part(PartKind kind, const std::string& name) {
  const fs::path file = configs_folder() / folder_of(kind) / (name + ".yaml");
  std::error_code ignored;
  if (!fs::is_regular_file(file, ignored)) return std::nullopt;
  return BuiltinPart{name, file, first_comment(file)};
}

}  // namespace glocal
