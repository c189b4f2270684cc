// The variants of an experiment.
#include "fuzz/harness.hpp"
#include "glocal/experiment.hpp"

namespace {

const std::string base =
    "schema: 1\nname: base\nmap: {simulation: {world: world.yaml}}\n"
    "observations: {simulation: {world: world.yaml}}\ntrials: {every_m: 6}\nvariants:\n";

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  static const auto world = fuzz::write("world.yaml", "");
  const auto file = fuzz::write("variants.yaml", base + fuzz::text_of(data, size));
  return fuzz::answer([&] { static_cast<void>(read_variants(file, {}, fuzz::catalog())); });
}
