#include "app/cloud_pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string_view>

#include "config/text_file.hpp"
#include "evaluation/statistics/statistics.hpp"
#include "glocal/error.hpp"
#include "glocal/words.hpp"
#include "sources/text_lines.hpp"

namespace glocal::app {
namespace {

constexpr std::array pose_columns = {"tx", "ty", "tz", "qx", "qy", "qz", "qw"};

/// The values between the commas of a line, without blanks around them.
std::vector<std::string> values_of(std::string_view line) {
  std::vector<std::string> values;
  while (true) {
    const std::size_t comma = line.find(',');
    std::string_view value = line.substr(0, comma);
    const auto is_blank = [](char c) { return c == ' ' || c == '\t' || c == '\r'; };
    while (!value.empty() && is_blank(value.front())) value.remove_prefix(1);
    while (!value.empty() && is_blank(value.back())) value.remove_suffix(1);
    values.emplace_back(value);
    if (comma == std::string_view::npos) return values;
    line.remove_prefix(comma + 1);
  }
}

/// The list's table, and what is wrong with it.
class PairsReader {
 public:
  explicit PairsReader(const std::filesystem::path& file) : file_(file) {}

  std::vector<CloudPair> read() {
    const std::string content = read_text_file(file_);
    std::string_view rest = content;
    for (line_ = 1; !rest.empty(); ++line_) {
      const std::size_t end = rest.find('\n');
      const std::vector<std::string> values = values_of(rest.substr(0, end));
      rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
      if (values.size() == 1 && values.front().empty()) continue;
      names_.empty() ? read_names(values) : read_pair(values);
    }
    if (pairs_.empty() && faults_.empty())
      fault("has no pairs; give a line of names (source,target,…), then a line for each pair");
    if (!faults_.empty()) throw ConfigError(std::move(faults_));
    return std::move(pairs_);
  }

 private:
  void fault(std::string what) { faults_.push_back({file_.string(), line_, 0, std::move(what)}); }

  void read_names(const std::vector<std::string>& names) {
    names_ = names;
    for (const char* needed : {"source", "target"}) {
      if (!column(needed))
        fault(fmt::format("there is no column '{}'; the first line names the columns", needed));
    }
    if (!faults_.empty()) throw ConfigError(std::move(faults_));
  }

  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const {
    const auto at = std::find(names_.begin(), names_.end(), name);
    return at == names_.end() ? std::nullopt : std::optional(static_cast<std::size_t>(at - names_.begin()));
  }

  void read_pair(const std::vector<std::string>& values) {
    if (values.size() != names_.size()) {
      fault(fmt::format("there are {} values for {} columns", values.size(), names_.size()));
      return;
    }
    CloudPair pair;
    pair.source = values[*column("source")];
    pair.target = values[*column("target")];
    pair.source_file = file_.parent_path() / pair.source;
    pair.target_file = file_.parent_path() / pair.target;
    for (const std::filesystem::path& cloud : {pair.source_file, pair.target_file}) {
      if (const auto why = why_unreadable(cloud))
        fault(fmt::format("{}; paths are relative to this file", *why));
    }
    if (const auto kind = column("class")) pair.kind = values[*kind];
    pair.target_from_source = pose_of(values);
    pairs_.push_back(std::move(pair));
  }

  std::optional<Pose3> pose_of(const std::vector<std::string>& values) {
    std::array<double, pose_columns.size()> v{};
    for (std::size_t i = 0; i < v.size(); ++i) {
      const auto at = column(pose_columns[i]);
      if (!at) return std::nullopt;
      const auto number = number_in(values[*at]);
      if (!number || !(std::abs(*number) <= farthest_m)) {
        fault(fmt::format("{}: '{}' is no number within {} m", pose_columns[i], shown(values[*at]),
                          farthest_m));
        return std::nullopt;
      }
      v[i] = *number;
    }
    constexpr double rounding = 1e-3;
    const double length = std::sqrt(v[3] * v[3] + v[4] * v[4] + v[5] * v[5] + v[6] * v[6]);
    if (std::abs(length - 1.0) > rounding) {
      fault(fmt::format("the quaternion (qx qy qz qw) has the length {:.4f}; give one of length 1", length));
      return std::nullopt;
    }
    return Pose3({v[0], v[1], v[2]}, {v[6] / length, v[3] / length, v[4] / length, v[5] / length});
  }

  std::filesystem::path file_;
  int line_ = 0;
  std::vector<std::string> names_;
  std::vector<CloudPair> pairs_;
  std::vector<Fault> faults_;
};

std::string row_of(const std::string& name, const std::vector<const PairOutcome*>& outcomes) {
  std::size_t right = 0, right_and_match = 0, wrong = 0, wrong_and_match = 0;
  std::vector<double> times;
  for (const PairOutcome* outcome : outcomes) {
    const std::size_t match = outcome->registration.is_match ? 1 : 0;
    times.push_back(outcome->cpu_s);
    if (!outcome->is_right) continue;
    (*outcome->is_right ? right : wrong) += 1;
    (*outcome->is_right ? right_and_match : wrong_and_match) += match;
  }
  const auto matches = std::count_if(outcomes.begin(), outcomes.end(), [](const PairOutcome* outcome) {
    return outcome->registration.is_match;
  });
  return fmt::format("{:<12}{:>7}{:>9}{:>8}{:>16}{:>16}{:>15.3f}{:>9.3f}\n", name, outcomes.size(), matches,
                     right, fmt::format("{} of {}", right - right_and_match, right),
                     fmt::format("{} of {}", wrong_and_match, wrong), quantile(times, 0.5),
                     quantile(times, 1.0));
}

}  // namespace

std::vector<CloudPair> read_cloud_pairs(const std::filesystem::path& file) {
  return PairsReader(file).read();
}

bool is_right_pose(const Pose3& found, const Pose3& truth, const Points& source, double translation) {
  constexpr double rotation_deg = 5.0;
  const Vector3 middle = centroid(source);
  return (found * middle - truth * middle).norm() <= translation &&
         degrees(rotation_between(found, truth)) <= rotation_deg;
}

std::string table_of(const std::vector<PairOutcome>& outcomes) {
  std::vector<std::string> kinds;
  for (const PairOutcome& outcome : outcomes) {
    if (std::find(kinds.begin(), kinds.end(), outcome.pair.kind) == kinds.end())
      kinds.push_back(outcome.pair.kind);
  }
  std::string table =
      fmt::format("{:<12}{:>7}{:>9}{:>8}{:>16}{:>16}{:>15}{:>9}\n", "class", "pairs", "matches", "right",
                  "right refused", "wrong trusted", "median CPU s", "most");
  const auto add_row = [&](const std::string& name, auto belongs) {
    std::vector<const PairOutcome*> chosen;
    for (const PairOutcome& outcome : outcomes) {
      if (belongs(outcome)) chosen.push_back(&outcome);
    }
    table += row_of(name, chosen);
  };
  for (const std::string& kind : kinds)
    add_row(kind, [&](const PairOutcome& outcome) { return outcome.pair.kind == kind; });
  if (kinds.size() > 1) add_row("all", [](const PairOutcome&) { return true; });
  return table;
}

std::string json_line(const PairOutcome& outcome) {
  const Registration& r = outcome.registration;
  nlohmann::ordered_json json;
  if (!outcome.method.empty()) json["method"] = outcome.method;
  json["source"] = outcome.pair.source;
  json["target"] = outcome.pair.target;
  json["target_from_source"] = nullptr;
  if (r.target_from_source) {
    const Pose3& pose = *r.target_from_source;
    const Quaternion& q = pose.rotation;
    json["target_from_source"] = {{"translation", {pose.x, pose.y, pose.z}},
                                  {"quaternion", {q.x(), q.y(), q.z(), q.w()}}};
  }
  json["verdict"] = r.is_match ? "match" : "no_match";
  json["why"] = r.why;
  json["overlap"] = r.overlap;
  json["rmse_m"] = r.rmse;
  json["score"] = r.score;
  json["lead"] = r.lead;
  json["voxel_size_m"] = r.voxel_size;
  json["cpu_s"] = outcome.cpu_s;
  if (outcome.is_right) json["right"] = *outcome.is_right;
  return json.dump() + "\n";
}

}  // namespace glocal::app
