#pragma once

#include "glocal/catalog.hpp"

namespace glocal {

void register_sources(Catalog& catalog);

}  // namespace glocal
