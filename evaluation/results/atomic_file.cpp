#include "evaluation/results/atomic_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <chrono>
#include <system_error>

#include "evaluation/results/file_io.hpp"
#include "glocal/error.hpp"

namespace glocal {

namespace fs = std::filesystem;

AtomicFiles::~AtomicFiles() {
  std::error_code ignored;
  for (const Pending& pending : pending_) fs::remove(pending.temporary, ignored);
}

fs::path AtomicFiles::target_of(const fs::path& file) const {
  fs::path target = fs::absolute(file).lexically_normal();
  std::error_code error;
  // What a link leads to is replaced, not the link.
  if (fs::is_symlink(target, error)) {
    target = fs::canonical(target, error);
    if (error) throw ConfigError(file, "is a link that leads nowhere; remove it, or name another file");
  }
  if (fs::is_directory(target, error)) {
    throw ConfigError(file, "is a folder; name a file");
  }
  if (fs::exists(target, error) && !fs::is_regular_file(target, error))
    throw ConfigError(file, "is a device or a pipe, which would be replaced; name a file");
  if (!replace_ && fs::exists(target, error)) {
    throw ConfigError(file, "the file exists; choose another name, or replace it with --force");
  }
  return target;
}

void AtomicFiles::add(const fs::path& file, std::string_view content) {
  const fs::path target = target_of(file);
  make_folders_above(target);
  // Processes of two machines may have the same number, and write at the same time.
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  const fs::path temporary =
      target.parent_path() / fmt::format(".{}.{}-{:x}.unfinished", target.filename().string(), ::getpid(),
                                         std::chrono::nanoseconds(now).count());
  pending_.push_back({target, temporary});
  append(content);
}

void AtomicFiles::append(std::string_view content) {
  const Pending& last = pending_.back();
  check_written(append_to_file(last.temporary, content), last.file);
}

void AtomicFiles::commit() {
  std::error_code error;
  for (const Pending& pending : pending_) check_written(sync_to_disk(pending.temporary), pending.file);
  for (const Pending& pending : pending_) {
    fs::rename(pending.temporary, pending.file, error);
    check_written(error, pending.file);
  }
  for (const Pending& pending : pending_)
    check_written(sync_to_disk(pending.file.parent_path()), pending.file);
  pending_.clear();
}

void write_file(const fs::path& file, std::string_view content, bool replace) {
  AtomicFiles files(replace);
  files.add(file, content);
  files.commit();
}

}  // namespace glocal
