#pragma once

#include "glocal/catalog.hpp"

namespace glocal {

void register_local_mappers(Catalog& catalog);

}  // namespace glocal
