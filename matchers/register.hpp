#pragma once

#include "glocal/catalog.hpp"

namespace glocal {

void register_matchers(Catalog& catalog);

}  // namespace glocal
