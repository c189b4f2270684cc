// What the searches in the plane and in space have in common.
#pragma once

#include <pcl/point_types.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <mutex>

#include "clouds.hpp"
#include "glocal/params.hpp"

namespace glocal::pcl_plugin {

using Features = pcl::PointCloud<pcl::FPFHSignature33>;
using Prerejection = pcl::SampleConsensusPrerejective<pcl::PointXYZ, pcl::PointXYZ, pcl::FPFHSignature33>;

/// Seeds std::rand(), from which PCL draws: until this is gone, whoever else wants to draw waits.
class OwnRandomNumbers {
 public:
  explicit OwnRandomNumbers(std::uint64_t seed) : lock_(mutex()) { std::srand(static_cast<unsigned>(seed)); }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }

  std::lock_guard<std::mutex> lock_;
};

/// Fewer points cannot be matched.
inline constexpr int points_drawn = 3;

/// A search that has its clouds, with the parameters of one of the two; the inlier distance is in m.
template <class Params>
void set_up(Prerejection& align, const Params& params, double inlier_distance) {
  align.setMaximumIterations(params.iterations);
  align.setNumberOfSamples(points_drawn);
  // PCL draws from as many as it is told, whether there are so many points or not.
  align.setCorrespondenceRandomness(
      std::min(params.candidates, static_cast<int>(align.getInputTarget()->size())));
  align.setSimilarityThreshold(static_cast<float>(params.similarity));
  align.setMaxCorrespondenceDistance(inlier_distance);
  align.setInlierFraction(static_cast<float>(params.inlier_fraction));
}

/// The parameters that both have.
template <class Params>
void describe_prerejection(ParamVisitor& v, Params& p) {
  v.field("iterations", p.iterations,
          {.doc = "Triples drawn in each search.", .min = 1, .audience = Audience::tuner});
  v.field(
      "candidates", p.candidates,
      {.doc = "Number of points with the nearest features from which a point's partner is drawn.", .min = 1});
  v.field("similarity", p.similarity,
          {.doc = "Triples whose sides are less alike (shorter by longer one) are rejected.",
           .min = 0.0,
           .max = 0.999});
  v.field("inlier_fraction", p.inlier_fraction,
          {.doc = "Share of inliers a pose needs.", .min = 0.0, .max = 1.0});
}

}  // namespace glocal::pcl_plugin
