// The strategies glocal comes with, for programs that embed it: link glocal::builtin.
#pragma once

#include "glocal/catalog.hpp"

namespace glocal {

/// Adds all of them, as the program `glocal` has them.
void register_builtin_strategies(Catalog& catalog);

}  // namespace glocal
