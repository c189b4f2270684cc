#include "config/scalars.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <system_error>

#include "config/builtin_parts.hpp"
#include "config/nearest.hpp"
#include "config/text_file.hpp"

namespace glocal {
namespace {

constexpr std::string_view data_prefix = "data:", plugin_prefix = "plugin:";
constexpr std::string_view automatic = "auto";

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

/// A number's sign and what follows it.
struct Signed {
  bool negative;
  std::string_view digits;
};

Signed split_sign(std::string_view text) {
  const bool has_sign = text.starts_with('-') || text.starts_with('+');
  return {text.starts_with('-'), text.substr(has_sign ? 1 : 0)};
}

bool is_whole(std::string_view digits) {
  return !digits.empty() && std::ranges::all_of(digits, is_digit);
}

/// Digits with perhaps a fraction and an exponent, as in YAML's core schema: `12`, `1.5`, `.5`, `1.`, `1e-3`.
bool is_decimal(std::string_view digits) {
  // std::from_chars takes a sign and words such as `inf`, too.
  if (digits.empty() || !(is_digit(digits.front()) || digits.front() == '.')) return false;
  const char* end = digits.data() + digits.size();
  double value = 0.0;
  const auto read = std::from_chars(digits.data(), end, value);
  // A number that is out of range is one, too.
  return read.ec != std::errc::invalid_argument && read.ptr == end;
}

bool has_leading_zero(std::string_view digits) {
  return digits.size() > 1 && digits[0] == '0' && is_digit(digits[1]);
}

bool has_radix(std::string_view digits) {
  static constexpr std::string_view letters = "xXoObB";
  return digits.size() > 1 && digits[0] == '0' && letters.find(digits[1]) != std::string_view::npos;
}

/// A number's digits without the point that YAML writes before `nan` and `inf`, in small letters.
std::string as_word(std::string_view digits) {
  std::string lower(digits.substr(digits.starts_with('.') ? 1 : 0));
  std::transform(lower.begin(), lower.end(), lower.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return lower;
}

bool is_not_finite(std::string_view digits) {
  const std::string word = as_word(digits);
  return word == "nan" || word == "inf" || word == "infinity";
}

std::string without_leading_zeros(const Signed& number) {
  const std::size_t first = std::min(number.digits.find_first_not_of('0'), number.digits.size() - 1);
  // Keeps one zero before a point.
  const std::size_t from = is_digit(number.digits[first]) ? first : first - 1;
  return (number.negative ? "-" : "") + std::string(number.digits.substr(from));
}

/// What numbers of all types are refused for; `what` is the type.
Refusal check_notation(const YamlNode& node, std::string_view what) {
  const std::string expected = "expected " + std::string(what) + ", got " + name_of(node);
  if (node.kind != NodeKind::scalar) return expected;
  const Signed number = split_sign(node.text);
  if (node.quoted) return expected + (is_decimal(number.digits) ? " (remove the quotes)" : "");
  if (is_not_finite(number.digits)) return node.text + " is not a finite number";
  if (has_radix(number.digits))
    return node.text + " is not a decimal number; write it with the digits 0 to 9";
  if (!is_decimal(number.digits)) return expected;
  if (has_leading_zero(number.digits)) {
    return node.text + " has a leading zero; write " + without_leading_zeros(number);
  }
  return std::nullopt;
}

Refusal check_bounds(const std::string& text, double value, const FieldInfo& info) {
  if (value >= info.min && value <= info.max && (std::isinf(info.above) || value > info.above))
    return std::nullopt;
  return text + " is out of range, must be " + bounds_text(info);
}

template <class Whole>
Refusal take_whole(const YamlNode& node, const FieldInfo& info, Whole& value) {
  if (auto refusal = check_notation(node, "a whole number")) return refusal;
  const Signed number = split_sign(node.text);
  if (!is_whole(number.digits))
    return node.text + " is not a whole number; write it without point and exponent";
  if (std::is_unsigned_v<Whole> && number.negative) {
    FieldInfo not_negative = info;
    not_negative.min = std::max(info.min, 0.0);
    return check_bounds(node.text, -1.0, not_negative);
  }
  const std::string text = (number.negative ? "-" : "") + std::string(number.digits);
  Whole read = 0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), read);
  if (result.ec == std::errc::result_out_of_range) {
    using Limits = std::numeric_limits<Whole>;
    return node.text + (number.negative ? " is too small, must be >= " + std::to_string(Limits::min())
                                        : " is too large, must be <= " + std::to_string(Limits::max()));
  }
  if (auto refusal = check_bounds(node.text, static_cast<double>(read), info)) return refusal;
  value = read;
  return std::nullopt;
}

Refusal resolve(const std::string& text, const std::filesystem::path& folder,
                std::filesystem::path& resolved) {
  std::filesystem::path path(text);
  if (text.starts_with(data_prefix)) {
    const char* datasets = std::getenv("GLOCAL_DATASETS");
    if (datasets == nullptr || *datasets == '\0') {
      return "'" + text +
             "' needs the environment variable GLOCAL_DATASETS, which is not set; set it to the folder of "
             "the data sets";
    }
    const std::filesystem::path rest(text.substr(data_prefix.size()));
    if (rest.empty() || rest.is_absolute())
      return "expected a relative path after 'data:', got '" + text + "'";
    path = std::filesystem::absolute(datasets) / rest;
  } else if (text.starts_with(plugin_prefix)) {
    const std::string name = text.substr(plugin_prefix.size());
    const auto file = builtin_plugin(name);
    if (!file)
      return "the plugin '" + name + "' is not built here; install what it needs (scripts/setup --" + name +
             "), and build again";
    path = *file;
  } else {
    path = std::filesystem::absolute(folder) / path;
  }
  resolved = path.lexically_normal();
  return std::nullopt;
}

/// A bound as people write it: 100000000 rather than 1e+08.
std::string plain(double value) {
  constexpr double readable = 1e15;
  const bool whole = std::trunc(value) == value && std::abs(value) < readable;
  return whole ? std::to_string(static_cast<std::int64_t>(value)) : to_yaml(value);
}

bool is_plain_word(std::string_view text) {
  static constexpr std::array<std::string_view, 9> reserved = {"true", "false", "null", "yes", "no",
                                                               "on",   "off",   "y",    "n"};
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  if (text.empty() || !is_letter(text.front())) return false;
  std::string lower(text);
  for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  if (std::ranges::find(reserved, lower) != reserved.end()) return false;
  return std::ranges::all_of(text,
                             [&](char c) { return is_letter(c) || is_digit(c) || c == '-' || c == '.'; });
}

std::string double_quoted(std::string_view text) {
  static constexpr std::string_view hex = "0123456789ABCDEF";
  std::string result = "\"";
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      result += {'\\', c};
    } else if (byte < 0x20U || byte == 0x7FU) {
      result += {'\\', 'x', hex[byte >> 4U], hex[byte & 0xFU]};
    } else {
      result += c;
    }
  }
  return result + '"';
}

}  // namespace

Refusal take_value(const YamlNode& node, const FieldInfo& /*info*/, bool& value) {
  const bool plain = node.kind == NodeKind::scalar && !node.quoted;
  if (!plain || (node.text != "true" && node.text != "false")) {
    return "expected true or false, got " + name_of(node);
  }
  value = node.text == "true";
  return std::nullopt;
}

Refusal take_value(const YamlNode& node, const FieldInfo& info, int& value) {
  return take_whole(node, info, value);
}

Refusal take_value(const YamlNode& node, const FieldInfo& info, std::uint64_t& value) {
  return take_whole(node, info, value);
}

Refusal take_value(const YamlNode& node, const FieldInfo& info, double& value) {
  const bool is_plain = node.kind == NodeKind::scalar && !node.quoted;
  if (info.may_be_nan && is_plain && as_word(split_sign(node.text).digits) == "nan") {
    value = std::numeric_limits<double>::quiet_NaN();
    return std::nullopt;
  }
  if (auto refusal = check_notation(node, "a number")) return refusal;
  const std::string_view text = std::string_view(node.text).substr(node.text.starts_with('+') ? 1 : 0);
  double read = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), read);
  if (result.ec == std::errc::result_out_of_range) {
    return node.text + " is too large or too small for a number (64-bit floating point)";
  }
  if (auto refusal = check_bounds(node.text, read, info)) return refusal;
  value = read;
  return std::nullopt;
}

Refusal take_value(const YamlNode& node, const FieldInfo& info, std::optional<double>& value) {
  if (node.kind == NodeKind::scalar && !node.quoted && node.text == automatic) {
    value.reset();
    return std::nullopt;
  }
  if (auto refusal = check_notation(node, "a number or auto")) return refusal;
  double number = 0.0;
  if (auto refusal = take_value(node, info, number)) return refusal;
  value = number;
  return std::nullopt;
}

Refusal take_value(const YamlNode& node, const FieldInfo& info, std::string& value) {
  if (node.kind != NodeKind::scalar) return "expected text, got " + name_of(node);
  const auto& choices = info.choices;
  for (const FormerChoice& former : info.former_choices) {
    if (node.text == former.name) return "'" + node.text + "' is called '" + former.now + "' now";
  }
  if (!choices.empty() && std::ranges::find(choices, node.text) == choices.end()) {
    const auto near = nearest(node.text, choices);
    return "'" + node.text + "' is not one of " + join(choices) +
           (near ? " (did you mean '" + *near + "'?)" : "");
  }
  value = node.text;
  return std::nullopt;
}

Refusal take_value(const YamlNode& node, const FieldInfo& info, FilePath& value) {
  if (node.kind != NodeKind::scalar) return "expected a path, got " + name_of(node);
  if (node.text.empty()) {
    if (info.required) return "expected a path, got an empty text";
    value = {};
    return std::nullopt;
  }
  FilePath path{node.text, {}};
  if (auto refusal = resolve(node.text, node.place.origin->folder, path.resolved)) return refusal;
  std::error_code ignored;
  const bool is_folder = std::filesystem::is_directory(path.resolved, ignored);
  if (info.is_folder) {
    if (!is_folder) return "is no folder: " + path.resolved.string();
  } else if (!(is_folder && info.may_be_folder)) {
    if (auto refusal = why_unreadable(path.resolved)) return refusal;
  }
  value = std::move(path);
  return std::nullopt;
}

std::string bounds_text(const FieldInfo& info) {
  const std::string unit = *info.unit == '\0' ? "" : " " + std::string(info.unit);
  if (info.min == info.max) return plain(info.min) + unit;
  std::string low;
  if (std::isfinite(info.above)) {
    low = "> " + plain(info.above);
  } else if (std::isfinite(info.min)) {
    low = ">= " + plain(info.min);
  }
  const std::string high = std::isfinite(info.max) ? "<= " + plain(info.max) : "";
  if (low.empty() && high.empty()) return "";
  return low + (low.empty() || high.empty() ? "" : " and ") + high + unit;
}

std::string count_text(const FieldInfo& info) {
  const bool unbounded = info.max_items == std::numeric_limits<std::size_t>::max();
  if (unbounded) return info.min_items == 0 ? "" : "at least " + counted(info.min_items);
  if (info.min_items == info.max_items) return counted(info.max_items);
  if (info.min_items == 0) return "at most " + counted(info.max_items);
  return std::to_string(info.min_items) + " to " + counted(info.max_items);
}

std::string counted(std::size_t n) {
  return std::to_string(n) + (n == 1 ? " item" : " items");
}

std::string to_yaml(bool value) {
  return value ? "true" : "false";
}
std::string to_yaml(int value) {
  return std::to_string(value);
}
std::string to_yaml(std::uint64_t value) {
  return std::to_string(value);
}

std::string to_yaml(double value) {
  std::array<char, 32> buffer;
  const auto result = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
  return {buffer.data(), result.ptr};
}

std::string to_yaml(const std::optional<double>& value) {
  return value ? to_yaml(*value) : std::string(automatic);
}

std::string to_yaml(std::string_view value) {
  return is_plain_word(value) ? std::string(value) : double_quoted(value);
}

std::string to_yaml(const FilePath& value) {
  return double_quoted(value.text.empty() || value.text.starts_with(data_prefix) ? value.text
                                                                                 : value.resolved.string());
}

}  // namespace glocal
