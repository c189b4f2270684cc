#include "matchers/register.hpp"

#include "matchers/ransam.hpp"

namespace glocal {

void register_matchers(Catalog& catalog) {
  catalog.matchers.add<Ransam>("ransam",
                               "Random sample matching of triangles over a hash table (Section II, eq. 1-5).",
                               {.contact = ContactChoice(catalog.contact_indexes)});
}

}  // namespace glocal
