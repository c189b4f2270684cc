// The variants of an experiment, and behind a line of dashes the suite that it is of.
#include "config/suites.hpp"
#include "fuzz/harness.hpp"
#include "glocal/experiment.hpp"

namespace {

const std::string base =
    "schema: 1\nname: base\nmap: {simulation: {world: world.yaml}}\n"
    "observations: {simulation: {world: world.yaml}}\ntrials: {every_m: 6}\nvariants:\n";

const std::string of_suite = "schema: 1\nmethods: paper\nsuite: suite.yaml\n";

}  // namespace

extern "C" int fuzz_variants(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  static const auto world = fuzz::write("world.yaml", "");
  const auto parts = fuzz::parts(fuzz::text_of(data, size), 2);
  const bool has_suite = !parts[1].empty();
  fuzz::write("suite.yaml", parts[1]);
  const auto file = fuzz::write("variants.yaml", (has_suite ? of_suite : base) + parts[0]);
  return fuzz::answer([&] {
    for (const Variant& variant : read_variants(file, {}, fuzz::catalog()))
      fuzz::must_hold(!variant.suite || variant.suite->find_case(variant.case_name) != nullptr,
                      "a case of no suite");
  });
}
