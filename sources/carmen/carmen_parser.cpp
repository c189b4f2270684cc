#include "sources/carmen/carmen_parser.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <string>
#include <string_view>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/limits.hpp"
#include "glocal/pose2.hpp"
#include "glocal/words.hpp"
#include "sources/compressed_file.hpp"
#include "sources/text_lines.hpp"

namespace glocal::carmen {
namespace {

constexpr std::size_t max_readings = 100000;
constexpr std::size_t max_faults = 20;
/// Room for as many readings and remissions, with all the digits that a number may have.
constexpr std::size_t max_line = 10'000'000;

/// What is wrong with the line at hand; the place is added where it is known.
struct BadLine {
  std::string message;
};

/// A line's fields, read from left to right.
class Fields {
 public:
  void split(std::string_view line) {
    split_fields(line, fields_);
    next_ = 0;
  }

  [[nodiscard]] std::size_t size() const { return fields_.size(); }
  [[nodiscard]] std::string_view tag() const { return fields_.front(); }
  void skip(std::size_t n) { next_ += n; }

  /// Any number, also infinite or NaN.
  template <class T>
  [[nodiscard]] T number(const char* what) {
    const std::string_view text = take(what);
    T value{};
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error == std::errc::result_out_of_range) return out_of_range<T>(text, what);
    if (error != std::errc() || end != text.data() + text.size()) {
      throw BadLine{std::string(what) + ": '" + shown(text) + "' is not a number"};
    }
    return value;
  }

  [[nodiscard]] double finite(const char* what) {
    const auto value = number<double>(what);
    if (!std::isfinite(value)) throw BadLine{std::string(what) + ": must be a finite number"};
    return value;
  }

  [[nodiscard]] double coordinate(const char* what) {
    const double value = finite(what);
    if (std::abs(value) > farthest_m)
      throw BadLine{fmt::format("{}: {} m is too far, at most {} m are allowed", what, value, farthest_m)};
    return value;
  }

  [[nodiscard]] Pose2 pose(const char* what) {
    const double x = coordinate(what);
    const double y = coordinate(what);
    return {x, y, wrap_angle(finite(what))};
  }

  [[nodiscard]] std::size_t count(const char* what, std::size_t least) {
    const auto value = number<long long>(what);
    if (value < static_cast<long long>(least) || value > static_cast<long long>(max_readings)) {
      throw BadLine{std::string(what) + ": " + std::to_string(value) + " is out of range, must be " +
                    std::to_string(least) + " to " + std::to_string(max_readings)};
    }
    return static_cast<std::size_t>(value);
  }

  /// `expected` fields in all, the tag included.
  void must_be(std::size_t expected) const {
    if (size() == expected) return;
    throw BadLine{"has " + std::to_string(size()) + " fields where " + std::to_string(expected) +
                  " are needed"};
  }
  /// The same for a line that says how many readings it has.
  void must_hold(std::size_t readings, std::size_t expected) const {
    if (size() == expected) return;
    const long long has =
        static_cast<long long>(readings) + static_cast<long long>(size()) - static_cast<long long>(expected);
    throw BadLine{"says " + std::to_string(readings) + " readings but has room for " +
                  std::to_string(std::max(has, 0LL)) + " (" + std::to_string(size()) + " fields, " +
                  std::to_string(expected) + " needed)"};
  }

 private:
  [[nodiscard]] std::string_view take(const char* what) {
    if (next_ >= fields_.size()) throw BadLine{std::string("ends before ") + what};
    return fields_[next_++];
  }
  /// Numbers too small for T are 0, as good as; too large ones are not to be trusted.
  template <class T>
  static T out_of_range(std::string_view text, const char* what) {
    if (text.find("e-") != std::string_view::npos || text.find("E-") != std::string_view::npos) return T{};
    throw BadLine{std::string(what) + ": '" + shown(text) + "' is out of range"};
  }

  std::vector<std::string_view> fields_;
  std::size_t next_ = 0;
};

std::vector<float> read_ranges(Fields& fields, std::size_t n) {
  std::vector<float> ranges(n);
  for (float& range : ranges) range = fields.number<float>("reading");
  return ranges;
}

/// Older loggers write the robot's heading for the rear laser, newer ones its own.
bool heading_is_the_robots(const CarmenScan& scan) {
  return scan.laser == CarmenLaser::rlaser && std::abs(scan.robot_from_laser.theta) < std::numbers::pi / 2;
}

class Parser {
 public:
  explicit Parser(const std::filesystem::path& file) : file_(file.string()) {}

  std::vector<CarmenScan> parse(std::string_view content) {
    if (content.find_first_not_of(" \t\r\n") == std::string_view::npos) {
      throw ConfigError(file_, "is empty; a CARMEN log with laser scans is needed");
    }
    content = without_byte_order_mark(content);
    ends_in_newline_ = content.ends_with('\n');
    while (!content.empty() && faults_.size() < max_faults) {
      const std::size_t end = content.find('\n');
      const std::string_view line = content.substr(0, end);
      content.remove_prefix(end == std::string_view::npos ? content.size() : end + 1);
      ++line_;
      check_length(line);
      parse_line(line, content.empty());
    }
    if (faults_.empty() && scans_.empty()) {
      faults_.push_back({file_, 0, 0, "has no FLASER, RLASER or ROBOTLASER1 line; is this a CARMEN log?"});
    }
    if (!faults_.empty()) throw ConfigError(std::move(faults_));
    return std::move(scans_);
  }

 private:
  /// A file with such a line is something else.
  void check_length(std::string_view line) const {
    if (line.size() <= max_line) return;
    throw ConfigError({{file_, line_, 0,
                        "the line has " + std::to_string(line.size()) + " bytes, at most " +
                            std::to_string(max_line) + " are allowed; is this a CARMEN log?"}});
  }

  void parse_line(std::string_view line, bool last) {
    if (line.empty() || std::string_view("FROT").find(line.front()) == std::string_view::npos) return;
    fields_.split(line);
    fields_.skip(1);
    try {
      if (fields_.tag() == "FLASER") {
        add_scan(read_laser(CarmenLaser::flaser));
      } else if (fields_.tag() == "RLASER") {
        add_scan(read_laser(CarmenLaser::rlaser));
      } else if (fields_.tag() == "ROBOTLASER1") {
        add_scan(read_robotlaser());
      } else if (fields_.tag() == "TRUEPOS") {
        fields_.must_be(10);
        map_from_laser_ = fields_.pose("reference pose");
      } else if (fields_.tag() == "ODOM") {
        // Scan lines carry the odometry pose that belongs to them, so nothing is kept.
        fields_.must_be(10);
        static_cast<void>(fields_.pose("odometry pose"));
      }
    } catch (const BadLine& bad) {
      const char* hint = last && !ends_in_newline_
                             ? "; the log is cut off here: delete this line or get a fresh copy"
                             : "; delete the line or get a fresh copy of the log";
      faults_.push_back({file_, line_, 0, std::string(fields_.tag()) + ' ' + bad.message + hint});
    }
  }

  CarmenScan read_laser(CarmenLaser laser) {
    const std::size_t n = fields_.count("number of readings", 2);
    fields_.must_hold(n, n + 11);
    CarmenScan scan;
    scan.laser = laser;
    scan.ranges = read_ranges(fields_, n);
    scan.start_angle = -std::numbers::pi / 2;
    scan.angle_step = std::numbers::pi / static_cast<double>(n % 2 == 0 ? n : n - 1);
    read_poses(scan);
    return scan;
  }

  CarmenScan read_robotlaser() {
    CarmenScan scan;
    scan.laser = CarmenLaser::robotlaser1;
    fields_.skip(1);  // laser type
    scan.start_angle = fields_.finite("start angle");
    fields_.skip(1);  // field of view: start, step and number say it already
    scan.angle_step = fields_.finite("angular resolution");
    scan.max_range = fields_.finite("maximum range");
    fields_.skip(2);  // accuracy, remission mode
    const std::size_t n = fields_.count("number of readings", 1);
    if (fields_.size() < n + 24) fields_.must_hold(n, n + 24);
    scan.ranges = read_ranges(fields_, n);
    const std::size_t remissions = fields_.count("number of remissions", 0);
    fields_.must_hold(n, n + 24 + remissions);
    fields_.skip(remissions);
    check_geometry(scan);
    const std::size_t velocities = 5;
    read_poses(scan, velocities);
    return scan;
  }

  static void check_geometry(const CarmenScan& scan) {
    const double span = scan.angle_step * static_cast<double>(scan.ranges.size() - 1);
    if (!(scan.angle_step > 0.0 && span <= 2.0 * std::numbers::pi + 1e-6)) {
      throw BadLine{"angular resolution: must be above 0 rad and keep all readings within a full turn"};
    }
    if (!(scan.max_range > 0.0)) throw BadLine{"maximum range: must be above 0 m"};
  }

  void read_poses(CarmenScan& scan, std::size_t fields_before_stamp = 0) {
    const Pose2 odom_from_laser = fields_.pose("laser pose");
    scan.odom_from_robot = fields_.pose("robot pose");
    scan.robot_from_laser = inverse(scan.odom_from_robot) * odom_from_laser;
    fields_.skip(fields_before_stamp);
    scan.stamp = fields_.finite("time stamp");
    if (const std::string fault = fault_of_stamp(scan.stamp); !fault.empty()) throw BadLine{fault};
  }

  void add_scan(CarmenScan scan) {
    scan.line = line_;
    if (map_from_laser_) scan.map_from_robot = *map_from_laser_ * inverse(scan.robot_from_laser);
    map_from_laser_.reset();
    if (heading_is_the_robots(scan)) {
      scan.robot_from_laser = scan.robot_from_laser * Pose2{0.0, 0.0, std::numbers::pi};
    }
    scans_.push_back(std::move(scan));
  }

  std::string file_;
  int line_ = 0;
  bool ends_in_newline_ = true;
  Fields fields_;
  std::optional<Pose2> map_from_laser_;
  std::vector<CarmenScan> scans_;
  std::vector<Fault> faults_;
};

}  // namespace

std::vector<CarmenScan> read_carmen_log(const std::filesystem::path& file) {
  const std::string content = read_decompressed(file);
  return Parser(file).parse(content);
}

}  // namespace glocal::carmen
