// The strategies that Python has at hand: glocal's own, those of plugins, and those that were registered.
#pragma once

#include <pybind11/pybind11.h>

#include <filesystem>
#include <memory>

#include "evaluation/results/provenance.hpp"
#include "glocal/catalog.hpp"
#include "loading/plugin_loader.hpp"

namespace glocal::python {

namespace py = pybind11;

/// A catalog with what loads plugins into it. Whoever uses its strategies keeps it.
struct Session {
  Session();
  void load(const std::filesystem::path& plugin);
  Catalog catalog;
  PluginLoader plugins{catalog};
  /// Of the plugins as they were loaded.
  FileHashes hashes;
};

/// That of now. Classes that are registered later, or again, are in a new one. The GIL is held.
[[nodiscard]] std::shared_ptr<Session> current_session();

/// A new one, for who loads plugins that others have nothing to do with. The GIL is held.
[[nodiscard]] std::shared_ptr<Session> new_session();

/// Runs a Python file, and adds the strategies that it registers to a catalog. The GIL need not be held.
void load_python_plugin(const std::filesystem::path& file, Catalog& catalog);

void bind_session(py::module_& module);

}  // namespace glocal::python
