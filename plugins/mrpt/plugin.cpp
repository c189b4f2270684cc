#include "glocal/plugin.hpp"

#include "mrpt_mcl.hpp"

GLOCAL_PLUGIN("glocal_mrpt", "0.1.0", catalog) {
  using namespace glocal;
  catalog.matchers.add<mrpt_plugin::MrptMcl>(
      "mrpt_mcl", "MRPT's Monte Carlo localization, from particles all over the map.",
      experimental_since("0.1.0"));
}
