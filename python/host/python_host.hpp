// How the program gets at strategies in Python: it loads this library, which brings the interpreter along.
#pragma once

#include <filesystem>

namespace glocal {

struct Catalog;

/// Runs a Python file, and adds the strategies that it registers to a catalog. Throws ConfigError.
using LoadPythonPlugin = void (*)(const std::filesystem::path& file, Catalog& catalog);

/// The function that the library exports. Starts Python, as `executable` would be started, and imports the
/// package, which is in the folder `site`. Null where that fails: then `error` is told why.
inline constexpr const char* start_python_name = "glocal_start_python";
using StartPython = LoadPythonPlugin (*)(const char* executable, const char* site, const char* build_tag,
                                         void (*tell)(const char* why, void* to), void* to);

}  // namespace glocal
