// glocal figures: the paper's figures, drawn from what runs left, and what a sweep has taught.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/programs.hpp"
#include "app/results_at_hand.hpp"
#include "config/text_file.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/sweeps/analysis.hpp"
#include "evaluation/sweeps/sweep_report.hpp"
#include "glocal/error.hpp"
#include "report/figures/figures_input.hpp"
#include "report/figures/figures_script.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

struct FiguresOptions {
  std::vector<std::string> folders;
  std::string out;
  std::string python;
  std::size_t trial = 0;
  bool sweep = false;
  bool force = false;
};

fs::path script_of(const FiguresOptions& options) {
  return fs::absolute(options.out) / "figures.py";
}

/// Only a folder that figures were drawn in before, or a new one, is written to.
void check_out(const FiguresOptions& options) {
  const auto refuse = [&](const char* why) { throw ConfigError(options.out, why); };
  if (!fs::exists(options.out)) return;
  if (!fs::is_directory(options.out)) refuse("is no folder; name one for the figures");
  if (!options.force && !fs::is_empty(options.out) && !fs::exists(script_of(options)))
    refuse("holds other files, and no figures.py; choose another folder, or write there with --force");
}

/// Every fault of all that is named, at once. Returns the folders of results.
std::vector<std::string> checked_folders(const FiguresOptions& options) {
  std::vector<std::string> folders;
  FaultCollector faults;
  faults.collect([&] { check_out(options); });
  for_each_results_folder(options.folders, faults, [&](const fs::path& folder) {
    check_figures_input(folder, options.trial, faults);
    folders.push_back(folder.string());
  });
  faults.report();
  return folders;
}

/// The user may have changed the one that is there.
void write_script(const FiguresOptions& options) {
  const fs::path script = script_of(options);
  if (!options.force && fs::exists(script)) {
    if (read_text_file(script) != figures_script())
      spdlog::info("{}: drawn with this as it has been changed; --force writes it anew", script.string());
    return;
  }
  write_file(script, figures_script(), options.force);
}

/// What glocal sweep tells of the one folder.
std::string checked_sweep(const FiguresOptions& options) {
  if (options.folders.size() > 1)
    throw ConfigError(options.folders.at(1), "is one folder too many; name that of one sweep");
  check_out(options);
  const SweepAnalysis analysis = analyse_sweep(read_sweep(options.folders.front()));
  if (analysis.parameters.effects.empty())
    throw ConfigError(
        options.folders.front(),
        "no parameter varies, so that there is nothing to draw; name the folder of an experiment with "
        "variants.grid, zip or sample");
  return json_text(analysis);
}

/// Why a Python is of no use here; none if it is.
std::optional<std::string> why_useless(const std::string& python) {
  const Ended ended = ask_program({python, "-c", "import matplotlib"});
  if (ended.error != 0) return std::strerror(ended.error);
  if (ended.exit_code != 0) return "cannot import matplotlib";
  return std::nullopt;
}

/// A Python that has matplotlib: `named`, or, if that is empty, python3 of PATH, or else Debian's. Throws
/// RunError that tells what was tried.
std::string python_with_matplotlib(const std::string& named) {
  std::vector<std::string> candidates = {named};
  if (named.empty()) candidates = {"python3", "/usr/bin/python3"};
  std::string tried;
  for (const std::string& python : candidates) {
    const auto why = why_useless(python);
    if (!why) return python;
    tried += fmt::format("{}{}: {}", tried.empty() ? "" : "; ", python, *why);
  }
  throw RunError(
      fmt::format("figures are drawn by Python with matplotlib ({}); install Debian's package "
                  "python3-matplotlib, or name another Python with --python",
                  tried));
}

void run_script(const FiguresOptions& options, const std::string& python,
                const std::vector<std::string>& input) {
  write_script(options);
  std::vector<std::string> words = {python, script_of(options), "--out", options.out};
  words.insert(words.end(), input.begin(), input.end());
  if (const int code = run_program(words); code != 0) {
    throw RunError(
        fmt::format("{}: ended with exit code {}; no figures were written. If it has been changed, "
                    "--force writes it anew",
                    script_of(options).string(), code));
  }
}

void draw_figures(const FiguresOptions& options) {
  if (options.sweep) {
    const std::string sweep = checked_sweep(options);
    const std::string python = python_with_matplotlib(options.python);
    const fs::path file = fs::absolute(options.out) / "sweep.json";
    write_file(file, sweep);
    run_script(options, python, {"--sweep", file});
    return;
  }
  std::vector<std::string> input = {"--trial", std::to_string(options.trial), "--"};
  const std::vector<std::string> folders = checked_folders(options);
  input.insert(input.end(), folders.begin(), folders.end());
  run_script(options, python_with_matplotlib(options.python), input);
}

}  // namespace

void add_figures(CLI::App& app, Context& /*context*/) {
  auto options = std::make_shared<FiguresOptions>();
  CLI::App* command =
      app.add_subcommand("figures", "Draw the paper's Fig. 3, 4 and 5 from results, as PDF, SVG and PNG.");
  command->add_option("DIR", options->folders, "Folders of results, or folders that hold some")->required();
  command->add_option("-o,--out", options->out, "Folder for the figures and the script that draws them")
      ->required();
  CLI::Option* trial =
      command->add_option("--trial", options->trial, "Number of the trial, from 0 (default: 0)");
  command
      ->add_flag("--sweep", options->sweep,
                 "Draw what glocal sweep tells instead: effects of parameters, and a map of two")
      ->excludes(trial);
  command->add_option("--python", options->python,
                      "Python with matplotlib (default: python3, or else /usr/bin/python3)");
  command->add_flag("--force", options->force, "Write figures.py anew, and into any folder");
  command->callback([options] { draw_figures(*options); });
}

}  // namespace glocal::app
