#include "local_mappers/register.hpp"

namespace glocal {

void register_local_mappers(Catalog& /*catalog*/) {}

}  // namespace glocal
