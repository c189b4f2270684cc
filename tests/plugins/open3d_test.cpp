// plugins/open3d, as users have it.
#include "plugins/feature_search_tests.hpp"

namespace glocal::test::feature_search_tests {

INSTANTIATE_TEST_SUITE_P(Open3d, FeatureSearch,
                         testing::Values(Search{"open3d_ransac", "open3d_ransac", GLOCAL_OPEN3D_PLUGIN},
                                         Search{"open3d_fgr", "open3d_fgr", GLOCAL_OPEN3D_PLUGIN}),
                         [](const auto& search) { return search.param.registrar; });

}  // namespace glocal::test::feature_search_tests
