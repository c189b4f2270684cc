#include "app/prepared_case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/cloud_folder_writer.hpp"
#include "app/localize_plan.hpp"
#include "config/scalars.hpp"
#include "sources/bags/scan_placer.hpp"

namespace glocal::app {
namespace {

using conversion::segments_yaml;
using conversion::TrackedScan;

std::vector<Pose3> odometry_of(const std::vector<TrackedScan>& scans) {
  std::vector<Pose3> poses;
  for (const TrackedScan& scan : scans) poses.push_back(scan.odom_from_robot);
  return poses;
}

std::vector<Pose3> references_of(const std::vector<TrackedScan>& scans) {
  std::vector<Pose3> poses;
  for (const TrackedScan& scan : scans) poses.push_back(*scan.map_from_robot);
  return poses;
}

/// Length of the way through places at least 0.25 m apart, so that noise does not add up, m.
double way_of(const std::vector<Pose3>& poses) {
  const std::vector<Pose3> path = sparse_path(poses);
  double way = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) way += distance(path[i - 1], path[i]);
  return way;
}

double percent(double share) {
  return 100.0 * share;
}

double longest_gap_s(const std::vector<TrackedScan>& scans) {
  std::int64_t longest = 0;
  for (std::size_t i = 1; i < scans.size(); ++i)
    longest = std::max(longest, scans[i].stamp_ns - scans[i - 1].stamp_ns);
  return bags::seconds(longest);
}

/// Starts as far apart as gives two dozen of them, but no nearer than makes them differ.
std::string trials_of(const CaseFacts& facts) {
  double run = 0.0, shortest = 1.0;
  for (const auto& [from, to] : facts.split.run) {
    run += to - from;
    shortest = std::min(shortest, to - from);
  }
  const double way = way_of(odometry_of(facts.scans));
  const double every_m = std::clamp(std::round(10.0 * run * way / 25.0) / 10.0, 0.5, 6.0);
  constexpr double ten_steps_m = 5.0;  // with room to begin at some places
  return fmt::format("every_m: {}, max_steps: 60, min_steps: {}, within_map_m: {}", every_m,
                     shortest * way >= ten_steps_m ? 10 : 1, conversion::near_map_m);
}

/// What is wrong with the reference's stamps, if anything. Scans tell more than odometry, whose own clock may
/// be off; but a drive that hardly turns fits itself with many shifts.
std::optional<std::string> shift_warning(const CaseFacts& facts) {
  constexpr double least_s = 0.03, least_correlation_gain = 0.01, least_fit_gain = 0.02, same_fit = 0.01;
  const ScanShift& scans = facts.scan_shift;
  if (std::abs(scans.shift_s) >= least_s && scans.fit - scans.fit_unshifted >= least_fit_gain)
    return fmt::format(
        "the scans fit each other better if the reference's stamps are moved by {:.2f} s ({:.0f} % instead "
        "of {:.0f} %): give --shift {:.2f}",
        scans.shift_s, percent(scans.fit), percent(scans.fit_unshifted), facts.shift_s + scans.shift_s);
  const auto& odometry = facts.odometry_shift;
  if (!odometry || std::abs(odometry->shift_s) < least_s ||
      odometry->correlation - odometry->correlation_unshifted < least_correlation_gain)
    return std::nullopt;
  if (scans.fit_with_odometry >= scans.fit_unshifted - same_fit)
    return fmt::format("the reference moves {:.2f} s {} odometry: give --shift {:.2f}",
                       std::abs(odometry->shift_s), odometry->shift_s < 0.0 ? "after" : "before",
                       facts.shift_s + odometry->shift_s);
  return fmt::format(
      "odometry moves {:.2f} s {} the reference, and the scans fit the reference as it is: the clock of the "
      "odometry is off, which no --shift mends",
      std::abs(odometry->shift_s), odometry->shift_s < 0.0 ? "before" : "after");
}

}  // namespace

std::string case_experiment(const CaseFacts& facts, const Catalog& catalog) {
  const std::string map_segments = segments_yaml(facts.split.map),
                    run_segments = segments_yaml(facts.split.run);
  std::string map, observations;
  if (facts.has_clouds) {
    const std::string drive = fmt::format(
        "folder: clouds, odometry: clouds/odometry.tum, reference: clouds/reference.tum, sensor: {}",
        mount_yaml(facts.robot_from_sensor));
    map = fmt::format("cloud_drive: {{{}, segments: {}}}", drive, map_segments);
    observations = fmt::format("cloud_drive: {{{}, segments: {}}}", drive, run_segments);
  } else {
    map = fmt::format("log_map: {{path: drive.log, segments: {}}}", map_segments);
    observations = fmt::format("carmen_log: {{path: drive.log, segments: {}}}", run_segments);
  }
  return fmt::format(
      "# Written by glocal prepare.\n"
      "schema: 1\n"
      "name: {}\n"
      "seed: 1\n"
      "map:\n"
      "  {}\n"
      "observations:\n"
      "  {}\n"
      "trials: {{{}}}\n"
      "{}",
      to_yaml(std::string_view(facts.name)), map, observations, trials_of(facts),
      localizer_yaml(default_method(facts.has_clouds), {}, catalog));
}

std::vector<std::pair<std::string, std::string>> fact_lines(const CaseFacts& facts) {
  const auto& scans = facts.scans;
  std::vector<std::pair<std::string, std::string>> lines = {
      {"log", facts.log.filename().string()},
      {"reference", facts.corrected.empty() ? "the log's own" : facts.corrected.filename().string()},
      {"scans",
       fmt::format("{} of {} with a reference pose ({:.0f} %), over {:.1f} s; longest gap {:.2f} s",
                   scans.size(), facts.all_scans,
                   percent(static_cast<double>(scans.size()) / static_cast<double>(facts.all_scans)),
                   bags::seconds(scans.back().stamp_ns - scans.front().stamp_ns), longest_gap_s(scans))},
      {"way", fmt::format("{:.1f} m by odometry, {:.1f} m by the reference", way_of(odometry_of(scans)),
                          way_of(references_of(scans)))},
      {"jumps", fmt::format("{} of the reference against odometry", facts.jumps.size())}};
  lines.emplace_back(
      "time shift",
      fmt::format("{:+g} s was given; besides, scans fit best with {:+.2f} s ({:.0f} %; {:.0f} % without), "
                  "odometry {}",
                  facts.shift_s, facts.scan_shift.shift_s, percent(facts.scan_shift.fit),
                  percent(facts.scan_shift.fit_unshifted),
                  facts.odometry_shift
                      ? fmt::format("with {:+.2f} s (speeds correlate by {:.3f}; {:.3f} without)",
                                    facts.odometry_shift->shift_s, facts.odometry_shift->correlation,
                                    facts.odometry_shift->correlation_unshifted)
                      : "cannot tell"));
  if (facts.relations)
    lines.emplace_back("relations",
                       fmt::format("{}: errors of {:.3f} m and {:.2f} deg (mean), {:.3f} m (95 %)",
                                   facts.relations->relations, facts.relations->mean_m,
                                   degrees(facts.relations->mean_rad), facts.relations->p95_m));
  lines.emplace_back(
      "map", fmt::format("{} points, from {} of the way", facts.map_points, segments_yaml(facts.split.map)));
  lines.emplace_back(
      "run", fmt::format("{} observations, from {} of the way; {:.0f} % within {:g} m of the map's path; {} "
                         "starts",
                         facts.observations, segments_yaml(facts.split.run),
                         percent(facts.split.run_near_map), conversion::near_map_m, facts.starts));
  lines.emplace_back("scan fit", facts.fit ? fmt::format("{:.0f} % of the beam ends within {:g} m of the map",
                                                         percent(*facts.fit), facts.fit_within_m)
                                           : "not known: no scan of the run is where the map was made");
  return lines;
}

std::vector<std::string> case_warnings(const CaseFacts& facts) {
  std::vector<std::string> warnings;
  const auto& scans = facts.scans;
  constexpr double least_share = 0.9, least_fit = 0.5, least_near = 0.25, most_scale = 1.25;
  const double share = static_cast<double>(scans.size()) / static_cast<double>(facts.all_scans);
  if (share < least_share)
    warnings.push_back(
        fmt::format("only {:.0f} % of the scans have a reference pose, and the others are left out; if the "
                    "trajectory has poses farther apart in time, raise --max-gap",
                    percent(share)));
  if (auto warning = shift_warning(facts)) warnings.push_back(std::move(*warning));
  if (!facts.jumps.empty()) {
    const auto& largest =
        *std::max_element(facts.jumps.begin(), facts.jumps.end(),
                          [](const auto& a, const auto& b) { return a.distance_m < b.distance_m; });
    warnings.push_back(fmt::format(
        "the reference jumps against odometry, {} in all; the largest, by {:.2f} m and {:.1f} deg, is "
        "before the scan at {:.3f} s",
        facts.jumps.size(), largest.distance_m, degrees(largest.angle_rad), bags::seconds(largest.stamp_ns)));
  }
  const double by_odometry = way_of(odometry_of(scans)), by_reference = way_of(references_of(scans));
  if (by_reference > most_scale * by_odometry || by_odometry > most_scale * by_reference)
    warnings.push_back(
        fmt::format("the way is {:.1f} m by odometry and {:.1f} m by the reference: one of them has another "
                    "scale, or is of another drive",
                    by_odometry, by_reference));
  if (facts.fit && *facts.fit < least_fit)
    warnings.push_back(
        fmt::format("at the reference poses only {:.0f} % of the run's beam ends lie within {:g} m of the "
                    "map: the reference is not that of these scans, or of another point of the robot "
                    "(--poses-of sensor), or much has changed",
                    percent(*facts.fit), facts.fit_within_m));
  if (facts.split.run_near_map < least_near)
    warnings.push_back(
        fmt::format("only {:.0f} % of the run lies within {:g} m of the map's path: the drive does not come "
                    "back; give --blocks or --map-share",
                    percent(facts.split.run_near_map), conversion::near_map_m));
  return warnings;
}

std::string case_readme(const CaseFacts& facts, const std::vector<std::string>& warnings) {
  std::string text =
      fmt::format("# {}\n\nA benchmark case, made by `glocal prepare`.\n\n| | |\n|---|---|\n", facts.name);
  for (const auto& [name, value] : fact_lines(facts)) text += fmt::format("| {} | {} |\n", name, value);
  text += "\n## Warnings\n\n";
  for (const std::string& warning : warnings) text += fmt::format("- {}\n", warning);
  if (warnings.empty()) text += "None.\n";
  text += "\n## Files\n\n";
  text += facts.has_clouds
              ? "- `clouds/`: the clouds, `odometry.tum` and `reference.tum`\n- `map.pcd`: the map\n"
              : "- `drive.log`: the scans as a CARMEN log, with odometry and reference poses\n"
                "- `map.yaml`, `map.pgm`: the map, for the map server\n";
  text +=
      "- `experiment.yaml`: makes the map from its part of the drive, and looks for the robot on the other "
      "part\n"
      "- `provenance.json`: what it was made from\n\n"
      "    glocal run experiment.yaml\n";
  return text;
}

}  // namespace glocal::app
