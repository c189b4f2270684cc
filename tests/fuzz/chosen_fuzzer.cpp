// What libFuzzer calls: the fuzzer that --fuzzer=NAME names.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "fuzz/fuzzers.hpp"

namespace {

// libFuzzer hands its inputs over without anything else.
// NOLINTNEXTLINE(cppcoreguidelines-avoid-non-const-global-variables)
int (*chosen)(const std::uint8_t* data, std::size_t size) = nullptr;

}  // namespace

// The names are libFuzzer's. It passes over options that begin with two dashes.
// NOLINTBEGIN(readability-identifier-naming)
extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  constexpr std::string_view option = "--fuzzer=";
  for (int i = 1; i < *argc; ++i) {
    const std::string_view argument = (*argv)[i];
    if (!argument.starts_with(option)) continue;
    const auto* found = std::ranges::find(glocal::fuzz::fuzzers, argument.substr(option.size()),
                                          [](const auto& fuzzer) { return std::string_view(fuzzer.name); });
    if (found != glocal::fuzz::fuzzers.end()) chosen = found->run;
  }
  if (chosen != nullptr) return 0;
  std::fputs("fuzz: --fuzzer=NAME is missing, or there is none of that name; there are:", stderr);
  for (const auto& fuzzer : glocal::fuzz::fuzzers) std::fprintf(stderr, " %s", fuzzer.name);
  std::fputs("\n", stderr);
  std::exit(2);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  return chosen(data, size);
}
// NOLINTEND(readability-identifier-naming)
