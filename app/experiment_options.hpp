// The experiment file and what may be changed of it on the command line; the same for every subcommand that
// takes one.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "glocal/experiment.hpp"

namespace glocal::app {

struct ExperimentOptions {
  std::string file;
  std::vector<std::string> set;  ///< "path=value", as given with --set.
  /// As given: what may be a seed is said once, for files and options alike.
  std::optional<std::string> seed, threads;

  /// Adds FILE, --set, --seed and --threads. This object must live as long as the command.
  void add_to(CLI::App& command);
  /// Everything but FILE, for commands that take several files.
  void add_overrides_to(CLI::App& command);

  /// Only --set, with a help text of its own.
  void add_set_to(CLI::App& command, const std::string& help);

  /// What was given with --set. Throws ConfigError for what is not of the form path=value.
  [[nodiscard]] std::vector<Override> overrides() const;

  /// Loads the plugins the file names, too. Throws ConfigError.
  [[nodiscard]] Experiment read(Context& context) const { return read(file, context); }
  [[nodiscard]] Experiment read(const std::string& other_file, Context& context) const;
  /// With what its variants change; the experiment itself, without a name, if it has none.
  [[nodiscard]] std::vector<Variant> read_variants(const std::string& other_file, Context& context) const;

 private:
  /// All that is changed; loads the plugins that are then named.
  [[nodiscard]] std::vector<Override> load_plugins(const std::string& other_file, Context& context) const;
};

/// The experiment of a results folder. Files that are only read must not bring code along: the plugins that
/// it names have been loaded already, under these file names, or are loaded now if they are trusted.
[[nodiscard]] Experiment read_stored_experiment(const std::filesystem::path& effective, bool trust_plugins,
                                                Context& context);

}  // namespace glocal::app
