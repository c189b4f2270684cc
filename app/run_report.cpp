#include "app/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "app/standard_streams.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/summary_text.hpp"

namespace glocal::app {

int exit_code_of(const RunResult& result) {
  if (!result.complete) return 3;
  const bool any_failed = std::any_of(result.variants.begin(), result.variants.end(),
                                      [](const VariantResult& variant) { return variant.failed > 0; });
  return any_failed ? 1 : 0;
}

void print_summary(const nlohmann::ordered_json& summary, const std::filesystem::path& folder) {
  answer("{}  results             {}\n", summary_text(summary), folder.string());
}

void print_result(const RunResult& result) {
  std::vector<std::pair<std::string, nlohmann::ordered_json>> summaries;
  for (const VariantResult& variant : result.variants)
    summaries.emplace_back(variant.name, nlohmann::ordered_json::parse(content_of(variant.summary)));
  const std::filesystem::path folder = std::filesystem::absolute(result.folder).lexically_normal();
  if (summaries.front().first.empty()) {
    print_summary(summaries.front().second, folder);
  } else {
    answer("{}results in {}\n", variants_text(summaries), folder.string());
  }
}

}  // namespace glocal::app
