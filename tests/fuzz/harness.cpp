#include "fuzz/harness.hpp"

#include <fstream>
#include <stdexcept>

#include "glocal/builtin.hpp"
#include "temporary_folder.hpp"

namespace glocal::fuzz {

namespace fs = std::filesystem;

fs::path write(const std::string& name, std::string_view content) {
  static const test::TemporaryFolder folder;
  fs::path file = folder.path() / name;
  if (std::ofstream out(file, std::ios::binary); out << content) return file;
  fs::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary) << content;
  return file;
}

std::vector<std::string> parts(std::string_view input, std::size_t n) {
  constexpr std::string_view cut = "----\n";
  std::vector<std::string> parts(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t end = i + 1 < n ? input.find(cut) : std::string_view::npos;
    parts[i] = input.substr(0, end);
    if (end == std::string_view::npos) break;
    input.remove_prefix(end + cut.size());
  }
  return parts;
}

const Catalog& catalog() {
  static Catalog all;
  static const bool are_registered = (register_builtin_strategies(all), true);
  static_cast<void>(are_registered);
  return all;
}

void must_hold(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

}  // namespace glocal::fuzz
