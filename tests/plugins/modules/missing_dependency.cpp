// Needs a library that is not there when it is loaded.
#include "glocal/plugin.hpp"

int gone();

GLOCAL_PLUGIN("lonely", "1", catalog) {
  if (gone() == 0) catalog.matchers.set_origin("nowhere");
}
