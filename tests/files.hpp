// Hand-made files for tests of what reads files.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "glocal/error.hpp"
#include "glocal/params.hpp"
#include "temporary_folder.hpp"

namespace glocal::test {

[[nodiscard]] inline FilePath file_path(const std::filesystem::path& path) {
  return {path.string(), path};
}

/// The message of the ConfigError that `call` throws, without the folder names; empty if it throws none.
template <class Call>
[[nodiscard]] std::string config_error(const std::filesystem::path& folder, Call call) {
  try {
    call();
  } catch (const ConfigError& error) {
    std::string text = error.what();
    const std::string prefix = folder.string() + "/";
    for (std::size_t at = text.find(prefix); at != std::string::npos; at = text.find(prefix, at)) {
      text.erase(at, prefix.size());
    }
    return text;
  }
  return "";
}

/// A file of the shared datasets; empty if GLOCAL_DATASETS is not set.
[[nodiscard]] inline std::filesystem::path dataset(const std::string& name) {
  const char* folder = std::getenv("GLOCAL_DATASETS");
  return folder == nullptr || *folder == '\0' ? std::filesystem::path()
                                              : std::filesystem::path(folder) / name;
}

}  // namespace glocal::test
