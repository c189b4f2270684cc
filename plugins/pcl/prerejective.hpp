// Random samples of points with like features.
#pragma once

#include <memory>
#include <optional>

#include "clouds.hpp"
#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "icp.hpp"
#include "prerejection.hpp"

namespace glocal::pcl_plugin {

/// pcl::SampleConsensusPrerejective with FPFH features (Rusu, Blodow and Beetz 2009; Buch et al. 2013) of
/// normals in the plane: triples of points with like features, rejected early where their sides differ.
/// Several runs give several hypotheses, each refined by ICP.
class PclPrerejective final : public Matcher {
 public:
  struct Params {
    int runs = 5;
    int iterations = 20000;
    double normal_radius = 0.3;
    double feature_radius = 1.5;
    int candidates = 10;
    double similarity = 0.9;
    double inlier_distance = 0.20;
    double inlier_fraction = 0.3;
    IcpParams refinement{.points = 500, .iterations = 20, .max_distance = 0.5};
    std::optional<double> contact_epsilon = {};
  };

  PclPrerejective(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override {}

 private:
  Params params_;
  Cloud::Ptr map_;
  std::shared_ptr<Features> map_features_;
  std::shared_ptr<const ContactIndex> contact_;
  IcpAligner aligner_;
};
void describe(ParamVisitor& v, PclPrerejective::Params& p);

}  // namespace glocal::pcl_plugin
