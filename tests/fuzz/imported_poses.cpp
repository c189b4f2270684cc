// Poses that another program has found on a suite.
#include "config/suites.hpp"
#include "evaluation/leaderboard/imported.hpp"
#include "fuzz/harness.hpp"

extern "C" int fuzz_imported_poses(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  Suite suite;
  suite.name = "toy";
  suite.seeds = {1, 2};
  suite.cases = {{"room", "", 3}, {"hall", "", 1}};
  const auto file = fuzz::write("poses.csv", fuzz::text_of(data, size));
  return fuzz::answer([&] {
    for (const auto& [start, poses] : read_imported(file, suite).starts)
      fuzz::must_hold(suite.find_case(std::get<0>(start)) != nullptr && !poses.empty(), "a case of no suite");
  });
}
