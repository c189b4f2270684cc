#include "sources/register.hpp"

namespace glocal {

void register_sources(Catalog& /*catalog*/) {}

}  // namespace glocal
