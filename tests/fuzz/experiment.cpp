// Experiment files, with files at hand that they may name.
#include "glocal/experiment.hpp"

#include "fuzz/harness.hpp"

namespace glocal::fuzz {
namespace {

void write_inputs() {
  for (const char* name : {"world.yaml", "map.yaml", "drive.log"}) write(name, "");
}

/// The effective experiment is one, and the same.
void check_effective(Experiment& experiment) {
  const std::string effective = effective_yaml(experiment, catalog());
  std::string again;
  try {
    Experiment read = read_experiment(write("effective.yaml", effective), {}, catalog());
    again = effective_yaml(read, catalog());
  } catch (const ConfigError&) {
  }
  must_hold(effective == again, "the effective experiment is read as another one");
}

}  // namespace
}  // namespace glocal::fuzz

extern "C" int fuzz_experiment(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  static const bool are_written = (fuzz::write_inputs(), true);
  static_cast<void>(are_written);
  const auto file = fuzz::write("experiment.yaml", fuzz::text_of(data, size));
  return fuzz::answer([&] {
    static_cast<void>(read_plugins(file, {}));
    Experiment experiment = read_experiment(file, {}, fuzz::catalog());
    fuzz::check_effective(experiment);
  });
}
