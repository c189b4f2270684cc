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
  std::vector<std::string> methods, cases;  ///< Names or files.
  std::string seeds;                        ///< "1..3"; empty: those of the file.
  std::string suite, share;                 ///< "planar@1", "0.05"; empty: none, and all.

  /// Adds FILE, --method, --case, --seeds, --suite, --share, --set, --seed and --threads. FILE may be left
  /// out where a method and a case or a suite are given. This object must live as long as the command.
  void add_to(CLI::App& command);
  /// --method, --case, --seeds, --suite and --share.
  void add_products_to(CLI::App& command);
  /// --set, --seed and --threads.
  void add_overrides_to(CLI::App& command);

  /// Only --set, with a help text of its own.
  void add_set_to(CLI::App& command, const std::string& help);

  /// What was given, as values of an experiment. Throws ConfigError for what is not of the form path=value.
  [[nodiscard]] std::vector<Override> overrides() const;

  /// All of it but the file, as words of a command line.
  [[nodiscard]] std::vector<std::string> words() const;

  /// A line for an experiment that is written for them: what is changed and not in there, or nothing.
  [[nodiscard]] std::string comment() const;

  /// Loads the plugins the file names, too. Throws ConfigError.
  [[nodiscard]] Experiment read(Context& context) const { return read(file, context); }
  [[nodiscard]] Experiment read(const std::string& other_file, Context& context) const;
  /// With what its variants change; the experiment itself, without a name, if it has none.
  [[nodiscard]] std::vector<Variant> read_variants(const std::string& other_file, Context& context) const;

 private:
  /// Throws ConfigError without a file, or what stands for one.
  void require_file() const;
  /// All that is changed; loads the plugins that are then named.
  [[nodiscard]] std::vector<Override> load_plugins(const std::string& other_file, Context& context) const;
};

/// The experiment of a results folder. Files that are only read must not bring code along: the plugins that
/// it names have been loaded already, under these file names, or are loaded now if they are trusted.
[[nodiscard]] Experiment read_stored_experiment(const std::filesystem::path& effective, bool trust_plugins,
                                                Context& context);

}  // namespace glocal::app
