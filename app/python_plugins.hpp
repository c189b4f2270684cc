// Plugins that are Python files.
#pragma once

#include <filesystem>

#include "glocal/catalog.hpp"

namespace glocal::app {

/// Adds the strategies that a Python file registers with the package `glocal`. The first one starts Python:
/// that of `GLOCAL_PYTHON`, or the first of python3 of PATH and Debian's that has the package; the one of the
/// build folder counts, too. Throws ConfigError that tells what was tried.
void load_python_plugin(const std::filesystem::path& file, Catalog& catalog);

}  // namespace glocal::app
