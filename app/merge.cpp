// glocal merge: one set of results from what all shards have left.
#include "evaluation/sharding/merge.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <memory>
#include <string>

#include "app/commands.hpp"
#include "app/run_report.hpp"
#include "app/standard_streams.hpp"

namespace glocal::app {
namespace {

struct MergeCommand {
  std::string folder;
  std::string out;
  bool force = false;
  bool quiet = false;
};

/// "3, 7, 12 to 14, and 20 more" of ascending numbers.
std::string list_of(const std::vector<std::size_t>& numbers) {
  constexpr std::size_t most = 20;
  std::string text;
  for (std::size_t i = 0, parts = 0; i < numbers.size(); ++parts) {
    if (parts == most) return text + fmt::format(", and {} more", numbers.size() - i);
    std::size_t last = i;
    while (last + 1 < numbers.size() && numbers[last + 1] == numbers[last] + 1) ++last;
    if (last < i + 2) last = i;  // Two are no range.
    text += i == 0 ? "" : ", ";
    text += last > i ? fmt::format("{} to {}", numbers[i], numbers[last]) : fmt::format("{}", numbers[i]);
    i = last + 1;
  }
  return text;
}

void say_missing(const MergeResult& result, const Manifest& manifest, const JournalScan& scan) {
  const std::size_t live = scan.count_live();
  say("incomplete: {} of {} trials are missing\n", result.count_missing(), manifest.count_trials());
  for (const MissingTrials& missing : result.missing)
    say("  {}{}\n", missing.variant.empty() ? "trials " : missing.variant + ": trials ",
        list_of(missing.trials));
  if (live > 0)
    say("{} {} still at work (or ended without a word in the last two minutes); merge again when all have "
        "ended\n",
        live, live == 1 ? "shard is" : "shards are");
  say("run the shards again: only what is missing is run; then merge again\n");
}

void merge(const MergeCommand& command, Context& context) {
  const Manifest manifest = read_manifest(command.folder);
  const JournalScan scan(journals_folder(command.folder), warn);
  MergeOptions options{command.out.empty() ? command.folder : command.out, command.force};
  if (!command.quiet) options.note = [](const std::string& text) { spdlog::info(text); };
  const MergeResult result = merge_shards(manifest, scan, options);
  context.exit_code = exit_code_of(result.run);
  if (!command.quiet && !result.run.variants.empty()) print_result(result.run);
  if (!result.run.complete) say_missing(result, manifest, scan);
}

}  // namespace

void add_merge(CLI::App& app, Context& context) {
  auto options = std::make_shared<MergeCommand>();
  CLI::App* command =
      app.add_subcommand("merge", "Put together what shards have left, as one run would have left it.");
  command->add_option("DIR", options->folder, "Folder that the shards share")->required();
  command->add_option("-o,--out", options->out, "Folder for the results (default: the same)");
  command->add_flag("--force", options->force, "Replace results of other runs that are in the way");
  command->add_flag("--quiet", options->quiet, "No table of results");
  command->callback([options, &context] { merge(*options, context); });
}

}  // namespace glocal::app
