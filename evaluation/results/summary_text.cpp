#include "evaluation/results/summary_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <vector>

#include "glocal/words.hpp"

namespace glocal {
namespace {

double median(const nlohmann::ordered_json& values) {
  return values.at("median").get<double>();
}

int count(const nlohmann::ordered_json& trials, const char* outcome) {
  return trials.value(outcome, 0);
}

/// Whether declared poses that nothing can judge agree with each other.
std::string agreement_text(const nlohmann::ordered_json& agreement, int declared) {
  const int pairs = agreement.at("pairs").get<int>();
  const auto& disagree = agreement.at("disagree_at_m");
  if (pairs == 0) return "";
  if (disagree.empty())
    return fmt::format("  agreement           {} along the drive, by odometry\n",
                       pairs == 1 ? "both declared poses agree" : "all declared poses agree with each other");
  std::vector<std::string> places;
  for (const auto& place : disagree) places.push_back(fmt::format("{:.1f}", place.get<double>()));
  return fmt::format(
      "  agreement           {} of {} declared poses disagree with the one before, carried on by odometry: "
      "at {} m\n",
      disagree.size(), declared, listed(places));
}

/// Of a run without references there is nothing that success could mean.
std::string outcomes_text(const nlohmann::ordered_json& trials, const nlohmann::ordered_json& success) {
  const int declared = count(trials, "declared_without_reference");
  std::string judged = fmt::format("{} right, {} wrong, ", count(trials, "right"), count(trials, "wrong"));
  if (declared > 0 && count(trials, "right") + count(trials, "wrong") == 0) judged.clear();
  std::string text =
      fmt::format("  trials              {}: {}{}{} undecided\n", count(trials, "count"),
                  declared > 0 ? fmt::format("{} declared without reference pose, ", declared) : "", judged,
                  count(trials, "undecided"));
  if (trials.contains("failed")) text += fmt::format("  failed              {}\n", count(trials, "failed"));
  if (trials.contains("agreement")) text += agreement_text(trials["agreement"], declared);
  if (judged.empty()) return text;
  return text + fmt::format("  success             {:.1f} % (95 %: {:.1f} to {:.1f} %)\n",
                            100.0 * success.at("value").get<double>(),
                            100.0 * success.at("low").get<double>(),
                            100.0 * success.at("high").get<double>());
}

}  // namespace

std::string summary_text(const nlohmann::ordered_json& s) {
  const auto& trials = s.at("trials");
  std::string text =
      fmt::format("{}, seed {}{}\n", s.at("name").get<std::string>(), s.at("seed").get<std::uint64_t>(),
                  s.at("complete").get<bool>() ? "" : " (interrupted: some trials are missing)");
  text += outcomes_text(trials, s.at("success_rate"));
  if (trials.at("right").get<int>() > 0) {
    const auto& translation = s.at("translation_error_m");
    const auto& rotation = s.at("rotation_error_deg");
    text += fmt::format("  localized after     {:g} steps, {:.1f} m (median)\n",
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

std::string undecided_cell(const nlohmann::ordered_json& trials) {
  std::string cell = trials.at("undecided").dump();
  if (trials.contains("failed")) cell += fmt::format(", {} failed", trials.at("failed").dump());
  if (trials.contains("declared_without_reference"))
    cell += fmt::format(", {} not judged", trials.at("declared_without_reference").dump());
  return cell;
}

std::string variants_text(const std::vector<std::pair<std::string, nlohmann::ordered_json>>& variants) {
  std::size_t width = 7, undecided_width = 9;
  for (const auto& [name, summary] : variants) {
    width = std::max(width, name.size());
    undecided_width = std::max(undecided_width, undecided_cell(summary.at("trials")).size());
  }
  std::string text =
      fmt::format("{:<{}}  {:>6}  {:>6}  {:>6}  {:>{}}  {:>14}  {:>21}\n", "variant", width, "trials",
                  "right", "wrong", "undecided", undecided_width, "steps (median)", "step, wall ms (median)");
  for (const auto& [name, summary] : variants) {
    const auto& trials = summary.at("trials");
    const bool any_right = trials.at("right").get<int>() > 0;
    text += fmt::format("{:<{}}  {:>6}  {:>6}  {:>6}  {:>{}}  {:>14}  {:>22.1f}{}\n", name, width,
                        trials.at("count").get<int>(), trials.at("right").get<int>(),
                        trials.at("wrong").get<int>(), undecided_cell(trials), undecided_width,
                        any_right ? fmt::format("{:g}", median(summary.at("steps_to_localize"))) : "-",
                        median(summary.at("step_ms")),
                        summary.at("complete").get<bool>() ? "" : "  (interrupted: some trials are missing)");
  }
  return text;
}

}  // namespace glocal
