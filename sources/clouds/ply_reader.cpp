#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "glocal/words.hpp"
#include "sources/clouds/cloud_formats.hpp"
#include "sources/clouds/scalar.hpp"
#include "sources/text_lines.hpp"

namespace glocal::clouds {
namespace {

struct PlyProperty {
  std::string_view name;
  Scalar type = Scalar::float32;
  std::optional<Scalar> length = {};  ///< Type of the number of entries, if it is a list.
};

/// Things of one kind: vertices, faces.
struct PlyElement {
  std::string_view name;
  std::size_t items = 0;
  std::vector<PlyProperty> properties = {};
  int line = 0;
};

enum class PlyFormat { ascii, little_endian, big_endian };

/// There are no whole numbers of eight bytes.
std::optional<Scalar> ply_scalar(std::string_view name) {
  const auto scalar =
      value_named<Scalar>(name, {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"});
  if (scalar) return scalar;
  return value_named<Scalar>(name,
                             {"int8", "uint8", "int16", "uint16", "int32", "uint32", "float32", "float64"});
}

class PlyHeader {
 public:
  PlyHeader(std::string_view content, const std::string& file) : file_(file), lines_(content) {
    lines_.next();  // "ply"
    for (bool ended = false; !ended; ended = lines_.fields().front() == "end_header") {
      if (!lines_.next_with_fields()) refuse("the header ends without an end_header line; get a fresh copy");
      read_line();
    }
    if (!format_) refuse("the header has no format line; format ascii 1.0 is one");
    if (vertices() == elements_.size()) refuse("there is no element vertex; a cloud is needed");
  }

  [[nodiscard]] PlyFormat format() const { return *format_; }
  [[nodiscard]] const std::vector<PlyElement>& elements() const { return elements_; }
  /// Which element has the points.
  [[nodiscard]] std::size_t vertices() const {
    std::size_t i = 0;
    while (i < elements_.size() && elements_[i].name != "vertex") ++i;
    return i;
  }
  /// What follows the header.
  [[nodiscard]] const TextLines& data() const { return lines_; }

 private:
  [[noreturn]] void refuse(std::string message) const {
    refuse_cloud(file_, lines_.number(), std::move(message));
  }

  void read_line() {
    const auto& words = lines_.fields();
    if (words[0] == "format") {
      read_format(words.size() > 1 ? words[1] : std::string_view());
    } else if (words[0] == "element") {
      const auto items = words.size() == 3 ? whole_number_in(words[2]) : std::nullopt;
      if (!items) refuse("an element has a name and a number of items: element vertex 100");
      elements_.push_back({words[1], *items, {}, lines_.number()});
    } else if (words[0] == "property") {
      read_property(words);
    } else if (words[0] != "comment" && words[0] != "obj_info" && words[0] != "end_header") {
      refuse(fmt::format("'{}' is no line of a PLY header; delete it or get a fresh copy", shown(words[0])));
    }
  }

  void read_format(std::string_view name) {
    if (name == "ascii") {
      format_ = PlyFormat::ascii;
    } else if (name == "binary_little_endian") {
      format_ = PlyFormat::little_endian;
    } else if (name == "binary_big_endian") {
      format_ = PlyFormat::big_endian;
    } else {
      refuse(fmt::format("'{}' is no format; there are ascii, binary_little_endian and binary_big_endian",
                         shown(name)));
    }
  }

  void read_property(const std::vector<std::string_view>& words) {
    const bool is_list = words.size() == 5 && words[1] == "list";
    if (!is_list && words.size() != 3)
      refuse("a property has a type and a name (property float x), or is a list of two types and a name");
    if (elements_.empty()) refuse("a property needs an element before it: element vertex 100");
    PlyProperty property{words.back(), type_called(words[words.size() - 2])};
    if (is_list) {
      property.length = type_called(words[2]);
      if (!is_whole(*property.length)) refuse("a list needs a whole number for its length: uchar, int …");
    }
    elements_.back().properties.push_back(property);
  }

  Scalar type_called(std::string_view name) const {
    const auto type = ply_scalar(name);
    if (!type)
      refuse(
          fmt::format("'{}' is no type; there are char, uchar, short, ushort, int, uint, float, double, "
                      "and int8 … uint32, float32, float64",
                      shown(name)));
    return *type;
  }

  const std::string& file_;
  TextLines lines_;
  std::optional<PlyFormat> format_;
  std::vector<PlyElement> elements_;
};

/// The numbers of a text, an item a line.
class PlyText {
 public:
  PlyText(const TextLines& lines, const std::string& file) : file_(file), lines_(lines) {}

  [[nodiscard]] bool begin_item() {
    next_ = 0;
    return lines_.next_with_fields();
  }
  [[nodiscard]] bool has_more() { return begin_item(); }
  void end_item() const {
    if (next_ != lines_.fields().size())
      refuse(fmt::format("has {} values where {} are needed; put it right or get a fresh copy",
                         lines_.fields().size(), next_));
  }
  [[nodiscard]] double take(Scalar /*type*/) {
    if (next_ == lines_.fields().size())
      refuse(fmt::format("ends after {} values; put it right or get a fresh copy", next_));
    const std::string_view text = lines_.fields()[next_++];
    const auto number = number_in(text);
    if (!number) refuse(fmt::format("'{}' is not a number", shown(text)));
    return *number;
  }
  void skip(Scalar type, std::size_t n) {
    for (std::size_t i = 0; i < n; ++i) static_cast<void>(take(type));
  }
  [[noreturn]] void refuse(std::string message) const {
    refuse_cloud(file_, lines_.number(), std::move(message));
  }
  [[nodiscard]] int line() const { return lines_.number(); }

 private:
  const std::string& file_;
  TextLines lines_;
  std::size_t next_ = 0;
};

/// The numbers of binary data.
class PlyBytes {
 public:
  PlyBytes(std::string_view data, std::endian order, const std::string& file)
      : file_(file), data_(data), order_(order) {}

  [[nodiscard]] bool begin_item() const { return at_ < data_.size(); }
  /// Than the end of a line.
  [[nodiscard]] bool has_more() const { return data_.size() - at_ > 2; }
  void end_item() const {}
  [[nodiscard]] double take(Scalar type) {
    const std::size_t begin = at_;
    skip(type, 1);
    return number_at(data_.data() + begin, type, order_);
  }
  void skip(Scalar type, std::size_t n) {
    if (n > (data_.size() - at_) / size_of(type))
      refuse(fmt::format("ends {} bytes behind the header, within an item; get a fresh copy", data_.size()));
    at_ += n * size_of(type);
  }
  [[noreturn]] void refuse(std::string message) const { refuse_cloud(file_, 0, std::move(message)); }
  [[nodiscard]] static int line() { return 0; }

 private:
  const std::string& file_;
  std::string_view data_;
  std::endian order_;
  std::size_t at_ = 0;
};

/// The numbers of an item; lists are passed over and stand as NaN.
template <class Data>
void take_item(Data& data, const PlyElement& element, std::vector<double>& values) {
  values.clear();
  for (const PlyProperty& property : element.properties) {
    values.push_back(property.length ? NAN : data.take(property.type));
    if (!property.length) continue;
    const double entries = data.take(*property.length);
    constexpr double most = 4294967295.0;  // of uint
    if (!(entries >= 0.0 && entries <= most && entries == std::floor(entries)))
      data.refuse(fmt::format("a list '{}' of {} entries; get a fresh copy", shown(property.name), entries));
    data.skip(property.type, static_cast<std::size_t>(entries));
  }
  data.end_item();
}

template <class Data>
Cloud take_vertices(Data data, const PlyHeader& header, const std::string& file,
                    const CloudOptions& options) {
  const PlyElement& vertices = header.elements()[header.vertices()];
  std::vector<std::string_view> names;
  for (const PlyProperty& property : vertices.properties)
    names.push_back(property.length ? std::string_view() : property.name);
  const ChannelColumns columns = channel_columns(names, file, vertices.line);
  const auto& time = columns[static_cast<std::size_t>(Channel::time)];
  // Whole numbers are nanoseconds, all others seconds.
  const double time_unit = time && is_whole(vertices.properties[*time].type) ? 1e-9 : 1.0;
  CloudBuilder cloud(file, options, columns, time_unit);
  std::vector<double> values;
  for (std::size_t e = 0; e <= header.vertices(); ++e) {
    const PlyElement& element = header.elements()[e];
    if (element.properties.empty()) continue;  // Its items take no room.
    for (std::size_t i = 0; i < element.items; ++i) {
      if (!data.begin_item())
        data.refuse(fmt::format("the header announces {} items of '{}', but {} follow; get a fresh copy",
                                element.items, shown(element.name), i));
      take_item(data, element, values);
      if (e < header.vertices()) continue;
      PointValues point{};
      for (std::size_t c = 0; c < channels; ++c) {
        if (columns.at(c)) point.at(c) = values[*columns.at(c)];
      }
      cloud.add(point, data.line());
    }
  }
  if (header.vertices() + 1 == header.elements().size() && data.has_more())
    data.refuse(
        fmt::format("the header announces {} points, but more follow; get a fresh copy", vertices.items));
  return cloud.finish();
}

}  // namespace

bool is_ply(std::string_view content) {
  return content.starts_with("ply\n") || content.starts_with("ply\r\n");
}

Cloud read_ply_cloud(std::string_view content, const std::string& file, const CloudOptions& options) {
  const PlyHeader header(content, file);
  if (header.format() == PlyFormat::ascii)
    return take_vertices(PlyText(header.data(), file), header, file, options);
  const bool is_little = header.format() == PlyFormat::little_endian;
  return take_vertices(
      PlyBytes(header.data().rest(), is_little ? std::endian::little : std::endian::big, file), header, file,
      options);
}

}  // namespace glocal::clouds
