#include "glocal/plugin.hpp"

#include <pcl/console/print.h>

#include "icp.hpp"
#include "kd_tree_contact.hpp"
#include "plugins/common/feature_matcher.hpp"
#include "plugins/common/feature_registrar.hpp"
#include "prerejective.hpp"
#include "space_search.hpp"

GLOCAL_PLUGIN("glocal_pcl", "0.1.0", catalog) {
  using namespace glocal;
  // What goes wrong in PCL shows in the hypotheses; a step has nothing to say on the terminal.
  pcl::console::setVerbosityLevel(pcl::console::L_ALWAYS);
  catalog.contact_indexes.add<pcl_plugin::PclKdTreeContact>(
      "pcl_kd_tree", "PCL's kd-tree: exact, and many times slower.", experimental_since("0.1.0"));
  catalog.matchers.add<pcl_plugin::PclIcp>(
      "pcl_icp", "PCL's ICP from starts all over the map, coarse to fine.", experimental_since("0.1.0"));
  const char* const prerejective =
      "PCL's SampleConsensusPrerejective: triples of points with like FPFH features.";
  catalog.matchers.add<pcl_plugin::PclPrerejective>("pcl_prerejective", prerejective,
                                                    experimental_since("0.1.0"));
  catalog.matchers.add<FeatureMatcher<pcl_plugin::PrerejectiveSearch>>("pcl_cloud_prerejective", prerejective,
                                                                       experimental_since("0.1.0"));
  catalog.matchers.note_counterparts("pcl_prerejective", "pcl_cloud_prerejective");
  catalog.cloud_registrars.add<FeatureRegistrar<pcl_plugin::PrerejectiveSearch>>(
      "pcl_prerejective", prerejective, experimental_since("0.1.0"));
}
