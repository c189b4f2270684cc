#include "evaluation/results/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "evaluation/results/file_io.hpp"
#include "evaluation/results/results_folder.hpp"
#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse_output(const fs::path& path, const std::string& why) {
  throw ConfigError(path, "output: " + why);
}

/// Why this process may not change what is in a folder; no error if it may.
std::error_code why_locked(const fs::path& folder) {
  return ::faccessat(AT_FDCWD, folder.c_str(), R_OK | W_OK | X_OK, AT_EACCESS) == 0 ? std::error_code()
                                                                                    : last_error();
}

/// The folder that is there already must let itself be written.
void check_writable(const fs::path& path) {
  fs::path above = path.parent_path();
  std::error_code error;
  while (fs::status(above, error).type() == fs::file_type::not_found) above = above.parent_path();
  if (!error && !fs::is_directory(above, error)) error = std::make_error_code(std::errc::not_a_directory);
  if (!error) error = why_locked(above);
  if (error)
    throw RunError(fmt::format("{}: cannot write: {}: {}", path.string(), reason_of(error), above.string()));
}

/// Earlier results of someone else can be moved out of the way, but not always removed.
void check_removable(const fs::path& path) {
  const auto check = [&](const fs::path& folder) {
    if (const auto error = why_locked(folder))
      refuse_output(path, fmt::format("--force cannot remove the earlier results, as {} belongs to someone "
                                      "else ({}); choose another folder with --out",
                                      folder.string(), error.message()));
  };
  check(path);
  for (fs::recursive_directory_iterator entry(path), end; entry != end; ++entry) {
    if (!entry->is_directory() || entry->is_symlink()) continue;
    check(entry->path());
  }
}

/// What the new results follow from must not go with the earlier ones.
void check_spares(const fs::path& folder, const std::set<fs::path>& inputs) {
  for (const fs::path& input : inputs) {
    const fs::path file = without_links(input);
    if (file == folder / "effective.yaml") continue;  // A run leaves the same one.
    if (std::ranges::mismatch(folder, file).in1 == folder.end())
      refuse_output(folder, fmt::format("--force would remove {}, which is read; choose another folder with "
                                        "--out, or move that file",
                                        file.string()));
  }
}

/// `there` is what is at `path`, or will be again.
void check_free(const fs::path& path, const fs::path& there, bool replace, const std::set<fs::path>& inputs) {
  std::error_code ignored;
  if (!fs::exists(there, ignored)) return;
  if (!fs::is_directory(there, ignored))
    refuse_output(path, "exists and is not a folder; choose another one with --out");
  if (fs::is_empty(there, ignored)) return;
  if (!replace)
    refuse_output(path,
                  "the folder exists and is not empty; choose another one with --out, or replace earlier "
                  "results with --force");
  if (!is_results_folder(there))
    refuse_output(path,
                  "--force replaces only earlier results, and this folder has no provenance.json; choose "
                  "another one with --out");
  check_spares(path, inputs);
  check_removable(there);
}

}  // namespace

OutputFolder::Places::Places(const fs::path& given) : path(without_links(given)) {
  const auto beside = [&](const char* what) {
    return path.parent_path() / fmt::format(".{}.{}", path.filename().string(), what);
  };
  unfinished = beside("unfinished");
  replaced = beside("replaced");
  lock = beside("lock");
}

void OutputFolder::check(const fs::path& path, bool replace, const TakesUp& takes_up) {
  const Places places(path);
  check_writable(places.path);
  std::error_code ignored;
  // A lock of a run that was killed is free.
  if (fs::exists(places.lock, ignored)) const FileLock probe(places.lock, places.path);
  const bool moved = !fs::exists(places.path, ignored) && fs::exists(places.replaced, ignored);
  const fs::path& there = moved ? places.replaced : places.path;
  if (!fs::is_directory(there, ignored) || !takes_up(there, true))
    check_free(places.path, there, replace, {});
}

void OutputFolder::tidy(const fs::path& path) {
  const Places places(path);
  std::error_code ignored;
  if (!fs::exists(places.lock, ignored)) return;
  const FileLock lock(places.lock, places.path);
  fs::remove_all(places.replaced, ignored);
}

OutputFolder::OutputFolder(const fs::path& path, bool replace, const std::set<fs::path>& inputs,
                           const TakesUp& takes_up)
    : places_(path), replace_(replace) {
  make_folder(places_.path.parent_path(), {});
  lock_.emplace(places_.lock, places_.path);
  restore_replaced();
  take_up_or_begin(inputs, takes_up);
}

void OutputFolder::spare(const std::set<fs::path>& inputs) const {
  std::error_code ignored;
  if (fs::exists(places_.path, ignored)) check_spares(places_.path, inputs);
}

/// What is unfinished is later than results that are not complete. What an earlier process has left may not
/// be on the disk yet.
void OutputFolder::take_up_or_begin(const std::set<fs::path>& inputs, const TakesUp& takes_up) {
  std::error_code error;
  keeps_ = fs::exists(places_.unfinished, error) && takes_up(places_.unfinished, false);
  const bool goes_on = !keeps_ && fs::is_directory(places_.path, error) && takes_up(places_.path, true);
  if (!goes_on) check_free(places_.path, places_.path, replace_, inputs);
  if (!keeps_) fs::remove_all(places_.unfinished, error);
  if (goes_on) fs::rename(places_.path, places_.unfinished, error);
  check(error);
  keeps_ = keeps_ || goes_on;
  make_folder(places_.unfinished, {});
  unsynced_.insert(places_.path.parent_path());
  unsynced_.insert(places_.unfinished);
  for (const auto& entry : fs::recursive_directory_iterator(places_.unfinished))
    unsynced_.insert(entry.path());
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  if (!committed_ && !keeps_) fs::remove_all(places_.unfinished, ignored);
}

void OutputFolder::append(const fs::path& name, std::string_view content) {
  process_.end_copies();
  const fs::path file = places_.unfinished / name;
  make_folder(file.parent_path(), name);
  check(append_to_file(file, content), name);
  unsynced_.insert(file.parent_path());
  unsynced_.insert(file);
}

void OutputFolder::write(const fs::path& name, std::string_view content) {
  process_.end_copies();
  const fs::path file = places_.unfinished / name;
  const fs::path part = file.string() + ".part";
  std::error_code error;
  fs::remove(part, error);
  make_folder(part.parent_path(), name);
  check(append_to_file(part, content), name);
  fs::rename(part, file, error);
  check(error, name);
  unsynced_.insert(part.parent_path());
  unsynced_.insert(file);
}

void OutputFolder::sync() {
  // Each call waits for the disk. With many files it is quicker to wait once, for all that any program
  // writes.
  constexpr std::size_t many = 16;
  if (unsynced_.size() > many) {
    check(sync_file_system(places_.path.parent_path()));
  } else {
    for (const fs::path& path : unsynced_) {
      const std::error_code error = sync_to_disk(path);
      // What an earlier process left may be removed or renamed meanwhile; where it is now is noted, too.
      if (error != std::errc::no_such_file_or_directory) check(error);
    }
  }
  unsynced_.clear();
}

void OutputFolder::commit() {
  process_.end_copies();
  sync();
  std::error_code error;
  // The check is repeated, as the run may have taken hours: what others have put there meanwhile is theirs.
  const bool replaces = replace_ && is_results_folder(places_.path);
  if (replaces) fs::rename(places_.path, places_.replaced, error);
  if (!error) fs::rename(places_.unfinished, places_.path, error);
  if (error) {
    restore_replaced();
    check(error);
  }
  committed_ = true;
  // Before the earlier results go: a power failure must not bring them back half removed.
  check(sync_to_disk(places_.path.parent_path()));
  if (replaces) remove_replaced();
  lock_.reset();
}

/// Earlier results that were moved out of the way come back if nothing has taken their place.
void OutputFolder::restore_replaced() const {
  std::error_code ignored;
  if (!fs::exists(places_.replaced, ignored)) return;
  if (fs::exists(places_.path, ignored)) {
    remove_replaced();
  } else {
    fs::rename(places_.replaced, places_.path, ignored);
  }
}

void OutputFolder::remove_replaced() const {
  std::error_code error;
  fs::remove_all(places_.replaced, error);
  if (error)
    throw RunError(
        fmt::format("{}: cannot remove these earlier results, which others have replaced: {}; "
                    "remove the folder, then give the same command again",
                    places_.replaced.string(), error.message()));
}

void OutputFolder::make_folder(const fs::path& folder, const fs::path& name) {
  std::vector<fs::path> changed;
  check(make_folders(folder, changed), name);
  for (const fs::path& above : changed) unsynced_.insert(above);
}

/// Files have their final place only at the end, so the message names the folder that was asked for, and
/// where to find what is kept.
void OutputFolder::check(const std::error_code& error, const fs::path& name) const {
  if (!error) return;
  const std::string what = name.empty() ? "" : " " + name.string();
  const std::string kept = keeps_ ? fmt::format(
                                        "; finished trials are kept in {}: give the same command "
                                        "again when the cause is mended",
                                        places_.unfinished.string())
                                  : "";
  throw RunError(
      fmt::format("{}: cannot write{}: {}{}", places_.path.string(), what, reason_of(error), kept));
}

}  // namespace glocal
