// glocal report: runs as one page for a browser, which shows them step by step.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/report_file.hpp"
#include "app/results_at_hand.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "evaluation/results/atomic_file.hpp"
#include "report/page.hpp"
#include "report/page_text.hpp"

namespace glocal::app {
namespace {

std::string title_of(const std::vector<NamedRun>& runs) {
  std::string title = runs.front().name;
  for (std::size_t i = 1; i < runs.size(); ++i) title += ", " + runs[i].name;
  return title;
}

}  // namespace

std::filesystem::path write_report(const ReportOptions& options) {
  ReportData data(options.limits);
  const ResultsAtHand results(options.folders);
  const auto runs =
      read_runs(results.folders(), [&](const std::filesystem::path& folder) { return data.add(folder); });
  const auto json = data.to_json(runs, find_baseline(runs, options.baseline));
  AtomicFiles files(options.force);
  files.add(options.out, page_with(page_text, title_of(runs), json, script_for(json)));
  files.commit();
  return std::filesystem::absolute(options.out).lexically_normal();
}

void add_report(CLI::App& app, Context& /*context*/) {
  auto options = std::make_shared<ReportOptions>();
  CLI::App* command =
      app.add_subcommand("report", "Write a page for a browser that shows runs step by step.");
  command->add_option("DIR", options->folders, "Folders of results, or folders that hold some")->required();
  command->add_option("-o,--out", options->out, "The page's file")->capture_default_str();
  command->add_option("--baseline", options->baseline,
                      "Run to compare with, by the name of its folder or experiment (default: the first)");
  command
      ->add_option("--clusters", options->limits.clusters,
                   "Best clusters to keep of each step (default: all that the run has listed)")
      ->check(CLI::Range(0, 1'000'000));
  command->add_flag("--force", options->force, "Replace the file if it exists");
  command->callback([options] { answer("{}\n", write_report(*options).string()); });
}

}  // namespace glocal::app
