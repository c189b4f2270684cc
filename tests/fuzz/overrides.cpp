// What is given with --set: a line for each, path=value.
#include "config/overrides.hpp"

#include <sstream>

#include "config/experiment_params.hpp"
#include "config/reader.hpp"
#include "config/yaml_parser.hpp"
#include "fuzz/harness.hpp"

namespace glocal::fuzz {
namespace {

YamlNode base() {
  std::vector<Fault> none;
  return *parse_yaml(
      "schema: 1\nname: base\nmap: {log_map: {path: drive.log}}\nobservations: {carmen_log: {path: "
      "drive.log}}\n"
      "trials: {every_m: 6}\nlocalizer: {matcher: {ransam: {iterations: 7}}, rater: cluster_rating}\n",
      origin_of("base.yaml"), none);
}

std::vector<Override> overrides_of(const std::string& input) {
  std::vector<Override> all;
  std::istringstream lines(input);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t equals = line.find('=');
    if (equals != std::string::npos && equals > 0)
      all.emplace_back(line.substr(0, equals), line.substr(equals + 1));
  }
  return all;
}

}  // namespace
}  // namespace glocal::fuzz

extern "C" int fuzz_overrides(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  static const YamlNode base = fuzz::base();
  return fuzz::answer([&] {
    ExperimentFileParams params(fuzz::catalog());
    fill(params, base, fuzz::overrides_of(fuzz::text_of(data, size)));
  });
}
