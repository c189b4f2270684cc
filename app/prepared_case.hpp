// A benchmark case made from a recording: its experiment, and what is known of it.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sources/conversion/drive_track.hpp"
#include "sources/conversion/map_split.hpp"
#include "sources/conversion/reference_check.hpp"

namespace glocal::app {

/// How the scans fit among themselves where the reference places them.
struct ScanShift {
  double shift_s = 0.0;  ///< With which they fit best, to be added to the reference's stamps.
  /// Shares of beam ends near those of other scans: with this shift, without, and with that by which the
  /// reference would move as odometry does.
  double fit = 0.0, fit_unshifted = 0.0, fit_with_odometry = 0.0;
};

/// What has been found out about a drive and its reference.
struct CaseFacts {
  std::string name;  ///< Of the experiment.
  std::filesystem::path log;
  std::filesystem::path corrected = {};  ///< Empty: the log has the reference poses itself.
  bool has_clouds = false;
  Pose3 robot_from_sensor = {};  ///< Of clouds.
  std::size_t all_scans = 0;
  std::vector<conversion::TrackedScan> scans = {};           ///< Those with a reference.
  double shift_s = 0.0;                                      ///< That was asked for.
  std::optional<conversion::TimeShift> odometry_shift = {};  ///< Besides.
  ScanShift scan_shift = {};
  std::vector<conversion::ReferenceJump> jumps = {};
  std::optional<conversion::RelationErrors> relations = {};
  conversion::MapSplit split = {};
  std::optional<double> fit = {};  ///< Share of the run's beam ends near the map, where that was mapped.
  double fit_within_m = 0.1;
  std::size_t map_points = 0, observations = 0, starts = 0;
};

/// As `glocal run` reads it, with paths from the case's folder on.
[[nodiscard]] std::string case_experiment(const CaseFacts& facts, const Catalog& catalog);

/// Names and values for people.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> fact_lines(const CaseFacts& facts);

/// What is doubtful, and what to do about it: a sentence each.
[[nodiscard]] std::vector<std::string> case_warnings(const CaseFacts& facts);

[[nodiscard]] std::string case_readme(const CaseFacts& facts, const std::vector<std::string>& warnings);

}  // namespace glocal::app
