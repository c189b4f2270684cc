// The files of templates/, which CMake puts into the program.
#pragma once

#include <string>
#include <string_view>

namespace glocal::app {

/// The template of a file: "matcher.cpp", "CMakeLists.txt" … Throws std::out_of_range if there is none.
[[nodiscard]] std::string plugin_template(std::string_view file);

}  // namespace glocal::app
