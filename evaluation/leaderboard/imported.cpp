#include "evaluation/leaderboard/imported.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <sstream>
#include <string_view>

#include "config/nearest.hpp"
#include "config/text_file.hpp"
#include "evaluation/results/file_io.hpp"
#include "evaluation/results/number_text.hpp"
#include "glocal/words.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> cells_of(std::string line) {
  if (!line.empty() && line.back() == '\r') line.pop_back();
  std::vector<std::string> cells;
  std::istringstream text(line + ",");  // Behind the last comma there is no cell.
  for (std::string cell; std::getline(text, cell, ',');) {
    cell.erase(0, cell.find_first_not_of(' '));
    cell.erase(cell.find_last_not_of(' ') + 1);
    cells.push_back(std::move(cell));
  }
  return cells;
}

/// Reads one file, row by row.
class PosesReader {
 public:
  PosesReader(const fs::path& file, const Suite& suite) : suite_(suite) { poses_.file = file; }

  ImportedPoses read() {
    if (const auto why = why_unreadable(poses_.file)) throw ConfigError(poses_.file, *why);
    std::istringstream lines(content_of(poses_.file));
    std::string line;
    std::getline(lines, line);
    read_header(cells_of(std::string(without_byte_order_mark(line))));
    const bool is_table = faults_.empty();
    while (is_table && std::getline(lines, line)) {
      ++line_;
      if (!line.empty() && line != "\r") read_row(cells_of(line));
    }
    if (faults_.empty() && poses_.starts.empty()) refuse("has no rows; give one for each pose");
    if (!faults_.empty()) throw ConfigError(std::move(faults_));
    return std::move(poses_);
  }

 private:
  void refuse(std::string message) {
    faults_.push_back({poses_.file.string(), line_, 0, std::move(message)});
  }

  void read_header(const std::vector<std::string>& names) {
    for (std::size_t i = 0; i < names.size(); ++i) {
      if (!columns_.emplace(names[i], i).second) refuse("the column " + shown(names[i]) + " is there twice");
    }
    width_ = names.size();
    in_space_ = columns_.contains("qw");
    std::vector<const char*> needed = {"case", "start", "step", "declared", "x", "y"};
    if (in_space_) {
      needed.insert(needed.end(), {"z", "qx", "qy", "qz", "qw"});
    } else {
      needed.push_back("yaw_deg");
    }
    if (suite_.seeds.size() > 1) needed.push_back("seed");
    for (const char* name : needed) {
      if (!columns_.contains(name))
        refuse(
            fmt::format("has no column '{}'; its first line names the columns: case, start, step, x, y, "
                        "yaw_deg, declared, or z, qx, qy, qz, qw in place of yaw_deg{}",
                        name, suite_.seeds.size() > 1 ? ", and seed" : ""));
    }
  }

  template <class Number>
  Number number(const char* column) {
    const std::string& text = cells_->at(columns_.at(column));
    const std::optional<Number> value = number_of<Number>(text);
    bool is_good = value.has_value();
    if constexpr (std::is_floating_point_v<Number>) is_good = is_good && std::isfinite(*value);
    if (is_good) return *value;
    refuse(fmt::format("{}: '{}' is no {}", column, shown(text),
                       std::is_floating_point_v<Number> ? "finite number" : "whole number from 0 on"));
    return {};
  }

  Pose3 pose() {
    if (!in_space_)
      return Pose2{number<double>("x"), number<double>("y"), wrap_angle(radians(number<double>("yaw_deg")))};
    const Quaternion q{number<double>("qw"), number<double>("qx"), number<double>("qy"),
                       number<double>("qz")};
    const double length = q.norm();
    constexpr double rounding_of_text = 1e-3;
    if (!(std::abs(length - 1.0) <= rounding_of_text)) {
      refuse("qx, qy, qz, qw: are no rotation, as their squares do not add up to 1");
      return {};
    }
    return {Vector3{number<double>("x"), number<double>("y"), number<double>("z")}, q.normalized()};
  }

  void read_row(const std::vector<std::string>& cells) {
    if (cells.size() != width_)
      return refuse(fmt::format("has {} values, and the first line names {} columns", cells.size(), width_));
    cells_ = &cells;
    const std::size_t before = faults_.size();
    const std::string& case_name = cells[columns_.at("case")];
    const auto seed = suite_.seeds.size() > 1 ? number<std::uint64_t>("seed") : suite_.seeds.front();
    const auto start = number<std::size_t>("start");
    const auto step = number<std::size_t>("step");
    const auto declared = number<unsigned>("declared");
    ImportedPose row{line_, pose(), declared == 1};
    if (declared > 1) refuse(fmt::format("declared: {} is neither 0 nor 1", declared));
    if (faults_.size() > before) return;
    const SuiteCase* known = suite_.find_case(case_name);
    const bool has_seed = std::find(suite_.seeds.begin(), suite_.seeds.end(), seed) != suite_.seeds.end();
    if (known == nullptr) {
      std::vector<std::string> names;
      for (const SuiteCase& one : suite_.cases) names.push_back(one.name);
      return refuse(fmt::format("{} has no case '{}'{}", suite_.id(), shown(case_name),
                                suggestion(case_name, names, "there are")));
    }
    if (!has_seed) return refuse(fmt::format("{} has no seed {}", suite_.id(), seed));
    if (start >= known->starts)
      return refuse(
          fmt::format("the case {} has no start {}: they are 0 to {}", case_name, start, known->starts - 1));
    const auto [there, is_new] = poses_.starts[{case_name, seed, start}].emplace(step, row);
    if (!is_new)
      refuse(fmt::format("step {} of start {} of {} is there twice (first in line {})", step, start,
                         case_name, there->second.line));
  }

  const Suite& suite_;
  ImportedPoses poses_;
  std::map<std::string, std::size_t> columns_;
  std::size_t width_ = 0;
  bool in_space_ = false;
  const std::vector<std::string>* cells_ = nullptr;  ///< Of the row.
  int line_ = 1;
  std::vector<Fault> faults_;
};

/// A declared pose and where the robot was, seen from above.
struct Judgement {
  Pose2 pose, reference;
};

/// The motion in the plane that brings the positions of poses nearest to those of their references.
Pose2 motion_onto(const std::vector<Judgement>& all) {
  Eigen::Matrix2Xd poses(2, all.size()), references(2, all.size());
  Eigen::Index column = 0;
  for (const auto& [pose, reference] : all) {
    poses.col(column) << pose.x, pose.y;
    references.col(column++) << reference.x, reference.y;
  }
  const Eigen::Matrix3d motion = Eigen::umeyama(poses, references, false);
  return {motion(0, 2), motion(1, 2), std::atan2(motion(1, 0), motion(0, 0))};
}

/// Why poses that are nearly all wrong are of another frame; none if they are not, or if there are few.
std::optional<std::string> frame_fault(const std::vector<Judgement>& all, std::size_t right,
                                       const EvaluationConfig& limits) {
  constexpr std::size_t few = 10;
  if (all.size() < few || right * 10 > all.size()) return std::nullopt;
  const Pose2 motion = motion_onto(all);
  const auto fits = std::count_if(all.begin(), all.end(), [&](const Judgement& j) {
    const Pose2 moved = motion * j.pose;
    return distance(moved, j.reference) <= limits.max_translation_error &&
           degrees(rotation_between(moved, j.reference)) <= limits.max_rotation_error_deg;
  });
  if (2 * static_cast<std::size_t>(fits) < all.size()) return std::nullopt;
  return fmt::format(
      "its poses are of another frame: {} of {} fit if all are turned by {:.1f} deg and moved by "
      "({:.2f}, {:.2f}) m, and {} as they are; give them in the frame of the exported map",
      fits, all.size(), degrees(motion.theta), motion.x, motion.y, right);
}

/// What counts as localized after the declaration of a whole drive.
WholeDrive drive_of(const std::map<std::size_t, ImportedPose>& rows, const LoadedExperiment& loaded,
                    std::size_t start_sample) {
  std::size_t localized = 0;
  PoseError largest;
  for (const auto& [step, row] : rows) {
    const auto& reference = loaded.drive.samples[start_sample + step].map_from_robot;
    if (!row.declared || !reference || !is_on_map(*reference, *loaded.map)) continue;
    ++localized;
    const PoseError error = pose_error(row.map_from_robot, *reference);
    largest = {std::max(largest.translation_m, error.translation_m),
               std::max(largest.rotation_rad, error.rotation_rad)};
  }
  return whole_drive(localized, largest.translation_m, degrees(largest.rotation_rad), 0, 0);
}

}  // namespace

ImportedPoses read_imported(const fs::path& file, const Suite& suite) {
  return PosesReader(file, suite).read();
}

CaseResult judged(const ImportedPoses& poses, const Variant& variant, const LoadedExperiment& loaded,
                  std::vector<Fault>& faults) {
  const Experiment& experiment = variant.experiment;
  CaseResult result{.case_name = variant.case_name, .seed = experiment.seed, .numbers = {}, .starts = {}};
  std::vector<Judgement> judgements;
  std::size_t right = 0;
  for (std::size_t i = 0; i < loaded.starts.size(); ++i) {
    static const std::map<std::size_t, ImportedPose> none;
    const std::size_t first = loaded.starts[i];
    const std::size_t left = steps_left(loaded.drive, experiment.trials, first);
    const auto of_start = poses.starts.find({variant.case_name, experiment.seed, i});
    const auto& rows = of_start == poses.starts.end() ? none : of_start->second;
    if (!rows.empty() && rows.rbegin()->first >= left) {
      faults.push_back({poses.file.string(), rows.rbegin()->second.line, 0,
                        fmt::format("start {} of {} has {} steps, from 0 on; there is no step {}", i,
                                    variant.case_name, left, rows.rbegin()->first)});
      continue;
    }
    const auto declared =
        std::find_if(rows.begin(), rows.end(), [](const auto& r) { return r.second.declared; });
    const std::size_t last = declared == rows.end() ? left - 1 : declared->first;
    const double way = loaded.drive.path_m[first + last] - loaded.drive.path_m[first];
    std::optional<PoseError> error;
    Outcome outcome = Outcome::undecided;
    if (declared != rows.end()) {
      const Pose3& pose = declared->second.map_from_robot;
      if (const auto& reference = loaded.drive.samples[first + last].map_from_robot) {
        error = pose_error(pose, *reference);
        judgements.push_back({seen_from_above(pose), seen_from_above(*reference)});
      }
      outcome = judge(error, experiment.evaluation);
      right += outcome == Outcome::right ? 1 : 0;
    }
    result.numbers.push_back(i);
    result.starts.push_back(start_result(outcome, last + 1, way, error));
    if (experiment.trials.whole) result.drive = drive_of(rows, loaded, first);
  }
  if (const auto why = frame_fault(judgements, right, experiment.evaluation))
    faults.push_back({poses.file.string(), 0, 0, fmt::format("{}: {}", variant.case_name, *why)});
  return result;
}

}  // namespace glocal
