#include "evaluation/results/summary_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>

namespace glocal {
namespace {

double median(const nlohmann::ordered_json& values) {
  return values.at("median").get<double>();
}

}  // namespace

std::string summary_text(const nlohmann::ordered_json& s) {
  const auto& trials = s.at("trials");
  std::string text =
      fmt::format("{}, seed {}{}\n", s.at("name").get<std::string>(), s.at("seed").get<std::uint64_t>(),
                  s.at("complete").get<bool>() ? "" : " (interrupted: some trials are missing)");
  text += fmt::format("  trials              {}: {} right, {} wrong, {} undecided\n",
                      trials.at("count").get<int>(), trials.at("right").get<int>(),
                      trials.at("wrong").get<int>(), trials.at("undecided").get<int>());
  if (trials.contains("failed"))
    text += fmt::format("  failed              {}\n", trials["failed"].get<int>());
  const auto& rate = s.at("success_rate");
  text += fmt::format("  success             {:.1f} % (95 %: {:.1f} to {:.1f} %)\n",
                      100.0 * rate.at("value").get<double>(), 100.0 * rate.at("low").get<double>(),
                      100.0 * rate.at("high").get<double>());
  if (trials.at("right").get<int>() > 0) {
    const auto& translation = s.at("translation_error_m");
    const auto& rotation = s.at("rotation_error_deg");
    text += fmt::format("  localized after     {:.0f} steps, {:.1f} m (median)\n",
                        median(s.at("steps_to_localize")), median(s.at("distance_to_localize_m")));
    text +=
        fmt::format("  error then          {:.3f} m, {:.2f} deg (median); {:.3f} m, {:.2f} deg (largest)\n",
                    median(translation), median(rotation), translation.at("max").get<double>(),
                    rotation.at("max").get<double>());
  }
  const auto& later = s.at("after_declaration");
  if (later.at("steps").get<std::size_t>() > trials.at("count").get<std::size_t>()) {
    text += fmt::format("  error from then on  {:.3f} m, {:.2f} deg (largest of {} steps on the map)\n",
                        later.at("translation_error_m").at("max").get<double>(),
                        later.at("rotation_error_deg").at("max").get<double>(),
                        later.at("steps").get<std::size_t>());
  }
  text += fmt::format(
      "  wall time of a step {:.1f} ms (median), {:.1f} ms (95 %); matching {:.1f} ms (median)\n",
      median(s.at("step_ms")), s.at("step_ms").at("p95").get<double>(), median(s.at("stage_ms").at("match")));
  text += fmt::format("  time for the map    {:.0f} ms to load, {:.0f} ms to index\n",
                      s.at("map").at("build_ms").get<double>(), s.at("map").at("index_ms").get<double>());
  return text;
}

std::string variants_text(const std::vector<std::pair<std::string, nlohmann::ordered_json>>& variants) {
  std::size_t width = 7;
  for (const auto& [name, summary] : variants) width = std::max(width, name.size());
  std::string text =
      fmt::format("{:<{}}  {:>6}  {:>6}  {:>6}  {:>9}  {:>14}  {:>21}\n", "variant", width, "trials", "right",
                  "wrong", "undecided", "steps (median)", "step, wall ms (median)");
  for (const auto& [name, summary] : variants) {
    const auto& trials = summary.at("trials");
    const bool any_right = trials.at("right").get<int>() > 0;
    text += fmt::format("{:<{}}  {:>6}  {:>6}  {:>6}  {:>9}  {:>14}  {:>22.1f}{}\n", name, width,
                        trials.at("count").get<int>(), trials.at("right").get<int>(),
                        trials.at("wrong").get<int>(), trials.at("undecided").get<int>(),
                        any_right ? fmt::format("{:g}", median(summary.at("steps_to_localize"))) : "-",
                        median(summary.at("step_ms")),
                        summary.at("complete").get<bool>() ? "" : "  (interrupted: some trials are missing)");
  }
  return text;
}

}  // namespace glocal
