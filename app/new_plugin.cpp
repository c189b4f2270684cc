// glocal new-plugin: a plugin to begin with.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "app/commands.hpp"
#include "app/embedded_files.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/results/output_folder.hpp"
#include "glocal/error.hpp"

namespace glocal::app {
namespace {

struct NewPluginOptions {
  std::string kind;
  std::string name;
  std::string folder;
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
  if (!is_snake_case(options.name)) {
    faults.push_back(
        {"", 0, 0,
         fmt::format(
             "the name '{}' must be at most 60 small letters, digits and '_', beginning with a letter: "
             "it becomes a file and a class",
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
  if (kind == "map_source" || kind == "observation_source" || kind == "cloud_registrar")
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
      {"MAP", options.kind == "map_source" ? options.name : simulation},
      {"OBSERVATIONS", options.kind == "observation_source" ? options.name : simulation},
      {"LOCALIZER", localizer_with(options.kind, options.name)}};

  OutputFolder folder(options.folder, false);
  folder.append("CMakeLists.txt", filled(embedded_file("CMakeLists.txt"), values));
  folder.append(options.name + ".cpp", filled(embedded_file(options.kind + ".cpp"), values));
  folder.append("experiment.yaml", filled(embedded_file("experiment.yaml"), values));
  folder.append("world.yaml", filled(embedded_file("world.yaml"), values));
  folder.commit();
  answer(
      "A {} called {} in {}. Build it, test it, run it:\n"
      "  cmake -S {} -B {}/build && cmake --build {}/build\n"
      "  ctest --test-dir {}/build\n"
      "  glocal run {}/experiment.yaml\n",
      options.kind, options.name, options.folder, options.folder, options.folder, options.folder,
      options.folder, options.folder);
}

}  // namespace

void add_new_plugin(CLI::App& app, Context& context) {
  auto options = std::make_shared<NewPluginOptions>();
  CLI::App* command = app.add_subcommand(
      "new-plugin",
      "Write a plugin to begin with: a strategy, how to build it, an experiment that tests it.");
  command->add_option("KIND", options->kind, "matcher, local_mapper, ... (see glocal list)")->required();
  command->add_option("NAME", options->name, "Name of the strategy, in snake_case")->required();
  command->add_option("DIR", options->folder, "Folder for the files")->required();
  command->callback([options, &context] { new_plugin(*options, context.catalog); });
}

}  // namespace glocal::app
