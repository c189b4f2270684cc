#include "app/experiment_options.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "config/scalars.hpp"
#include "glocal/error.hpp"

namespace glocal::app {

void ExperimentOptions::add_to(CLI::App& command) {
  command.add_option("FILE", file, "Experiment file (YAML); not needed with --method and --case");
  add_products_to(command);
  add_overrides_to(command);
}

void ExperimentOptions::add_products_to(CLI::App& command) {
  command.add_option("--method", methods, "Localizer: a name (glocal list methods) or a file (repeatable)")
      ->allow_extra_args(false);
  command
      .add_option("--case", cases, "Map, drive and starts: a name (glocal list cases) or a file (repeatable)")
      ->allow_extra_args(false);
  command.add_option("--seeds", seeds, "Run all with each of these seeds: 1..3, or [1, 5, 9]");
  CLI::Option* of_suite = command.add_option(
      "--suite", suite,
      "Cases and seeds: those of a suite, as planar@1 (glocal list suites), or of its file");
  command.add_option("--share", share, "Run a fixed share of the suite's starts: 0.05")->needs(of_suite);
}

void ExperimentOptions::add_overrides_to(CLI::App& command) {
  add_set_to(command, "Change a value: localizer.matcher.ransam.iterations=50000 (repeatable)");
  command.add_option("--seed", seed, "Change the seed");
  command.add_option("--threads", threads, "Change the number of threads");
}

void ExperimentOptions::add_set_to(CLI::App& command, const std::string& help) {
  command.add_option("--set", set, help)->allow_extra_args(false);
}

std::vector<Override> ExperimentOptions::overrides() const {
  std::vector<Override> overrides;
  std::vector<Fault> faults;
  for (const std::string& text : set) {
    const std::size_t equals = text.find('=');
    if (equals == std::string::npos || equals == 0) {
      faults.push_back({"--set " + text, 0, 0, "not of the form path=value"});
    } else {
      overrides.emplace_back(text.substr(0, equals), text.substr(equals + 1));
    }
  }
  if (!faults.empty()) throw ConfigError(faults);
  const auto add_list = [&](const char* key, const std::vector<std::string>& names) {
    std::vector<std::string> items;
    for (const std::string& name : names) items.push_back(to_yaml(std::string_view(name)));
    if (!items.empty()) overrides.emplace_back(key, fmt::format("[{}]", fmt::join(items, ", ")));
  };
  add_list("methods", methods);
  add_list("cases", cases);
  if (!seeds.empty()) overrides.emplace_back("seeds", seeds);
  if (!suite.empty()) overrides.emplace_back("suite", to_yaml(std::string_view(suite)));
  if (!share.empty()) overrides.emplace_back("share", share);
  // The last value counts: --set may say another name.
  if (file.empty() && suite.empty() && !methods.empty())
    overrides.emplace(overrides.begin(), "name", "comparison");
  return overrides;
}

std::vector<std::string> ExperimentOptions::words() const {
  std::vector<std::string> words;
  const auto add = [&](const char* option, const std::vector<std::string>& values) {
    for (const std::string& value : values) words.insert(words.end(), {option, value});
  };
  add("--method", methods);
  add("--case", cases);
  if (!seeds.empty()) add("--seeds", {seeds});
  if (!suite.empty()) add("--suite", {suite});
  if (!share.empty()) add("--share", {share});
  add("--set", set);
  if (seed) add("--seed", {*seed});
  if (threads) add("--threads", {*threads});
  return words;
}

std::string ExperimentOptions::comment() const {
  std::string text = fmt::format("{}", fmt::join(words(), " "));
  if (text.empty()) return text;
  std::ranges::replace(text, '\n', ' ');
  return fmt::format("# Not in here, but changed on the command line: {}\n", text);
}

void ExperimentOptions::require_file() const {
  if (!file.empty() || (!methods.empty() && (!cases.empty() || !suite.empty()))) return;
  throw ConfigError(
      "",
      "what is to be run? Give an experiment file, or --method and --case or --suite (glocal list methods, "
      "glocal list cases, glocal list suites)");
}

std::vector<Override> ExperimentOptions::load_plugins(const std::string& other_file, Context& context) const {
  std::vector<Override> all = overrides();
  if (seed) all.emplace_back("seed", *seed);
  if (threads) all.emplace_back("threads", *threads);
  for (const FilePath& plugin : read_plugins(other_file, all)) context.plugins.load(plugin.resolved);
  return all;
}

Experiment ExperimentOptions::read(const std::string& other_file, Context& context) const {
  if (other_file.empty()) require_file();
  const std::vector<Override> all = load_plugins(other_file, context);
  Experiment experiment = read_experiment(other_file, all, context.catalog);
  experiment.plugins = context.plugins.named();
  return experiment;
}

std::vector<Variant> ExperimentOptions::read_variants(const std::string& other_file, Context& context) const {
  if (other_file.empty()) require_file();
  const std::vector<Override> all = load_plugins(other_file, context);
  std::vector<Variant> variants = glocal::read_variants(other_file, all, context.catalog);
  for (Variant& variant : variants) variant.experiment.plugins = context.plugins.named();
  return variants;
}

Experiment read_stored_experiment(const std::filesystem::path& effective, bool trust_plugins,
                                  Context& context) {
  const auto is_loaded = [&](const FilePath& plugin) {
    const auto& loaded = context.plugins.loaded();
    return std::any_of(loaded.begin(), loaded.end(), [&](const std::filesystem::path& file) {
      return file.filename() == plugin.resolved.filename();
    });
  };
  std::vector<Fault> faults;
  for (const FilePath& plugin : read_plugins(effective, {})) {
    if (is_loaded(plugin)) continue;
    if (trust_plugins) {
      context.plugins.load(plugin.resolved);
    } else {
      faults.push_back(
          {effective.string(), 0, 0,
           fmt::format("needs the plugin {0}, which is native code: name it with --plugin {0}, or "
                       "take --trust-plugins if you trust this folder",
                       plugin.resolved.string())});
    }
  }
  if (!faults.empty()) throw ConfigError(faults);
  // Those that are loaded may lie elsewhere by now.
  Experiment experiment = read_experiment(effective, {{"plugins", "[]"}}, context.catalog);
  experiment.plugins = context.plugins.named();
  return experiment;
}

}  // namespace glocal::app
