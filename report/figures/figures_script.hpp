// figures.py, which CMake puts into the program.
#pragma once

#include <string_view>

namespace glocal::app {

[[nodiscard]] std::string_view figures_script();

}  // namespace glocal::app
