#include "verifiers/register.hpp"

#include "verifiers/whole_map.hpp"

namespace glocal {

void register_verifiers(Catalog& catalog) {
  catalog.verifiers.add_none("none", "Every pose that the verdict rule declares is declared.",
                             stable_since("0.1.0"));
  catalog.verifiers.add<verifiers::WholeMap>(
      "whole_map", "Branch and bound over all poses: a declared pose has no rival, or is not declared.",
      stable_since("0.1.0"));
}

}  // namespace glocal
