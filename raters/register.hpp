#pragma once

#include "glocal/catalog.hpp"

namespace glocal {

void register_raters(Catalog& catalog);

}  // namespace glocal
