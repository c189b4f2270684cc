#include "glocal/error.hpp"

#include <algorithm>
#include <utility>

#include "glocal/words.hpp"

namespace glocal {
namespace {

std::string in_lines(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) {
    if (!text.empty()) text += '\n';
    text += to_string(fault);
  }
  return text;
}

/// Sorted; of very many, those that nobody would read are only counted.
std::vector<Fault> sorted(std::vector<Fault> faults) {
  constexpr std::size_t most = 200;
  std::ranges::sort(faults);
  if (faults.size() <= most) return faults;
  const std::size_t more = faults.size() - most;
  faults.resize(most + 1);
  faults.back().message =
      "here and below are at least " + std::to_string(more) + " more; mend those above first";
  return faults;
}

}  // namespace

std::string to_string(const Fault& fault) {
  std::string text = fault.file;
  if (fault.line > 0) text += ':' + std::to_string(fault.line);
  if (fault.line > 0 && fault.column > 0) text += ':' + std::to_string(fault.column);
  if (!text.empty()) text += ": ";
  return fit_message(text + "error: " + fault.message);
}

ConfigError::ConfigError(std::vector<Fault> faults)
    : std::runtime_error(in_lines(sorted(faults))), faults_(sorted(std::move(faults))) {}

ConfigError::ConfigError(const std::filesystem::path& place, const std::string& message)
    : ConfigError({{place.string(), 0, 0, message}}) {}

}  // namespace glocal
