// Hand-made files for tests of what reads files.
#pragma once

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>

#include "glocal/error.hpp"
#include "glocal/params.hpp"

namespace glocal::test {

/// A folder of the running test's own, gone with it.
class TempFolder {
 public:
  TempFolder() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = std::filesystem::path(testing::TempDir()) /
            (std::string("glocal_") + info->test_suite_name() + "_" + info->name());
    std::filesystem::remove_all(path_);
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() { std::filesystem::remove_all(path_); }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;

  [[nodiscard]] std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

  std::filesystem::path write(const std::string& name, std::string_view content) const {
    std::filesystem::path file = path_ / name;
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }

 private:
  std::filesystem::path path_;
};

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
