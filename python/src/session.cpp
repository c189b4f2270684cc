#include "python/src/session.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cstdint>
#include <string>

#include "config/help.hpp"
#include "config/strategy_names.hpp"
#include "glocal/builtin.hpp"
#include "glocal/contract.hpp"
#include "glocal/error.hpp"
#include "glocal/plugin.hpp"
#include "python/src/conversions.hpp"
#include "python/src/errors.hpp"
#include "python/src/python_strategies.hpp"

namespace glocal::python {
namespace {

py::module_ registered() {
  return py::module_::import("glocal.strategies");
}

void add_all(const py::object& strategies, Catalog& catalog) {
  for (const py::handle& strategy : strategies)
    add_strategy(catalog, read_strategy(py::reinterpret_borrow<py::object>(strategy)));
}

std::string listed(const std::string& kind, const Catalog& catalog) {
  if (!kind.empty() && registry_of(kind, catalog) == nullptr)
    throw ConfigError({unknown_kind(kind, catalog)});
  std::string text;
  for (const RegistryBase* registry : catalog.registries()) {
    if (!kind.empty() && registry->kind() != kind) continue;
    text += fmt::format("{}{}\n{}", text.empty() ? "" : "\n", registry->kind(), list_strategies(*registry));
  }
  return text;
}

std::string described(const std::string& name, const Catalog& catalog) {
  if (auto text = help(name, catalog)) return *std::move(text);
  throw py::value_error("there is no strategy '" + name + "'; glocal.list_strategies() names all");
}

}  // namespace

Session::Session() {
  register_builtin_strategies(catalog);
  plugins.hand_over(".py", load_python_plugin);
}

void Session::load(const std::filesystem::path& plugin) {
  plugins.load(plugin);
  for (const std::filesystem::path& file : plugins.loaded()) static_cast<void>(hashes.of(file));
}

std::shared_ptr<Session> new_session() {
  auto session = std::make_shared<Session>();
  for (const py::handle& file : registered().attr("plugin_files")()) session->load(file.cast<std::string>());
  for (RegistryBase* registry : session->catalog.registries()) registry->set_origin("Python");
  add_all(registered().attr("registered")(), session->catalog);
  return session;
}

std::shared_ptr<Session> current_session() {
  // Never destroyed: at the end of the process Python is gone before it would be.
  static auto& session = *new std::shared_ptr<Session>;
  static long known = -1;
  const auto version = registered().attr("version")().cast<long>();
  if (session && version == known) return session;
  session = new_session();
  known = version;
  return session;
}

void load_python_plugin(const std::filesystem::path& file, Catalog& catalog) {
  const py::gil_scoped_acquire gil;
  try {
    add_all(registered().attr("execute")(file.string()), catalog);
  } catch (const py::error_already_set& error) {
    throw ConfigError(file, "cannot be loaded: " + told(error));
  }
}

void bind_session(py::module_& module) {
  module.def(
      "list_strategies", [](const std::string& kind) { return listed(kind, current_session()->catalog); },
      py::arg("kind") = "", "All strategies, or those of a kind (matcher, clusterer, ...), a line each.");
  module.def(
      "describe", [](const std::string& name) { return described(name, current_session()->catalog); },
      py::arg("name"), "What a strategy does, and its parameters with types, bounds and defaults.");
  module.def(
      "broken_promises",
      [](const std::string& kind, const std::string& name, const py::list& overrides) {
        const auto session = current_session();
        const StrategyChoice choice = chosen_strategy(kind, name, overrides_of(overrides), session->catalog);
        const py::gil_scoped_release others_may;
        return broken_promises(kind, choice, session->catalog);
      },
      py::arg("kind"), py::arg("name"), py::arg("overrides"));
  // For the program, which has a catalog of its own: what it must have in common with this module, and what
  // loads plugins into it.
  module.attr("_build_tag") = build_tag();
  module.attr("_loader") = reinterpret_cast<std::uintptr_t>(&load_python_plugin);
}

}  // namespace glocal::python
