#include "evaluation/results/output_folder.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

#include "evaluation/results/file_io.hpp"
#include "evaluation/results/results_folder.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

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
  if (!is_results_folder(path)) {
    throw ConfigError({{path.string(), 0, 0,
                        "output: --force replaces only earlier results, and this folder has no "
                        "provenance.json; choose another one with --out"}});
  }
}

}  // namespace

OutputFolder::OutputFolder(const fs::path& path, bool replace, const TakesUp& takes_up)
    : path_(fs::absolute(path).lexically_normal()), replace_(replace) {
  if (!path_.has_filename()) path_ = path_.parent_path();
  unfinished_ = beside("unfinished");
  replaced_ = beside("replaced");
  std::error_code error;
  fs::create_directories(path_.parent_path(), error);
  if (error) fail(path_, error.message());
  lock_.emplace(beside("lock"), path_);
  restore_replaced();
  if (!fs::exists(unfinished_, error) && fs::is_directory(path_, error) && takes_up(path_)) {
    fs::rename(path_, unfinished_, error);
    if (error) fail(path_, error.message());
    keeps_ = true;
    return;
  }
  check_free(path_, replace);
  keeps_ = fs::exists(unfinished_, error) && takes_up(unfinished_);
  if (!keeps_) fs::remove_all(unfinished_, error);
  fs::create_directories(unfinished_, error);
  if (error) fail(path_, error.message());
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!committed_ && !keeps_) fs::remove_all(unfinished_, ignored);
}

fs::path OutputFolder::beside(const char* what) const {
  return path_.parent_path() / fmt::format(".{}.{}", path_.filename().string(), what);
}

void OutputFolder::append(const fs::path& name, std::string_view content) {
  const fs::path file = unfinished_ / name;
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  if (error) fail(path_ / name, error.message());
  append_to_file(file, content, path_ / name);
}

void OutputFolder::write(const fs::path& name, std::string_view content) {
  const fs::path part = name.string() + ".part";
  std::error_code error;
  fs::remove(unfinished_ / part, error);
  append(part, content);
  fs::rename(unfinished_ / part, unfinished_ / name, error);
  if (error) fail(path_ / name, error.message());
}

void OutputFolder::commit() {
  for (const auto& entry : fs::recursive_directory_iterator(unfinished_)) sync_to_disk(entry.path());
  sync_to_disk(unfinished_);
  std::error_code error;
  // The check is repeated, as the run may have taken hours: what others have put there meanwhile is theirs.
  const bool replaces = replace_ && is_results_folder(path_);
  if (replaces) fs::rename(path_, replaced_, error);
  if (!error) fs::rename(unfinished_, path_, error);
  if (error) {
    restore_replaced();
    fail(path_, error.message());
  }
  committed_ = true;
  if (replaces) fs::remove_all(replaced_, error);
  sync_to_disk(path_.parent_path());
  lock_.reset();
}

/// Earlier results that were moved out of the way come back if nothing has taken their place.
void OutputFolder::restore_replaced() const {
  std::error_code ignored;
  if (!fs::exists(replaced_, ignored)) return;
  if (fs::exists(path_, ignored)) {
    fs::remove_all(replaced_, ignored);
  } else {
    fs::rename(replaced_, path_, ignored);
  }
}

}  // namespace glocal
