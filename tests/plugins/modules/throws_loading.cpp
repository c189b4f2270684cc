#include <stdexcept>

#include "glocal/plugin.hpp"

namespace {
struct Impatient {
  Impatient() { throw std::runtime_error("no device"); }
};
const Impatient impatient;
}  // namespace

GLOCAL_PLUGIN("impatient", "1", catalog) {
  static_cast<void>(catalog);
}
