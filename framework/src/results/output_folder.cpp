#include "results/output_folder.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <system_error>
#include <utility>

#include "glocal/error.hpp"
#include "results/file_io.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

/// Every results folder has this file; only such a folder is ever replaced.
constexpr const char* mark_of_results = "provenance.json";

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw RunError(fmt::format("{}: cannot write: {}", path.string(), reason));
}

void check_free(const fs::path& path, bool replace) {
  std::error_code ignored;
  if (!fs::exists(path, ignored)) return;
  if (!fs::is_directory(path, ignored)) {
    throw ConfigError(
        {{path.string(), 0, 0, "output: exists and is not a folder; choose another one with --out"}});
  }
  if (fs::is_empty(path, ignored)) return;
  if (!replace) {
    throw ConfigError(
        {{path.string(), 0, 0,
          "output: the folder exists and is not empty; choose another one with --out, or replace earlier "
          "results with --force"}});
  }
  if (!fs::exists(path / mark_of_results, ignored)) {
    throw ConfigError(
        {{path.string(), 0, 0,
          fmt::format("output: --force replaces only earlier results, and this folder has no {}; choose "
                      "another one with --out",
                      mark_of_results)}});
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& path, bool replace)
    : path_(fs::absolute(path).lexically_normal()), replace_(replace) {
  if (!path_.has_filename()) path_ = path_.parent_path();
  check_free(path_, replace);
  temporary_ = path_.parent_path() / fmt::format(".{}.{}.unfinished", path_.filename().string(), ::getpid());
  std::error_code error;
  fs::create_directories(temporary_, error);
  if (error) fail(path_, error.message());
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!committed_) fs::remove_all(temporary_, ignored);
}

void OutputFolder::append(const fs::path& name, std::string_view content) {
  const fs::path file = temporary_ / name;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) fail(path_ / name, error.message());
  append_to_file(file, content, path_ / name);
}

void OutputFolder::commit() {
  for (const auto& entry : fs::recursive_directory_iterator(temporary_)) sync_to_disk(entry.path());
  sync_to_disk(temporary_);
  std::error_code error;
  // The check is repeated, as the run may have taken hours: what others have put there meanwhile is theirs.
  const bool replaces = replace_ && fs::exists(path_ / mark_of_results, error);
  const fs::path old = temporary_.string() + ".replaced";
  if (replaces) fs::rename(path_, old, error);
  if (!error) fs::rename(temporary_, path_, error);
  if (error) fail(path_, error.message());
  committed_ = true;
  if (replaces) fs::remove_all(old, error);
  sync_to_disk(path_.parent_path());
}

}  // namespace glocal
