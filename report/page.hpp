// A page with its data in it: one file that needs nothing else.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace glocal {

/// JSON as text. What is not UTF-8 in it, such as names of folders may have, is replaced.
[[nodiscard]] std::string json_text(const nlohmann::ordered_json& data);

/// What the page needs to show these data in space; nothing if their maps are planar. It is larger than all
/// the rest of the page.
[[nodiscard]] std::string_view script_for(const nlohmann::ordered_json& data);

/// The page with title and data in the place of its two marks, and a script that the data need right after
/// them.
[[nodiscard]] std::string page_with(std::string_view page, const std::string& title,
                                    const nlohmann::ordered_json& data, std::string_view script = {});

}  // namespace glocal
