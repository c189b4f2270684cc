#pragma once

#include "glocal/catalog.hpp"

namespace glocal {

void register_clustering(Catalog& catalog);

}  // namespace glocal
