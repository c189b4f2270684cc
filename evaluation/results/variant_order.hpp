// In which order the variants of an experiment are told.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace glocal {

/// Keeps in a folder of results, which is there, the names of the variants, in the order of their file
/// (variants.json).
void write_variant_order(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// Sorts the folders of results in `folder`: in the order that is kept there, and then others by their names.
/// Without one, or with one that is damaged, all go by their names.
void sort_by_variant(const std::filesystem::path& folder, std::vector<std::filesystem::path>& folders);

/// Whether a name comes before another one. Numbers in them count as such: "angle-5" before "angle-10".
[[nodiscard]] bool is_before(std::string_view a, std::string_view b);

}  // namespace glocal
