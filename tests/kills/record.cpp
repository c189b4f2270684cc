// Records what a program does to the files of a folder, in its order: to be loaded with LD_PRELOAD. Each line
// of the record is an operation with its paths, relative to the folder; states.cpp reads it.
#include <dlfcn.h>
#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

#include <array>
#include <climits>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <string>

namespace {

/// Held from the call to its line, so that lines are in the order of calls. Calls may lead to others.
std::recursive_mutex& order() {
  static std::recursive_mutex mutex;
  return mutex;
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(dlsym(RTLD_NEXT, name));
}

/// The folder, with a slash behind it.
const std::string& root() {
  static const std::string path = std::string(std::getenv("POWER_LOSS_FOLDER")) + "/";
  return path;
}

/// A line of several words, written with one call that is not recorded itself.
void note(const std::string& line) {
  static const auto fd = static_cast<int>(
      syscall(SYS_openat, AT_FDCWD, std::getenv("POWER_LOSS_RECORD"), O_WRONLY | O_CREAT | O_APPEND, 0644));
  const std::string text = line + "\n";
  if (syscall(SYS_write, fd, text.data(), text.size()) != static_cast<long>(text.size())) std::abort();
}

std::string link_target(const std::string& path) {
  std::array<char, PATH_MAX> target{};
  const ssize_t length = readlink(path.c_str(), target.data(), target.size());
  return length < 0 ? "" : std::string(target.data(), static_cast<std::size_t>(length));
}

/// The path below the folder; empty if it is elsewhere, "." for the folder.
std::string below(const std::string& path) {
  if (path + "/" == root()) return ".";
  return path.starts_with(root()) ? path.substr(root().size()) : "";
}

std::string below(int folder, const char* path) {
  if (*path == '/') return below(path);
  const std::string from =
      link_target(folder == AT_FDCWD ? "/proc/self/cwd" : "/proc/self/fd/" + std::to_string(folder));
  return below(from + "/" + path);
}

std::string below(int fd) {
  return below(link_target("/proc/self/fd/" + std::to_string(fd)));
}

bool exists(int folder, const char* path) {
  struct stat ignored {};
  return syscall(SYS_newfstatat, folder, path, &ignored, AT_SYMLINK_NOFOLLOW) == 0;
}

std::string hexadecimal(const void* data, std::size_t size) {
  constexpr const char* digits = "0123456789abcdef";
  std::string text;
  for (const auto* byte = static_cast<const unsigned char*>(data); size > 0; ++byte, --size) {
    text += digits[*byte >> 4U];
    text += digits[*byte & 15U];
  }
  return text;
}

/// Opens a file, and notes if that makes or empties it.
template <class Open>
auto opened(int folder, const char* path, int flags, const Open& open, decltype(open()) failed) {
  const std::lock_guard lock(order());
  const std::string name = below(folder, path);
  const bool was_there = exists(folder, path);
  const auto result = open();
  if (result == failed || name.empty()) return result;
  if (!was_there && (flags & O_CREAT) != 0) note("create\t" + name);
  if (was_there && (flags & O_TRUNC) != 0) note("resize\t" + name + "\t0");
  return result;
}

/// Calls, and notes this if it went well.
template <class Call>
auto noted(const std::string& name, const std::string& line, const Call& call) {
  const std::lock_guard lock(order());
  const auto result = call();
  if (result == 0 && !name.empty()) note(line);
  return result;
}

/// Where the next byte goes.
off_t position(int fd) {
  struct stat info {};
  const bool appends = (fcntl(fd, F_GETFL) & O_APPEND) != 0;
  if (appends && fstat(fd, &info) == 0) return info.st_size;
  return lseek(fd, 0, SEEK_CUR);
}

template <class Write>
ssize_t written(int fd, const void* data, off_t at, const Write& write) {
  const ssize_t result = write();
  const std::string name = result > 0 ? below(fd) : "";
  if (!name.empty())
    note("write\t" + name + "\t" + std::to_string(at) + "\t" +
         hexadecimal(data, static_cast<std::size_t>(result)));
  return result;
}

int flags_of(const char* mode) {
  return *mode == 'w' ? O_CREAT | O_TRUNC : *mode == 'a' ? O_CREAT : 0;
}

/// What nobody has needed so far is not imitated, and ends the record.
[[noreturn]] void refuse(const char* call) {
  note(std::string("unknown\t") + call);
  std::abort();
}

using OpenAt = int(int, const char*, int, ...);
using OpenStream = FILE*(const char*, const char*);

int open_at(int folder, const char* path, int flags, mode_t mode) {
  return opened(
      folder, path, flags, [&] { return next<OpenAt>("openat")(folder, path, flags, mode); }, -1);
}

FILE* open_stream(const char* path, const char* mode) {
  return opened(
      AT_FDCWD, path, flags_of(mode), [&] { return next<OpenStream>("fopen")(path, mode); },
      static_cast<FILE*>(nullptr));
}

mode_t mode_of(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, mode_t) : 0;
}

}  // namespace

#define WITH_MODE(call)                          \
  va_list arguments;                             \
  va_start(arguments, flags);                    \
  const mode_t mode = mode_of(flags, arguments); \
  va_end(arguments);                             \
  return call

extern "C" {

int open(const char* path, int flags, ...) {
  WITH_MODE(open_at(AT_FDCWD, path, flags, mode));
}
int open64(const char* path, int flags, ...) {
  WITH_MODE(open_at(AT_FDCWD, path, flags, mode));
}
int openat(int folder, const char* path, int flags, ...) {
  WITH_MODE(open_at(folder, path, flags, mode));
}
int openat64(int folder, const char* path, int flags, ...) {
  WITH_MODE(open_at(folder, path, flags, mode));
}
int creat(const char* path, mode_t mode) {
  return open_at(AT_FDCWD, path, O_CREAT | O_WRONLY | O_TRUNC, mode);
}
FILE* fopen(const char* path, const char* mode) {
  return open_stream(path, mode);
}
FILE* fopen64(const char* path, const char* mode) {
  return open_stream(path, mode);
}

ssize_t write(int fd, const void* data, size_t size) {
  const std::lock_guard lock(order());
  return written(fd, data, position(fd), [&] { return syscall(SYS_write, fd, data, size); });
}
ssize_t pwrite(int fd, const void* data, size_t size, off_t at) {
  const std::lock_guard lock(order());
  return written(fd, data, at, [&] { return syscall(SYS_pwrite64, fd, data, size, at); });
}
ssize_t pwrite64(int fd, const void* data, size_t size, off_t at) {
  return pwrite(fd, data, size, at);
}
ssize_t writev(int fd, const iovec* parts, int count) {
  ssize_t sum = 0;
  for (int i = 0; i < count; ++i) {
    const ssize_t size = write(fd, parts[i].iov_base, parts[i].iov_len);
    if (size < 0) return sum > 0 ? sum : size;
    sum += size;
    if (static_cast<size_t>(size) < parts[i].iov_len) break;
  }
  return sum;
}

int ftruncate(int fd, off_t size) {
  const std::string name = below(fd);
  return noted(name, "resize\t" + name + "\t" + std::to_string(size),
               [&] { return next<int(int, off_t)>("ftruncate")(fd, size); });
}
int ftruncate64(int fd, off_t size) {
  return ftruncate(fd, size);
}
int truncate(const char* path, off_t size) {
  const std::string name = below(AT_FDCWD, path);
  return noted(name, "resize\t" + name + "\t" + std::to_string(size),
               [&] { return next<int(const char*, off_t)>("truncate")(path, size); });
}
int truncate64(const char* path, off_t size) {
  return truncate(path, size);
}

int fsync(int fd) {
  const std::string name = below(fd);
  return noted(name, "sync\t" + name, [&] { return next<int(int)>("fsync")(fd); });
}
int syncfs(int fd) {
  return noted("all", "syncfs\t.", [&] { return next<int(int)>("syncfs")(fd); });
}
int fdatasync(int fd) {
  return fsync(fd);
}

int mkdirat(int folder, const char* path, mode_t mode) {
  const std::string name = below(folder, path);
  return noted(name, "mkdir\t" + name,
               [&] { return next<int(int, const char*, mode_t)>("mkdirat")(folder, path, mode); });
}
int mkdir(const char* path, mode_t mode) {
  return mkdirat(AT_FDCWD, path, mode);
}
int unlinkat(int folder, const char* path, int flags) {
  const std::string name = below(folder, path);
  return noted(name, "remove\t" + name,
               [&] { return next<int(int, const char*, int)>("unlinkat")(folder, path, flags); });
}
int unlink(const char* path) {
  return unlinkat(AT_FDCWD, path, 0);
}
int rmdir(const char* path) {
  return unlinkat(AT_FDCWD, path, AT_REMOVEDIR);
}
int remove(const char* path) {
  const std::string name = below(AT_FDCWD, path);
  return noted(name, "remove\t" + name, [&] { return next<int(const char*)>("remove")(path); });
}
int renameat(int from_folder, const char* from, int to_folder, const char* to) {
  const std::string name = below(from_folder, from);
  return noted(name, "rename\t" + name + "\t" + below(to_folder, to), [&] {
    return next<int(int, const char*, int, const char*)>("renameat")(from_folder, from, to_folder, to);
  });
}
int rename(const char* from, const char* to) {
  return renameat(AT_FDCWD, from, AT_FDCWD, to);
}

int link(const char* /*from*/, const char* /*to*/) {
  refuse("link");
}
int symlink(const char* /*target*/, const char* /*path*/) {
  refuse("symlink");
}
int renameat2(int /*from_folder*/, const char* /*from*/, int /*to_folder*/, const char* /*to*/,
              unsigned /*flags*/) {
  refuse("renameat2");
}

}  // extern "C"
