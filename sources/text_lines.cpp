#include "sources/text_lines.hpp"

#include <algorithm>
#include <charconv>

namespace glocal {
namespace {

constexpr std::string_view field_ends = " \t\r";

}  // namespace

void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
  fields.clear();
  std::size_t begin = line.find_first_not_of(field_ends);
  while (begin != std::string_view::npos) {
    const std::size_t end = std::min(line.find_first_of(field_ends, begin), line.size());
    fields.push_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(field_ends, end);
  }
}

std::optional<double> number_in(std::string_view field) {
  if (field.starts_with('+')) field.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (end != field.data() + field.size()) return std::nullopt;
  const bool is_small =
      field.find_first_of("eE") != std::string_view::npos && field[field.find_first_of("eE") + 1] == '-';
  if (error == std::errc::result_out_of_range && is_small) return 0.0;
  return error == std::errc() ? std::optional(value) : std::nullopt;
}

std::optional<std::size_t> whole_number_in(std::string_view field) {
  std::size_t value = 0;
  const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
  if (error != std::errc() || end != field.data() + field.size()) return std::nullopt;
  return value;
}

bool TextLines::next() {
  if (rest_.empty()) return false;
  const std::size_t end = rest_.find('\n');
  split_fields(rest_.substr(0, end), fields_);
  rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
  ++number_;
  return true;
}

bool TextLines::next_with_fields() {
  while (next()) {
    if (!fields_.empty()) return true;
  }
  return false;
}

}  // namespace glocal
