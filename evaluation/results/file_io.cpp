#include "evaluation/results/file_io.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <sstream>
#include <utility>

#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

fs::path follow(const fs::path& path, int& links) {
  if (!path.has_relative_path()) return path;
  fs::path parent = follow(path.parent_path(), links);
  if (path.filename().empty() || path.filename() == ".") return parent;
  if (path.filename() == "..") return parent.parent_path();
  fs::path here = parent / path.filename();
  std::error_code ignored;
  if (!fs::is_symlink(here, ignored)) return here;
  // As many as Linux follows.
  constexpr int most_links = 40;
  if (++links > most_links)
    throw ConfigError(here, "is a symbolic link that leads in a circle; name a folder");
  return follow(parent / fs::read_symlink(here, ignored), links);
}

}  // namespace

Descriptor::Descriptor(const fs::path& path, int flags)
    : fd_(::open(path.c_str(), flags | O_CLOEXEC, 0644)) {}

Descriptor::~Descriptor() {
  if (fd_ >= 0) ::close(fd_);
}

std::error_code last_error() {
  return {errno, std::generic_category()};
}

std::string content_of(const fs::path& file) {
  std::ostringstream content;
  content << std::ifstream(file, std::ios::binary).rdbuf();
  return std::move(content).str();
}

std::error_code append_to_file(const fs::path& file, std::string_view content) {
  const Descriptor out(file, O_WRONLY | O_CREAT | O_APPEND);
  return out.get() < 0 ? last_error() : write_all(out.get(), content);
}

std::error_code write_all(int descriptor, std::string_view content) {
  while (!content.empty()) {
    const ssize_t written = ::write(descriptor, content.data(), content.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return last_error();
    content.remove_prefix(static_cast<std::size_t>(written));
  }
  return {};
}

std::error_code make_folders(const fs::path& folder, std::vector<fs::path>& changed) {
  std::error_code error;
  if (fs::is_directory(folder, error)) return {};
  if (folder.has_relative_path()) {
    if (const auto above = make_folders(folder.parent_path(), changed)) return above;
  }
  if (fs::create_directory(folder, error)) changed.push_back(folder.parent_path());
  return error == std::errc::file_exists ? std::make_error_code(std::errc::not_a_directory) : error;
}

std::error_code sync_to_disk(const fs::path& path) {
  const Descriptor file(path, O_RDONLY);
  return file.get() < 0 || ::fsync(file.get()) != 0 ? last_error() : std::error_code();
}

std::error_code sync_file_system(const fs::path& folder) {
  const Descriptor file(folder, O_RDONLY);
  return file.get() < 0 || ::syncfs(file.get()) != 0 ? last_error() : std::error_code();
}

std::string reason_of(const std::error_code& error) {
  const bool limited = error == std::errc::file_too_large;
  return error.message() + (limited ? " (for the limit that the shell or the system sets: ulimit -f)" : "");
}

void check_written(const std::error_code& error, const fs::path& file) {
  if (error) throw RunError(fmt::format("{}: cannot write: {}", file.string(), reason_of(error)));
}

void make_folders_above(const fs::path& file) {
  std::vector<fs::path> changed;
  check_written(make_folders(fs::absolute(file).parent_path(), changed), file);
  for (const fs::path& folder : changed) check_written(sync_to_disk(folder), file);
}

fs::path without_links(const fs::path& path) {
  int links = 0;
  return follow(fs::absolute(path), links);
}

}  // namespace glocal
