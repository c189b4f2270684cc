#include "glocal/plugin.hpp"

#include <open3d/utility/Logging.h>

#include "matcher.hpp"
#include "registrar.hpp"

GLOCAL_PLUGIN("glocal_open3d", "0.1.0", catalog) {
  using namespace glocal;
  // A step has nothing to say on the terminal.
  open3d::utility::SetVerbosityLevel(open3d::utility::VerbosityLevel::Error);
  const char* const ransac = "Open3D's RANSAC of points with like FPFH features.";
  const char* const fast_global = "Open3D's Fast Global Registration of points with like FPFH features.";
  catalog.matchers.add<Open3dMatcher<RansacSearch>>("open3d_ransac", ransac);
  catalog.matchers.add<Open3dMatcher<FastGlobalSearch>>("open3d_fgr", fast_global);
  catalog.cloud_registrars.add<Open3dRegistrar<RansacSearch>>("open3d_ransac", ransac);
  catalog.cloud_registrars.add<Open3dRegistrar<FastGlobalSearch>>("open3d_fgr", fast_global);
}
