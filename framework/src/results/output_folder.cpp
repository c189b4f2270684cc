#include "results/output_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>
#include <utility>

#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

/// Every results folder has this file; only such a folder is ever replaced.
constexpr const char* mark_of_results = "provenance.json";

[[noreturn]] void fail(const fs::path& path, const std::string& reason) {
  throw RunError(fmt::format("{}: cannot write: {}", path.string(), reason));
}

[[noreturn]] void fail_with_errno(const fs::path& path) {
  fail(path, std::strerror(errno));
}

/// Closes a file descriptor.
class Descriptor {
 public:
  Descriptor(const fs::path& path, int flags) : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {
    if (fd_ < 0) fail_with_errno(path);
  }
  ~Descriptor() { ::close(fd_); }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return fd_; }

 private:
  int fd_;
};

void sync(const fs::path& path) {
  const Descriptor file(path, O_RDONLY);
  if (::fsync(file.get()) != 0) fail_with_errno(path);
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

OutputFolder::OutputFolder(fs::path path, bool replace) : path_(fs::absolute(path).lexically_normal()) {
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
  const Descriptor out(file, O_WRONLY | O_CREAT | O_APPEND);
  while (!content.empty()) {
    const ssize_t written = ::write(out.get(), content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail_with_errno(path_ / name);
    content.remove_prefix(static_cast<std::size_t>(written));
  }
}

void OutputFolder::commit() {
  for (const auto& entry : fs::recursive_directory_iterator(temporary_)) sync(entry.path());
  sync(temporary_);
  std::error_code error;
  // The check is repeated, as the run may have taken hours.
  const bool replaces = fs::exists(path_ / mark_of_results, error);
  const fs::path old = temporary_.string() + ".replaced";
  if (replaces) fs::rename(path_, old, error);
  if (!error) fs::rename(temporary_, path_, error);
  if (error) fail(path_, error.message());
  committed_ = true;
  if (replaces) fs::remove_all(old, error);
  sync(path_.parent_path());
}

}  // namespace glocal
