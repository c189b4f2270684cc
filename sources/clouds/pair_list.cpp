#include "sources/clouds/pair_list.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <system_error>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "glocal/words.hpp"
#include "sources/compressed_file.hpp"
#include "sources/text_lines.hpp"

namespace glocal::clouds {
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
    const std::string content = read_decompressed(file_);
    std::string_view rest = without_byte_order_mark(content);
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
    const auto is_there = [&](const char* name) { return column(name).has_value(); };
    if (std::ranges::any_of(pose_columns, is_there) && !std::ranges::all_of(pose_columns, is_there))
      fault(
          fmt::format("a pose has the columns {}: give all of them, or none", fmt::join(pose_columns, ", ")));
    if (!faults_.empty()) throw ConfigError(std::move(faults_));
  }

  [[nodiscard]] std::optional<std::size_t> column(std::string_view name) const {
    const auto at = std::ranges::find(names_, name);
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
      std::error_code ignored;
      if (!std::filesystem::is_regular_file(cloud, ignored))
        fault(fmt::format("no such file: {}; paths are relative to this file", cloud.string()));
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

}  // namespace

std::vector<CloudPair> read_cloud_pairs(const std::filesystem::path& file) {
  return PairsReader(file).read();
}

}  // namespace glocal::clouds
