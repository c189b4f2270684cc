// Hand-made files for tests of what reads files.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include "glocal/error.hpp"
#include "glocal/params.hpp"
#include "temporary_folder.hpp"

namespace glocal::test {

[[nodiscard]] inline FilePath file_path(const std::filesystem::path& path) {
  return {path.string(), path};
}

/// What is left of a text without the folder names in it.
[[nodiscard]] inline std::string without_folder(std::string text, const std::filesystem::path& folder) {
  const std::string prefix = folder.string() + "/";
  for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at))
    text.erase(at, prefix.size());
  return text;
}

/// The message of the Error that `call` throws; empty if it throws none.
template <class Error = ConfigError, class Call>
[[nodiscard]] std::string error_of(Call call) {
  try {
    static_cast<void>(call());
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

/// The message of the ConfigError that `call` throws, without the folder names; empty if it throws none.
template <class Call>
[[nodiscard]] std::string config_error(const std::filesystem::path& folder, Call call) {
  return without_folder(error_of(call), folder);
}

/// Each fault of the ConfigError that `call` throws, without the folder names.
template <class Call>
[[nodiscard]] std::vector<std::string> config_faults(const std::filesystem::path& folder, Call call) {
  std::vector<std::string> faults;
  try {
    static_cast<void>(call());
  } catch (const ConfigError& error) {
    for (const Fault& fault : error.faults()) faults.push_back(without_folder(to_string(fault), folder));
  }
  return faults;
}

/// A file of the shared datasets; empty if GLOCAL_DATASETS is not set.
[[nodiscard]] inline std::filesystem::path dataset(const std::string& name) {
  const char* folder = std::getenv("GLOCAL_DATASETS");
  return folder == nullptr || *folder == '\0' ? std::filesystem::path()
                                              : std::filesystem::path(folder) / name;
}

}  // namespace glocal::test
