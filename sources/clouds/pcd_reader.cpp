#include <fmt/format.h>
#include <lzf.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "glocal/words.hpp"
#include "sources/clouds/cloud_formats.hpp"
#include "sources/clouds/scalar.hpp"
#include "sources/text_lines.hpp"

namespace glocal::clouds {
namespace {

struct PcdField {
  std::string_view name;
  Scalar type = Scalar::float32;
  std::size_t values = 1;       ///< COUNT
  std::size_t offset = 0;       ///< Of its first byte in a point.
  std::size_t first_value = 0;  ///< Of all values of a point.
};

/// What was compressed by LZF; none if the data is damaged or does not make up `size` bytes.
std::optional<std::string> decompressed(std::string_view data, std::size_t size) {
  // Three bytes stand for 264 at most: memory is taken only for what the data can hold.
  constexpr std::size_t most_of_one = 88;
  if (size / most_of_one > data.size()) return std::nullopt;
  std::string bytes(size, '\0');
  const auto from = static_cast<unsigned>(data.size()), to = static_cast<unsigned>(size);
  // The library looks at a first byte in any case.
  const unsigned found = data.empty() ? 0 : lzf_decompress(data.data(), from, bytes.data(), to);
  if (found != size) return std::nullopt;
  return bytes;
}

/// The header's lines, and what they mean.
class PcdHeader {
 public:
  PcdHeader(std::string_view content, const std::string& file) : file_(file), lines_(content) {
    while (!entries_.contains("DATA")) {
      if (!lines_.next_with_fields())
        refuse(lines_.number(), "the header ends without a DATA line; get a fresh copy");
      if (lines_.fields().front().starts_with('#')) continue;
      note_entry();
    }
    read_fields();
    read_points();
    read_viewpoint();
  }

  [[nodiscard]] const std::vector<PcdField>& fields() const { return fields_; }
  [[nodiscard]] std::size_t points() const { return points_; }
  /// Bytes of a point.
  [[nodiscard]] std::size_t point_size() const { return point_size_; }
  [[nodiscard]] std::size_t values_per_point() const { return values_per_point_; }
  [[nodiscard]] const Pose3& viewpoint() const { return viewpoint_; }
  [[nodiscard]] int fields_line() const { return entries_.at("FIELDS").line; }
  [[nodiscard]] int data_line() const { return entries_.at("DATA").line; }
  [[nodiscard]] std::string_view data_kind() const {
    const Entry& data = entries_.at("DATA");
    return data.values.empty() ? std::string_view() : data.values.front();
  }
  /// What follows the header.
  [[nodiscard]] const TextLines& data() const { return lines_; }

 private:
  struct Entry {
    int line = 0;
    std::vector<std::string_view> values;
  };

  [[noreturn]] void refuse(int line, std::string message) const {
    refuse_cloud(file_, line, std::move(message));
  }

  void note_entry() {
    constexpr std::array<std::string_view, 10> known = {"VERSION", "FIELDS", "SIZE",      "TYPE",   "COUNT",
                                                        "WIDTH",   "HEIGHT", "VIEWPOINT", "POINTS", "DATA"};
    const std::vector<std::string_view>& words = lines_.fields();
    // What FIELDS was called in the first versions.
    const std::string_view key = words.front() == "COLUMNS" ? "FIELDS" : words.front();
    if (std::find(known.begin(), known.end(), key) == known.end())
      refuse(lines_.number(),
             fmt::format("'{}' is no line of a PCD header; DATA and all it needs must come before the points",
                         shown(key)));
    const Entry entry{lines_.number(), {words.begin() + 1, words.end()}};
    if (!entries_.emplace(key, entry).second)
      refuse(lines_.number(), fmt::format("has {} a second time; delete one of the lines", key));
  }

  /// The entry's values, one for each field; empty if there is no such line.
  std::vector<std::string_view> one_for_each_field(std::string_view key) const {
    const auto entry = entries_.find(key);
    if (entry == entries_.end()) return {};
    const auto& values = entry->second.values;
    if (values.size() != fields_.size())
      refuse(entry->second.line, fmt::format("{} has {} values for {} fields; give one for each", key,
                                             values.size(), fields_.size()));
    return values;
  }

  void read_fields() {
    if (!entries_.contains("FIELDS"))
      refuse(data_line(), "the header has no FIELDS line; FIELDS x y z is the least");
    for (const std::string_view name : entries_.at("FIELDS").values) fields_.push_back({name});
    read_types();
    const auto counts = one_for_each_field("COUNT");
    constexpr std::size_t most_bytes = 1'000'000;
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      PcdField& field = fields_[i];
      const auto values = counts.empty() ? 1 : whole_number_in(counts[i]);
      if (!values || *values == 0 || *values > most_bytes)
        refuse(entries_.at("COUNT").line,
               fmt::format("'{}' is no number of values from 1 to {}", shown(counts[i]), most_bytes));
      field.values = *values;
      field.offset = point_size_;
      field.first_value = values_per_point_;
      values_per_point_ += field.values;
      point_size_ += field.values * size_of(field.type);
      if (point_size_ > most_bytes)
        refuse(fields_line(), fmt::format("a point has over {} bytes; is this a cloud?", most_bytes));
    }
  }

  void read_types() {
    const auto sizes = one_for_each_field("SIZE");
    const auto types = one_for_each_field("TYPE");
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      const std::string_view type = types.empty() ? "F" : types[i];
      const std::string_view size = sizes.empty() ? "4" : sizes[i];
      const auto scalar = value_named<Scalar>(fmt::format("{}{}", type, size),
                                              {"I1", "U1", "I2", "U2", "I4", "U4", "F4", "F8", "I8", "U8"});
      if (!scalar)
        refuse(entries_.at(types.empty() ? "SIZE" : "TYPE").line,
               fmt::format("field '{}' is of TYPE {} and SIZE {}; there are I and U of 1, 2, 4 and 8 bytes, "
                           "and F of 4 and 8",
                           shown(fields_[i].name), shown(type), shown(size)));
      fields_[i].type = *scalar;
    }
  }

  std::optional<std::size_t> count_of(std::string_view key) const {
    const auto entry = entries_.find(key);
    if (entry == entries_.end()) return std::nullopt;
    const auto& values = entry->second.values;
    const auto count = values.size() == 1 ? whole_number_in(values.front()) : std::nullopt;
    if (!count) refuse(entry->second.line, fmt::format("{} must be one whole number, 0 or more", key));
    return count;
  }

  void read_points() {
    const auto points = count_of("POINTS"), width = count_of("WIDTH");
    if (!points && !width) refuse(data_line(), "the header has neither POINTS nor WIDTH; add POINTS");
    const std::size_t height = count_of("HEIGHT").value_or(1);
    points_ = points ? *points : *width;
    if (!width) return;
    const bool is_product =
        height == 0 ? points.value_or(0) == 0
                    : *width <= SIZE_MAX / height && points.value_or(*width * height) == *width * height;
    if (!is_product)
      refuse(entries_.at(points ? "POINTS" : "WIDTH").line,
             fmt::format("POINTS {} is not WIDTH {} times HEIGHT {}; put the header right, or get a fresh "
                         "copy",
                         points_, *width, height));
    points_ = *width * height;
  }

  void read_viewpoint() {
    const auto entry = entries_.find("VIEWPOINT");
    if (entry == entries_.end()) return;
    std::vector<double> v;
    for (const std::string_view value : entry->second.values) v.push_back(number_in(value).value_or(NAN));
    const bool are_numbers = v.size() == 7 && std::all_of(v.begin(), v.end(), [](double number) {
                               return std::abs(number) <= farthest_m;
                             });
    const double length = are_numbers ? std::hypot(std::hypot(v[3], v[4]), std::hypot(v[5], v[6])) : 0.0;
    constexpr double tolerance = 1e-2;
    if (std::abs(length - 1.0) > tolerance)
      refuse(entry->second.line,
             "VIEWPOINT must be a place and a unit quaternion: tx ty tz qw qx qy qz; 0 0 0 1 0 0 0 is none");
    viewpoint_ = {{v[0], v[1], v[2]}, {v[3] / length, v[4] / length, v[5] / length, v[6] / length}};
  }

  const std::string& file_;
  TextLines lines_;
  std::map<std::string_view, Entry> entries_;
  std::vector<PcdField> fields_;
  std::size_t points_ = 0, point_size_ = 0, values_per_point_ = 0;
  Pose3 viewpoint_;
};

/// A file that announces points, and brings them or not.
class PcdReader {
 public:
  PcdReader(std::string_view content, const std::string& file, const CloudOptions& options)
      : file_(file),
        max_bytes_(options.max_size_gb * 1e9),
        header_(content, file),
        columns_(columns()),
        cloud_(file, options, columns_, time_unit()) {}

  Cloud read() {
    if (header_.data_kind() == "ascii") {
      read_ascii();
    } else if (header_.data_kind() == "binary") {
      read_binary();
    } else if (header_.data_kind() == "binary_compressed") {
      read_compressed();
    } else {
      refuse_cloud(file_, header_.data_line(),
                   fmt::format("'{}' is no kind of data; there are ascii, binary and binary_compressed",
                               shown(header_.data_kind())));
    }
    Cloud cloud = cloud_.finish();
    cloud.viewpoint = header_.viewpoint();
    return cloud;
  }

 private:
  ChannelColumns columns() const {
    std::vector<std::string_view> names;
    for (const PcdField& field : header_.fields()) names.push_back(field.name);
    return channel_columns(names, file_, header_.fields_line());
  }

  /// Whole numbers are nanoseconds, all others seconds.
  double time_unit() const {
    const auto& column = columns_[static_cast<std::size_t>(Channel::time)];
    return column && is_whole(header_.fields()[*column].type) ? 1e-9 : 1.0;
  }

  [[noreturn]] void refuse_number_of_points(const std::string& there) const {
    refuse_cloud(
        file_, header_.data_line(),
        fmt::format("the header announces {} points, but {}; get a fresh copy", header_.points(), there));
  }

  void read_ascii() {
    TextLines lines = header_.data();
    std::size_t points = 0;
    for (; lines.next_with_fields(); ++points) {
      const auto& fields = lines.fields();
      if (fields.size() != header_.values_per_point())
        refuse_cloud(file_, lines.number(),
                     fmt::format("has {} values where a point has {}; delete the line and put POINTS and "
                                 "WIDTH right, or get a fresh copy",
                                 fields.size(), header_.values_per_point()));
      PointValues values{};
      for (std::size_t i = 0; i < channels; ++i) {
        if (!columns_.at(i)) continue;
        const std::string_view text = fields[header_.fields()[*columns_.at(i)].first_value];
        const auto number = number_in(text);
        if (!number) refuse_cloud(file_, lines.number(), fmt::format("'{}' is not a number", shown(text)));
        values.at(i) = *number;
      }
      cloud_.add(values, lines.number());
    }
    if (points != header_.points()) refuse_number_of_points(fmt::format("{} lines follow", points));
  }

  void read_binary() {
    const std::string_view data = header_.data().rest();
    if (data.size() / header_.point_size() != header_.points() || data.size() % header_.point_size() != 0)
      refuse_number_of_points(
          fmt::format("{} bytes follow, and a point has {}", data.size(), header_.point_size()));
    take_points(data, [&](const PcdField& field) { return std::pair(field.offset, header_.point_size()); });
  }

  /// Two sizes, of the compressed data and of all fields; then the fields, one after the other.
  void read_compressed() {
    constexpr std::size_t size_bytes = 4;
    const std::string_view data = header_.data().rest();
    if (data.size() < 2 * size_bytes) refuse_number_of_points("nothing follows");
    const auto size_at = [&](std::size_t at) {
      return std::size_t{number_at<std::uint32_t>(data.data() + at, std::endian::little)};
    };
    const std::size_t compressed = size_at(0), size = size_at(size_bytes);
    if (size / header_.point_size() != header_.points() || size % header_.point_size() != 0)
      refuse_number_of_points(fmt::format("the data is said to unpack to {} bytes, and a point has {}", size,
                                          header_.point_size()));
    if (static_cast<double>(size) > max_bytes_)
      refuse_cloud(file_, 0,
                   fmt::format("its points have more than {} GB when decompressed; if it is the right file, "
                               "thin it out",
                               max_bytes_ / 1e9));
    if (compressed > data.size() - 2 * size_bytes)
      refuse_number_of_points(fmt::format("{} bytes follow where compressed data of {} bytes is announced",
                                          data.size() - 2 * size_bytes, compressed));
    const auto unpacked = decompressed(data.substr(2 * size_bytes, compressed), size);
    if (!unpacked) refuse_cloud(file_, 0, "the compressed data is damaged; get a fresh copy");
    take_points(*unpacked, [&](const PcdField& field) {
      return std::pair(field.offset * header_.points(), field.values * size_of(field.type));
    });
  }

  /// `layout_of`: of a field, where its first byte is, and how far it is from one point to the next.
  template <class LayoutOf>
  void take_points(std::string_view data, LayoutOf layout_of) {
    struct Place {
      std::size_t channel;
      Scalar type;
      std::size_t first, step;
    };
    std::vector<Place> places;
    for (std::size_t i = 0; i < channels; ++i) {
      if (!columns_.at(i)) continue;
      const PcdField& field = header_.fields()[*columns_.at(i)];
      const auto [first, step] = layout_of(field);
      places.push_back({i, field.type, first, step});
    }
    PointValues values{};
    for (std::size_t i = 0; i < header_.points(); ++i) {
      for (const Place& p : places)
        values.at(p.channel) = number_at(data.data() + p.first + i * p.step, p.type, std::endian::little);
      cloud_.add(values);
    }
  }

  const std::string& file_;
  double max_bytes_;
  PcdHeader header_;
  ChannelColumns columns_;
  CloudBuilder cloud_;
};

}  // namespace

bool is_pcd(std::string_view content) {
  TextLines lines(content);
  while (lines.next_with_fields()) {
    const std::string_view word = lines.fields().front();
    if (lines.number() == 1 && word == "#" && lines.fields().size() > 1 && lines.fields()[1] == ".PCD")
      return true;
    if (word.starts_with('#')) continue;
    return word == "VERSION" || word == "FIELDS" || word == "COLUMNS";
  }
  return false;
}

Cloud read_pcd_cloud(std::string_view content, const std::string& file, const CloudOptions& options) {
  return PcdReader(content, file, options).read();
}

}  // namespace glocal::clouds
