// glocal new-plugin: a plugin to begin with.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/commands.hpp"
#include "app/embedded_files.hpp"
#include "app/standard_streams.hpp"
#include "config/strategy_names.hpp"
#include "evaluation/results/output_folder.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

struct NewPluginOptions {
  std::string kind;
  std::string name;
  std::string out;
  bool python = false;

  [[nodiscard]] const std::string& folder() const { return out.empty() ? name : out; }
};

/// Fit for a file, a CMake target and, in CamelCase, a class.
bool is_snake_case(std::string_view name) {
  return !name.empty() && name.front() >= 'a' && name.front() <= 'z' && name.size() <= 60 &&
         std::all_of(name.begin(), name.end(),
                     [](char c) { return (c >= 'a' && c <= 'z') || (c >= '0' && c <= '9') || c == '_'; });
}

std::string camel_case(std::string_view snake_case) {
  std::string result;
  bool begins_word = true;
  for (const char c : snake_case) {
    if (c != '_') result += begins_word ? static_cast<char>(std::toupper(c)) : c;
    begins_word = c == '_';
  }
  return result;
}

std::string filled(std::string text, const std::vector<std::pair<std::string, std::string>>& values) {
  for (const auto& [name, value] : values) {
    const std::string place = "@" + name + "@";
    for (std::size_t at = text.find(place); at != std::string::npos;
         at = text.find(place, at + value.size())) {
      text.replace(at, place.size(), value);
    }
  }
  return text;
}

void check(const NewPluginOptions& options, const Catalog& catalog) {
  std::vector<Fault> faults;
  const RegistryBase* registry = registry_of(options.kind, catalog);
  if (registry == nullptr) faults.push_back(unknown_kind(options.kind, catalog));
  if (registry != nullptr && options.python && !has_embedded_file(options.kind + ".py")) {
    faults.push_back({"--python", 0, 0,
                      fmt::format("there are no strategies of the kind {} in Python; leave it out for one in "
                                  "C++",
                                  options.kind)});
  }
  if (!is_snake_case(options.name)) {
    faults.push_back(
        {"", 0, 0,
         fmt::format(
             "the name '{}' must be at most 60 small letters, digits and '_', beginning with a letter: "
             "it becomes a file and a class",
             options.name)});
  }
  constexpr std::array<std::string_view, 8> of_cmake = {"all",     "clean",   "edit_cache",    "help",
                                                        "install", "package", "rebuild_cache", "test"};
  if (!options.python && std::ranges::find(of_cmake, options.name) != of_cmake.end()) {
    faults.push_back({"", 0, 0,
                      fmt::format("'{}' is a target of CMake's own, and the plugin's would have this name; "
                                  "choose another name",
                                  options.name)});
  }
  const StrategyInfo* taken = registry == nullptr ? nullptr : registry->find(options.name);
  if (taken != nullptr) {
    faults.push_back({"", 0, 0,
                      fmt::format("there is a {} '{}' already, from {}; choose another name", options.kind,
                                  options.name, taken->origin)});
  }
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

/// The localizer's section of an experiment that uses the strategy.
std::string localizer_with(const std::string& kind, const std::string& name) {
  if (kind == "map_source" || kind == "observation_source" || kind == "cloud_registrar" ||
      kind == "message_link")
    return "localizer: {}";
  if (kind == "contact_index")
    return fmt::format("localizer:\n  matcher:\n    ransam: {{contact: {}}}", name);
  return fmt::format("localizer:\n  {}: {}", kind, name);
}

void new_plugin(const NewPluginOptions& options, const Catalog& catalog) {
  check(options, catalog);
  const std::string simulation = "{simulation: {world: world.yaml}}";
  const std::vector<std::pair<std::string, std::string>> values = {
      {"NAME", options.name},
      {"CLASS", camel_case(options.name)},
      {"KIND", options.kind},
      {"PLUGIN", options.python ? options.name + ".py" : "build/" + options.name + ".so"},
      {"MAP", options.kind == "map_source" ? options.name : simulation},
      {"OBSERVATIONS", options.kind == "observation_source" ? options.name : simulation},
      {"LOCALIZER", localizer_with(options.kind, options.name)}};

  const std::string& out = options.folder();
  if (std::filesystem::is_directory(out) && !std::filesystem::is_empty(out))
    throw ConfigError(out, "the folder exists and is not empty; choose another one with --out");
  OutputFolder folder(out, false);
  const auto write = [&](const std::string& name, const std::string& of_template) {
    folder.append(name, filled(embedded_file(of_template), values));
  };
  if (options.python) {
    write(options.name + ".py", options.kind + ".py");
    write("test_" + options.name + ".py", "test_strategy.py");
  } else {
    write("CMakeLists.txt", "CMakeLists.txt");
    write(options.name + ".cpp", options.kind + ".cpp");
  }
  write("experiment.yaml", "experiment.yaml");
  write("world.yaml", "world.yaml");
  folder.commit();
  const std::string test = options.python ? fmt::format("  python3 -m pytest {}\n", out)
                                          : fmt::format(
                                                "  cmake -S {0} -B {0}/build && cmake --build {0}/build\n"
                                                "  ctest --test-dir {0}/build\n",
                                                out);
  answer("A {} called {} in {}. {} it, run it:\n{}  glocal run {}/experiment.yaml\n", options.kind,
         options.name, out, options.python ? "Test" : "Build it, test", test, out);
}

}  // namespace

void add_new_plugin(CLI::App& app, Context& context) {
  auto options = std::make_shared<NewPluginOptions>();
  CLI::App* command = app.add_subcommand(
      "new-plugin",
      "Write a plugin to begin with: a strategy, how to build it, tests, and an experiment that uses it.");
  command->add_option("KIND", options->kind, "matcher, local_mapper, ... (see glocal list)")->required();
  command->add_option("NAME", options->name, "Name of the strategy, in snake_case")->required();
  command->add_flag("--python", options->python, "A plugin in Python, which needs no building");
  command->add_option("-o,--out", options->out, "Folder for the files (default: NAME)");
  command->callback([options, &context] { new_plugin(*options, context.catalog); });
}

}  // namespace glocal::app
