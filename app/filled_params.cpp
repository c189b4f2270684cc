#include "app/filled_params.hpp"

#include <utility>

#include "config/overrides.hpp"
#include "config/reader.hpp"
#include "glocal/error.hpp"

namespace glocal::app {

void fill(AnyParams& params, YamlNode tree, const std::vector<Override>& values) {
  std::vector<Fault> faults;
  apply_overrides(tree, values, params, faults);
  read_params(tree, params, faults);
  if (!faults.empty()) throw ConfigError(std::move(faults));
}

}  // namespace glocal::app
