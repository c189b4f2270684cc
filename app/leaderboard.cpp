// glocal leaderboard: what methods have come to on suites, kept as data.
#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/commands.hpp"
#include "app/experiment_options.hpp"
#include "app/interrupts.hpp"
#include "app/job_scripts.hpp"
#include "app/plain_suite.hpp"
#include "app/standard_streams.hpp"
#include "config/builtin_parts.hpp"
#include "config/suites.hpp"
#include "config/variants.hpp"
#include "evaluation/leaderboard/board_entry.hpp"
#include "evaluation/leaderboard/board_history.hpp"
#include "evaluation/leaderboard/board_tables.hpp"
#include "evaluation/leaderboard/entries_of_runs.hpp"
#include "evaluation/leaderboard/imported.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/file_lock.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "evaluation/running/pins.hpp"
#include "glocal/error.hpp"
#include "report/board_page.hpp"
#include "report/page_files.hpp"
#include "version.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

struct BoardOptions {
  std::string board;  ///< Folder; empty: that of glocal.
  std::string suite;  ///< "planar@1", or its file; empty: all.
  std::vector<std::string> methods, cases;
  bool by_case = false, by_kind = false, markdown = false, force = false;
  std::string share = "0.01";
  std::string results, poses, out, revision;
  std::string page;  ///< File; empty: tables are printed.

  [[nodiscard]] fs::path folder() const {
    return board.empty() ? configs_folder().parent_path() / "leaderboard" : fs::path(board);
  }
  [[nodiscard]] fs::path history() const { return folder() / "history.jsonl"; }
  [[nodiscard]] bool wants(const std::string& method) const {
    return methods.empty() || std::find(methods.begin(), methods.end(), method) != methods.end();
  }
};

/// The suites that are meant: the one that is named, or all of which the leaderboard has entries.
std::vector<Suite> suites_of(const BoardOptions& options) {
  if (!options.suite.empty()) return {read_suite(options.suite)};
  std::vector<Suite> suites;
  for (const BuiltinPart& part : builtin_parts(PartKind::suite)) {
    Suite suite = read_suite(part.name);
    if (!entry_files(options.folder(), suite.id()).empty()) suites.push_back(std::move(suite));
  }
  return suites;
}

std::vector<BoardEntry> entries_of(const BoardOptions& options, const Suite& suite) {
  std::vector<BoardEntry> entries;
  for (const fs::path& file : entry_files(options.folder(), suite.id())) {
    if (!options.wants(file.stem().string())) continue;
    entries.push_back(read_entry(file));
    require_whole(entries.back(), suite, file);
  }
  return entries;
}

[[noreturn]] void refuse_empty(const BoardOptions& options) {
  throw ConfigError(options.folder(),
                    fmt::format("has no results{}{}{}{} yet; glocal leaderboard add brings some",
                                options.suite.empty() ? "" : " of ", options.suite,
                                options.methods.empty() ? "" : " by ", fmt::join(options.methods, " or ")));
}

void check_case_names(const BoardOptions& options, const Suite& suite) {
  for (const std::string& name : options.cases) {
    if (suite.find_case(name) == nullptr)
      throw ConfigError("--case " + name, suite.id() + " has no such case");
  }
}

void show(const BoardOptions& options) {
  const std::vector<Suite> suites = suites_of(options);
  Report report;
  if (options.suite.empty()) {
    std::vector<std::string> names;
    std::vector<BoardEntry> entries;
    for (const Suite& suite : suites) {
      names.push_back(suite.id());
      for (BoardEntry& entry : entries_of(options, suite)) entries.push_back(std::move(entry));
    }
    if (entries.empty()) refuse_empty(options);
    report = board_overview(names, entries);
  } else {
    check_case_names(options, suites.front());
    const std::vector<BoardEntry> entries = entries_of(options, suites.front());
    if (entries.empty()) refuse_empty(options);
    report = options.by_kind ? kinds_table(suites.front(), entries)
                             : board_tables(suites.front(), entries, {options.by_case, options.cases});
  }
  answer(options.markdown ? as_markdown(report) : as_text(report));
}

void write_board_page(const BoardOptions& options) {
  std::vector<SuiteBoard> boards;
  for (Suite& suite : suites_of(options)) {
    std::vector<BoardEntry> entries = entries_of(options, suite);
    if (!entries.empty()) boards.push_back({std::move(suite), std::move(entries)});
  }
  if (boards.empty()) refuse_empty(options);
  const fs::path file = fs::absolute(options.page).lexically_normal();
  write_page(file, options.suite.empty() ? "Leaderboard" : "Leaderboard: " + boards.front().suite.id(),
             board_page(boards, read_history(options.history())), {.replace = options.force}, board_text);
  answer("{}\n", file.string());
}

/// What makes an entry anew.
std::string renewal(const BoardOptions& options, const Suite& suite, const BoardEntry& entry) {
  const auto builtin = find_builtin_part(PartKind::suite, suite.name);
  const bool is_builtin = builtin && builtin->file == suite.file;
  const std::string named = is_builtin ? entry.suite : shell_word(suite.file.string());
  return fmt::format("{2} --out results/{0}/{1} && glocal leaderboard add results/{0}/{1}{3}{4} --force",
                     entry.suite, entry.method, entry.command(named), is_builtin ? "" : " --suite " + named,
                     options.board.empty() ? "" : " --board " + shell_word(options.board));
}

void require_place(const BoardOptions& options, const BoardEntry& entry) {
  if (!is_folder_name(entry.method))
    throw ConfigError(options.results,
                      fmt::format("'{}' is no name of a method: it is that of a file; {}", entry.method,
                                  options.methods.empty() ? "run it with --method FILE"
                                                          : "give another one with --method"));
  const fs::path file = entry_file(options.folder(), entry.suite, entry.method);
  if (fs::exists(file) && !options.force)
    throw ConfigError(file, "is there already; --force replaces it, and compares both");
}

/// How an entry differs from that which it replaces.
std::string difference_text(const fs::path& before, const BoardEntry& entry) {
  try {
    return paired_text(read_entry(before), entry);
  } catch (const ConfigError& error) {
    return fmt::format("{}; it is replaced\n", error.what());
  }
}

/// Writes an entry and its line of the history.
void store(const BoardOptions& options, const BoardEntry& entry) {
  const fs::path file = entry_file(options.folder(), entry.suite, entry.method);
  const fs::path history = options.history();
  make_folders_above(history);
  // Several may add to one board at once.
  const FileLock lock(history.string() + ".lock", history, FileLock::IfTaken::wait);
  require_place(options, entry);
  if (fs::exists(file)) answer("{}", difference_text(file, entry));
  const Renewal now = renewal_of(entry);
  const BoardCounts& counts = now.counts;
  AtomicFiles files(true);
  files.add(file, to_text(entry));
  files.add(history, content_of(history) + to_line(now));
  files.commit();
  answer("{} on {}: {} wrong, {} right, {} undecided of {}, in {}\n", entry.method, entry.suite, counts.wrong,
         counts.right, counts.undecided(), counts.starts, file.string());
}

Suite suite_of_entry(const BoardOptions& options, const BoardEntry& entry) {
  Suite suite = read_suite(options.suite.empty() ? entry.suite : options.suite);
  if (suite.id() != entry.suite)
    throw ConfigError(options.results, fmt::format("has results of {}, not of {}", entry.suite, suite.id()));
  return suite;
}

/// The variants of a suite with these methods; without any, for what only needs map and drive.
std::vector<Variant> variants_of(const BoardOptions& options, const Suite& suite,
                                 const std::vector<std::string>& methods, const std::string& share,
                                 Context& context) {
  ExperimentOptions experiment;
  experiment.methods = methods;
  experiment.cases = options.cases;
  experiment.suite = suite.file.string();
  experiment.share = share;
  if (!methods.empty()) return experiment.read_variants("", context);
  std::vector<Variant> variants = read_variants("", experiment.overrides(), context.catalog);
  // Sources of what lies in the plane keep to that by themselves.
  for (Variant& variant : variants) variant.experiment.localizer.motion = Motion::free;
  return variants;
}

/// The name of a built-in method stands for its values: whoever checks the entry runs these.
void require_values_of_method(const BoardOptions& options, const Suite& suite, const BoardEntry& entry,
                              Context& context) {
  if (!find_builtin_part(PartKind::method, entry.method)) return;
  std::vector<Variant> variants = variants_of(options, suite, {entry.method}, "", context);
  const CaseResult& first = entry.results.front();
  const auto same = std::ranges::find_if(variants, [&](const Variant& variant) {
    return variant.case_name == first.case_name && variant.experiment.seed == first.seed;
  });
  if (same != variants.end() &&
      entry.provenance.at("method_sha256") ==
          hash_of_method(
              settings_of(effective_yaml(same->experiment, context.catalog), "effective.yaml", {})))
    return;
  throw ConfigError(
      options.results,
      fmt::format("its localizer has other values than the method {}; give these a file of another "
                  "name, and run that with --method FILE",
                  entry.method));
}

void add(const BoardOptions& options, Context& context) {
  std::vector<BoardEntry> entries = entries_of_folder(options.results);
  for (BoardEntry& entry : entries) {
    const Suite suite = suite_of_entry(options, entry);
    require_whole(entry, suite, options.results);
    require_values_of_method(options, suite, entry, context);
    entry.provenance["suite_sha256"] = sha256_of_file(suite.file);
    if (!options.revision.empty()) entry.provenance["revision"] = options.revision;
    require_place(options, entry);
  }
  for (const BoardEntry& entry : entries) store(options, entry);
}

/// What a check has found of a suite and method.
struct Check {
  BoardEntry stored;
  std::size_t starts = 0;
  std::vector<std::string> different = {};
};

/// How many entries it checks.
std::size_t check_suite(const BoardOptions& options, const Suite& suite, Context& context) {
  std::vector<Check> checks;
  std::vector<std::string> methods;
  for (BoardEntry& entry : entries_of(options, suite)) {
    if (!find_builtin_part(PartKind::method, entry.method)) continue;
    methods.push_back(entry.method);
    checks.push_back({std::move(entry)});
  }
  if (methods.empty()) {
    answer("{}: no results of such a method are stored\n", suite.id());
    return 0;
  }
  std::vector<Variant> variants = variants_of(options, suite, methods, options.share, context);
  ExperimentLoader loader(context.catalog, warn);
  for_each_loaded(variants, loader, [&](std::size_t i, LoadedExperiment& loaded) {
    const Variant& variant = variants[i];
    Check& check = *std::find_if(checks.begin(), checks.end(),
                                 [&](const Check& c) { return c.stored.method == variant.setting; });
    const CaseResult* stored = check.stored.find(variant.case_name, variant.experiment.seed);
    if (stored == nullptr) return;  // A share that has none of this case's starts.
    const CaseResult fresh = run_in_memory(variant, loaded, context.catalog);
    check.starts += static_cast<std::size_t>(
        std::count_if(fresh.numbers.begin(), fresh.numbers.end(),
                      [&](std::size_t number) { return stored->find(number) != nullptr; }));
    for (std::string& line : differences(*stored, fresh)) check.different.push_back(std::move(line));
  });
  constexpr std::size_t most_shown = 20;
  const fs::path folder = options.board.empty() ? "leaderboard" : options.board;
  for (const Check& check : checks) {
    const std::size_t n = check.different.size();
    answer("{}, {}: {} starts run anew, {}\n", suite.id(), check.stored.method, check.starts,
           n == 0 ? "as they are stored" : fmt::format("{} are not as they are stored:", n));
    for (std::size_t i = 0; i < std::min(n, most_shown); ++i) answer("  {}\n", check.different[i]);
    if (n > most_shown) answer("  and {} more\n", n - most_shown);
    if (n > 0)
      answer("renew {} with:\n  {}\n", entry_file(folder, suite.id(), check.stored.method).string(),
             renewal(options, suite, check.stored));
    if (n > 0) context.exit_code = 1;
  }
  return checks.size();
}

void check(const BoardOptions& options, Context& context) {
  std::size_t checked = 0;
  for (const Suite& suite : suites_of(options)) {
    check_case_names(options, suite);
    checked += check_suite(options, suite, context);
  }
  if (checked == 0) refuse_empty(options);
}

void import(const BoardOptions& options, Context& context) {
  const Suite suite = read_suite(options.suite);
  const ImportedPoses poses = read_imported(options.poses, suite);
  std::vector<Variant> variants = variants_of(options, suite, {}, "", context);
  BoardEntry entry{suite.id(),
                   options.methods.front(),
                   1.0,
                   {{"version", version},
                    {"revision", revision()},
                    {"date", fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr)))},
                    {"imported_sha256", sha256_of_file(options.poses)},
                    {"suite_sha256", sha256_of_file(suite.file)}},
                   {}};
  // Before all maps and drives are loaded for it.
  require_place(options, entry);
  ExperimentLoader loader(context.catalog, warn);
  std::vector<Fault> faults;
  for_each_loaded(variants, loader, [&](std::size_t i, LoadedExperiment& loaded) {
    entry.results.push_back(judged(poses, variants[i], loaded, faults));
  });
  if (!faults.empty()) throw ConfigError(std::move(faults));
  require_whole(entry, suite, options.poses);
  store(options, entry);
}

void export_suite(const BoardOptions& options, Context& context) {
  const Suite suite = read_suite(options.suite);
  std::vector<Variant> variants = variants_of(options, suite, {}, "", context);
  ExperimentLoader loader(context.catalog, warn);
  listen_to_interrupts();
  const std::size_t starts = write_plain_suite(suite, variants, loader, options.out, options.force);
  answer("{} starts of {} cases in {}\n", starts, variants.size(), options.out);
}

/// Prints what a suite's file has to pin.
void pin(const BoardOptions& options, Context& context) {
  std::vector<Variant> variants = variants_of(options, read_suite(options.suite), {}, "", context);
  ExperimentLoader loader(context.catalog, warn);
  std::map<std::string, std::string> inputs;
  std::map<std::string, std::size_t> starts;
  for_each_loaded(variants, loader, [&](std::size_t i, LoadedExperiment& loaded) {
    const Variant& variant = variants[i];
    const auto [known, is_new] = starts.emplace(variant.case_name, loaded.all_starts);
    if (!is_new && known->second != loaded.all_starts)
      throw ConfigError(options.suite,
                        fmt::format("the case {} has {} starts with one seed and {} with another; give it a "
                                    "suite with one seed, or other trials",
                                    variant.case_name, known->second, loaded.all_starts));
    for (const auto& [name, hash] : input_hashes(*variant.suite, loaded.inputs, loader.hashes()))
      inputs[name] = hash;
  });
  std::string text = "pinned:\n  cases:\n";
  for (const SuiteCase& one : variants.front().suite->cases)
    text +=
        fmt::format("    {}: {{starts: {}, values: \"{}\"}}\n", one.name, starts.at(one.name), one.values);
  text += "  inputs:\n";
  for (const auto& [name, hash] : inputs) text += fmt::format("    \"{}\": {}\n", name, hash);
  answer(text);
}

void add_methods_to(CLI::App& command, BoardOptions& options) {
  command.add_option("--method", options.methods, "Only this method (repeatable)")->allow_extra_args(false);
}

void add_cases_to(CLI::App& command, BoardOptions& options) {
  command.add_option("--case", options.cases, "Only this case (repeatable)")->allow_extra_args(false);
}

void add_suite_to(CLI::App& command, BoardOptions& options) {
  command.add_option("SUITE", options.suite, "Suite, as planar@1 (glocal list suites), or its file")
      ->required();
}

}  // namespace

void add_leaderboard(CLI::App& app, Context& context) {
  auto options = std::make_shared<BoardOptions>();
  CLI::App* board = app.add_subcommand(
      "leaderboard", "Show what methods have come to on suites, or add, check, import and export results.");
  board->add_option("SUITE", options->suite, "Suite, as planar@1 (glocal list suites); all without it");
  add_methods_to(*board, *options);
  add_cases_to(*board, *options);
  CLI::Option* suite = board->get_option("SUITE");
  board->get_option("--case")->needs(suite);
  CLI::Option* by_case = board->add_flag("--cases", options->by_case, "A line for each case")->needs(suite);
  CLI::Option* by_kind =
      board
          ->add_flag("--kinds", options->by_kind,
                     "A line for each kind of disturbance: the success that is kept at each level")
          ->needs(suite)
          ->excludes(by_case)
          ->excludes(board->get_option("--case"));
  CLI::Option* markdown = board->add_flag("--markdown", options->markdown, "Print tables as Markdown");
  CLI::Option* page =
      board
          ->add_option(
              "-o,--out", options->page,
              "Write a page for a browser in place of tables, with all starts and how methods changed")
          ->excludes(by_case)
          ->excludes(by_kind)
          ->excludes(markdown)
          ->excludes(board->get_option("--case"));
  const auto add_board_to = [&](CLI::App& command) {
    command.add_option("--board", options->board, "Folder of the leaderboard (default: that of glocal)");
  };
  const auto add_force_to = [&](CLI::App& command) {
    command.add_flag("--force", options->force, "Replace what is there");
  };
  add_board_to(*board);
  add_force_to(*board);
  board->get_option("--force")->needs(page);
  board->callback([options, board] {
    if (!board->get_subcommands().empty()) return;
    if (options->page.empty())
      show(*options);
    else
      write_board_page(*options);
  });

  CLI::App* add_command = board->add_subcommand("add", "Take results over, of all methods in a folder.");
  add_command->add_option("RESULTS", options->results, "Folder that glocal run --suite has left")->required();
  add_command->add_option("--suite", options->suite, "File of the suite, where it is not built in");
  add_command->add_option("--revision", options->revision,
                          "Commit that the results are of (default: theirs)");
  add_board_to(*add_command);
  add_force_to(*add_command);
  add_command->callback([options, &context] { add(*options, context); });

  CLI::App* check_command = board->add_subcommand(
      "check", "Run a fixed share anew, and say which starts end otherwise than they are stored.");
  check_command->add_option("SUITE", options->suite, "Suite, as planar@1; all without it");
  check_command->add_option("--share", options->share, "Share of the starts")->capture_default_str();
  add_methods_to(*check_command, *options);
  add_cases_to(*check_command, *options);
  check_command->get_option("--case")->needs(check_command->get_option("SUITE"));
  add_board_to(*check_command);
  check_command->callback([options, &context] { check(*options, context); });

  CLI::App* export_command =
      board->add_subcommand("export", "Write maps, drives and starts of a suite in plain formats.");
  add_suite_to(*export_command, *options);
  export_command->add_option("-o,--out", options->out, "Folder for the files")->required();
  add_cases_to(*export_command, *options);
  add_force_to(*export_command);
  export_command->callback([options, &context] { export_suite(*options, context); });

  CLI::App* import_command =
      board->add_subcommand("import", "Judge poses that another program has found, and keep the results.");
  import_command->add_option("FILE", options->poses, "Table of poses (CSV)")->required();
  import_command->add_option("--suite", options->suite, "Suite, as planar@1, or its file")->required();
  import_command->add_option("--method", options->methods, "Name of the method")->required()->expected(1);
  add_board_to(*import_command);
  add_force_to(*import_command);
  import_command->callback([options, &context] { import(*options, context); });

  CLI::App* pin_command =
      board->add_subcommand("pin", "Print what a suite's file says of its cases and input files.");
  add_suite_to(*pin_command, *options);
  pin_command->callback([options, &context] { pin(*options, context); });
}

}  // namespace glocal::app
