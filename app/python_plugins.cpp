#include "app/python_plugins.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdlib>
#include <cstring>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "app/programs.hpp"
#include "glocal/error.hpp"
#include "glocal/plugin.hpp"
#include "python/host/python_host.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

/// A Python that has the package.
struct PythonWithPackage {
  std::string executable;
  fs::path package;  ///< Its folder.
};

/// Where the package lies when program and package were built together, and not installed.
fs::path build_site() {
  std::error_code error;
  return fs::read_symlink("/proc/self/exe", error).parent_path().parent_path() / "python";
}

/// Tells a Python's executable, and where the package is.
constexpr const char* question =
    "import sys\n"
    "sys.path.append(sys.argv[1])\n"
    "import glocal\n"
    "print(sys.executable)\n"
    "print(glocal.__path__[0])\n";

/// The last line that is not empty: that of a traceback which says what is wrong.
std::string last_line(const std::string& text) {
  std::istringstream lines(text);
  std::string last;
  for (std::string line; std::getline(lines, line);) {
    if (!line.empty()) last = line;
  }
  return last;
}

/// None, with the reason, if it has no package.
std::optional<PythonWithPackage> ask(const std::string& python, std::string& why_not) {
  const Ended ended = ask_program({python, "-c", question, build_site().string()});
  std::istringstream lines(ended.out);
  PythonWithPackage found;
  std::string package;
  if (ended.exit_code == 0 && std::getline(lines, found.executable) && std::getline(lines, package)) {
    found.package = package;
    return found;
  }
  why_not += fmt::format("{}{}: {}", why_not.empty() ? "" : "; ", python,
                         ended.error != 0 ? std::strerror(ended.error) : last_line(ended.err));
  return std::nullopt;
}

PythonWithPackage find_python() {
  std::vector<std::string> candidates = {"python3", "/usr/bin/python3"};
  if (const char* named = std::getenv("GLOCAL_PYTHON")) candidates = {named};
  std::string tried;
  for (const std::string& python : candidates) {
    if (auto found = ask(python, tried)) return *std::move(found);
  }
  throw std::runtime_error(
      fmt::format("strategies in Python need the package glocal ({}); install it, as docs/python.md tells, "
                  "or name a Python that has it in the environment variable GLOCAL_PYTHON",
                  tried));
}

LoadPythonPlugin start_python() {
  const PythonWithPackage python = find_python();
  const fs::path host = python.package / "_host.so";
  // Modules of Python are not linked with the interpreter: they find it among what is global.
  void* library = dlopen(host.c_str(), RTLD_NOW | RTLD_GLOBAL | RTLD_NODELETE);
  if (library == nullptr)
    throw std::runtime_error(
        fmt::format("{}; install Python's shared library (Debian: libpython3-dev), and build the "
                    "package again",
                    dlerror()));
  const auto start = reinterpret_cast<StartPython>(dlsym(library, start_python_name));
  if (start == nullptr)
    throw std::runtime_error(host.string() + " is not of this version; install the package again");
  std::string error;
  const auto tell = [](const char* why, void* to) { *static_cast<std::string*>(to) = why; };
  const LoadPythonPlugin load = start(python.executable.c_str(), python.package.parent_path().c_str(),
                                      build_tag().c_str(), tell, &error);
  if (load == nullptr)
    throw std::runtime_error(
        fmt::format("{} with the package in {}: {}", python.executable, python.package.string(), error));
  return load;
}

}  // namespace

void load_python_plugin(const fs::path& file, Catalog& catalog) {
  if (std::error_code error; !fs::is_regular_file(file, error))
    throw ConfigError(file, "there is no such file; name a Python file that registers strategies");
  static LoadPythonPlugin load = nullptr;
  try {
    if (load == nullptr) load = start_python();
  } catch (const std::runtime_error& why) {
    throw ConfigError(file, why.what());
  }
  load(file, catalog);
}

}  // namespace glocal::app
