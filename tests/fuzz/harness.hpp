// What all fuzzers share. Each is a function that reads its input as the program would; ConfigError and
// RunError are answers, and whatever else leaves it is a fault.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/error.hpp"

namespace glocal::fuzz {

[[nodiscard]] inline std::string text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Writes a file into a folder of this process, which is removed when it ends; `name` may lie in folders
/// below.
std::filesystem::path write(const std::string& name, std::string_view content);

/// What belongs together is one input, cut at lines of dashes ("----"). The last part takes the rest, and
/// parts that are not there are empty.
[[nodiscard]] std::vector<std::string> parts(std::string_view input, std::size_t n);

/// All strategies of the program.
[[nodiscard]] const Catalog& catalog();

/// Throws what is no answer where something does not hold.
void must_hold(bool holds, const char* what);

template <class Read>
int answer(const Read& read) {
  try {
    read();
  } catch (const ConfigError&) {
  } catch (const RunError&) {
  }
  return 0;
}

}  // namespace glocal::fuzz
