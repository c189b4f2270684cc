#pragma once

#include "glocal/catalog.hpp"

namespace glocal {

void register_verifiers(Catalog& catalog);

}  // namespace glocal
