#include "evaluation/results/variant_order.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <map>
#include <nlohmann/json.hpp>
#include <tuple>
#include <utility>

#include "evaluation/results/atomic_file.hpp"
#include "evaluation/results/file_io.hpp"

namespace glocal {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* file_name = "variants.json";

bool begins_with_digit(std::string_view text) {
  return !text.empty() && std::isdigit(static_cast<unsigned char>(text.front())) != 0;
}

/// Takes the number off that the text begins with.
double take_number(std::string_view& text) {
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

std::map<std::string, std::size_t> kept_places(const fs::path& folder) {
  std::map<std::string, std::size_t> places;
  const Json names = Json::parse(content_of(folder / file_name), nullptr, false);
  if (!names.is_array()) return places;
  for (const Json& name : names) {
    if (name.is_string()) places.emplace(name.get<std::string>(), places.size());
  }
  return places;
}

}  // namespace

bool is_before(std::string_view a, std::string_view b) {
  const std::pair whole(a, b);
  while (!a.empty() && !b.empty()) {
    if (begins_with_digit(a) && begins_with_digit(b)) {
      const double x = take_number(a);
      const double y = take_number(b);
      if (x != y) return x < y;
    } else {
      if (a.front() != b.front()) return a.front() < b.front();
      a.remove_prefix(1);
      b.remove_prefix(1);
    }
  }
  if (a.empty() != b.empty()) return a.empty();
  return whole.first < whole.second;  // 1 and 1.0
}

void write_variant_order(const fs::path& folder, const std::vector<std::string>& names) {
  write_file(folder / file_name, Json(names).dump(2) + "\n");
}

void sort_by_variant(const fs::path& folder, std::vector<fs::path>& folders) {
  const std::map<std::string, std::size_t> places = kept_places(folder);
  const auto place = [&](const std::string& name) {
    const auto kept = places.find(name);
    return kept == places.end() ? places.size() : kept->second;
  };
  std::sort(folders.begin(), folders.end(), [&](const fs::path& a, const fs::path& b) {
    const std::string first = a.filename().string();
    const std::string second = b.filename().string();
    const std::size_t i = place(first);
    const std::size_t k = place(second);
    return i != k ? i < k : is_before(first, second);
  });
}

}  // namespace glocal
