#include "app/run_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

namespace glocal::app {

int exit_code_of(const RunResult& result) {
  if (!result.complete) return 3;
  const bool any_failed = std::any_of(result.variants.begin(), result.variants.end(),
                                      [](const VariantResult& variant) { return variant.failed > 0; });
  return any_failed ? 1 : 0;
}

void print_summary(const nlohmann::ordered_json& s, const std::filesystem::path& folder) {
  const auto& trials = s["trials"];
  fmt::print("{}, seed {}{}\n", s["name"].get<std::string>(), s["seed"].get<std::uint64_t>(),
             s["complete"].get<bool>() ? "" : " (interrupted: some trials are missing)");
  fmt::print("  trials              {}: {} right, {} wrong, {} undecided\n", trials["count"].get<int>(),
             trials["right"].get<int>(), trials["wrong"].get<int>(), trials["undecided"].get<int>());
  if (trials.contains("failed")) fmt::print("  failed              {}\n", trials["failed"].get<int>());
  const auto& rate = s["success_rate"];
  fmt::print("  success             {:.1f} % (95 %: {:.1f} to {:.1f} %)\n",
             100.0 * rate["value"].get<double>(), 100.0 * rate["low"].get<double>(),
             100.0 * rate["high"].get<double>());
  if (trials["right"].get<int>() > 0) {
    fmt::print("  localized after     {:.0f} steps, {:.1f} m (median)\n",
               s["steps_to_localize"]["median"].get<double>(),
               s["distance_to_localize_m"]["median"].get<double>());
    fmt::print("  error then          {:.3f} m, {:.2f} deg (median); {:.3f} m, {:.2f} deg (largest)\n",
               s["translation_error_m"]["median"].get<double>(),
               s["rotation_error_deg"]["median"].get<double>(), s["translation_error_m"]["max"].get<double>(),
               s["rotation_error_deg"]["max"].get<double>());
  }
  const auto& later = s["after_declaration"];
  if (later["steps"].get<std::size_t>() > trials["count"].get<std::size_t>()) {
    fmt::print("  error from then on  {:.3f} m, {:.2f} deg (largest of {} steps on the map)\n",
               later["translation_error_m"]["max"].get<double>(),
               later["rotation_error_deg"]["max"].get<double>(), later["steps"].get<std::size_t>());
  }
  fmt::print("  time for a step     {:.1f} ms (median), {:.1f} ms (95 %); matching {:.1f} ms (median)\n",
             s["step_ms"]["median"].get<double>(), s["step_ms"]["p95"].get<double>(),
             s["stage_ms"]["match"]["median"].get<double>());
  fmt::print("  time for the map    {:.0f} ms to load, {:.0f} ms to index\n",
             s["map"]["build_ms"].get<double>(), s["map"]["index_ms"].get<double>());
  fmt::print("  results             {}\n", folder.string());
}

void print_table(const std::vector<std::pair<std::string, nlohmann::ordered_json>>& variants,
                 const std::filesystem::path& folder) {
  std::size_t width = 7;
  for (const auto& [name, summary] : variants) width = std::max(width, name.size());
  fmt::print("{:<{}}  {:>6}  {:>6}  {:>6}  {:>9}  {:>14}  {:>16}\n", "variant", width, "trials", "right",
             "wrong", "undecided", "steps (median)", "step ms (median)");
  for (const auto& [name, summary] : variants) {
    const auto& trials = summary["trials"];
    const bool any_right = trials["right"].get<int>() > 0;
    const auto steps = summary["steps_to_localize"]["median"].get<double>();
    fmt::print("{:<{}}  {:>6}  {:>6}  {:>6}  {:>9}  {:>14}  {:>16.1f}{}\n", name, width,
               trials["count"].get<int>(), trials["right"].get<int>(), trials["wrong"].get<int>(),
               trials["undecided"].get<int>(), any_right ? fmt::format("{:g}", steps) : "-",
               summary["step_ms"]["median"].get<double>(),
               summary["complete"].get<bool>() ? "" : "  (interrupted: some trials are missing)");
  }
  fmt::print("results in {}\n", folder.string());
}

void print_result(const RunResult& result) {
  std::vector<std::pair<std::string, nlohmann::ordered_json>> summaries;
  for (const VariantResult& variant : result.variants) {
    std::ifstream file(variant.summary);
    summaries.emplace_back(variant.name, nlohmann::ordered_json::parse(file));
  }
  const std::filesystem::path folder = std::filesystem::absolute(result.folder).lexically_normal();
  if (summaries.front().first.empty()) {
    print_summary(summaries.front().second, folder);
  } else {
    print_table(summaries, folder);
  }
}

}  // namespace glocal::app
