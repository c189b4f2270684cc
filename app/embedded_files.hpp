// The files of templates/ and completion/, which CMake puts into the program.
#pragma once

#include <string>
#include <string_view>

namespace glocal::app {

/// A file by its name: "matcher.cpp", "CMakeLists.txt" (of templates/, without ".in"), "glocal.bash" … Throws
/// std::out_of_range if there is none.
[[nodiscard]] std::string embedded_file(std::string_view name);
[[nodiscard]] bool has_embedded_file(std::string_view name);

}  // namespace glocal::app
