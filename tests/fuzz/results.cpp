// A results folder: summary.json, provenance.json, effective.yaml, trials.jsonl, steps.jsonl, with lines of
// dashes between them, and what the program makes of it.
#include <array>

#include "evaluation/comparison/comparison.hpp"
#include "evaluation/results/stored_figures.hpp"
#include "fuzz/harness.hpp"
#include "report/report_data.hpp"

namespace glocal::fuzz {
namespace {

std::filesystem::path write_folder(const std::string& input) {
  constexpr std::array names = {"summary.json", "provenance.json", "effective.yaml", "trials.jsonl",
                                "steps.jsonl"};
  const std::vector<std::string> contents = parts(input, names.size());
  std::filesystem::path file;
  for (std::size_t i = 0; i < names.size(); ++i) file = write(std::string("run/") + names.at(i), contents[i]);
  return file.parent_path();
}

void read_all(const std::filesystem::path& folder) {
  static_cast<void>(results_folders(folder));
  std::vector<TrialFigures> figures;
  static_cast<void>(read_figures(folder, {}, figures));
  Summary summary;
  for (const TrialFigures& trial : figures) summary.add(trial);
  static_cast<void>(summary.figures().dump());
  ReportData report({});
  const StoredRun run = report.add(folder);
  const std::vector<NamedRun> runs = {{"a", run}, {"b", run}};
  static_cast<void>(report.page_data({{"a", run}}, 0).head.dump());
  static_cast<void>(compare(runs, 0));
}

}  // namespace
}  // namespace glocal::fuzz

extern "C" int fuzz_results(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto folder = fuzz::write_folder(fuzz::text_of(data, size));
  return fuzz::answer([&] { fuzz::read_all(folder); });
}
