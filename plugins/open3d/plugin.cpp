#include "glocal/plugin.hpp"

#include <open3d/utility/Logging.h>

#include "plugins/common/feature_matcher.hpp"
#include "plugins/common/feature_registrar.hpp"
#include "searches.hpp"

GLOCAL_PLUGIN("glocal_open3d", "0.1.0", catalog) {
  using namespace glocal;
  // A step has nothing to say on the terminal.
  open3d::utility::SetVerbosityLevel(open3d::utility::VerbosityLevel::Error);
  const char* const ransac = "Open3D's RANSAC of points with like FPFH features.";
  const char* const fast_global = "Open3D's Fast Global Registration of points with like FPFH features.";
  catalog.matchers.add<FeatureMatcher<open3d_plugin::RansacSearch>>("open3d_ransac", ransac,
                                                                    experimental_since("0.1.0"));
  catalog.matchers.add<FeatureMatcher<open3d_plugin::FastGlobalSearch>>("open3d_fgr", fast_global,
                                                                        experimental_since("0.1.0"));
  catalog.cloud_registrars.add<FeatureRegistrar<open3d_plugin::RansacSearch>>("open3d_ransac", ransac,
                                                                              experimental_since("0.1.0"));
  catalog.cloud_registrars.add<FeatureRegistrar<open3d_plugin::FastGlobalSearch>>(
      "open3d_fgr", fast_global, experimental_since("0.1.0"));
}
