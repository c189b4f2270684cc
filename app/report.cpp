// glocal report: runs as one page for a browser, which shows them step by step.
#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "app/report_file.hpp"
#include "app/results_at_hand.hpp"
#include "app/standard_streams.hpp"
#include "evaluation/comparison/named_runs.hpp"
#include "report/page_files.hpp"

namespace glocal::app {
namespace {

namespace fs = std::filesystem;

std::string title_of(const std::vector<NamedRun>& runs) {
  constexpr std::size_t most_names = 4;
  std::string title = runs.front().name;
  for (std::size_t i = 1; i < std::min(runs.size(), most_names); ++i) title += ", " + runs[i].name;
  if (runs.size() > most_names) title += fmt::format(" and {} more", runs.size() - most_names);
  return title;
}

}  // namespace

fs::path write_report(const ReportOptions& options) {
  ReportData report(options.limits);
  const auto runs =
      ResultsAtHand(options.folders).read([&](const fs::path& folder) { return report.add(folder); });
  fs::path file = fs::absolute(options.out).lexically_normal();
  write_page(file, title_of(runs), report.page_data(runs, find_baseline(runs, options.baseline)),
             options.files);
  return file;
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
  command->add_flag_callback(
      "--one-file", [options] { options->files.most_bytes = std::numeric_limits<std::size_t>::max(); },
      "Keep the steps in the page, however large; else those of a page of more than 3 MB lie in a folder "
      "beside it");
  command->add_flag("--force", options->files.replace, "Replace the file if it exists");
  command->callback([options] { answer("{}\n", write_report(*options).string()); });
}

}  // namespace glocal::app
