#include <stdexcept>

#include "glocal/plugin.hpp"

GLOCAL_PLUGIN("shy", "1", catalog) {
  throw std::runtime_error("no licence for " + std::to_string(catalog.registries().size()) + " registries");
}
