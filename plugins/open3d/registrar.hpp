// Open3D's global registration of two clouds.
#pragma once

#include <fmt/format.h>

#include "feature_cloud.hpp"
#include "glocal/cloud_registrar.hpp"
#include "glocal/cloud_resolution.hpp"
#include "glocal/params.hpp"

namespace glocal {

/// Registers clouds by one of the searches, with its published settings.
template <class Search>
class Open3dRegistrar final : public CloudRegistrar {
 public:
  using Params = Search;

  Open3dRegistrar(const Params& search, const RegistrationOptions& options)
      : search_(search), options_(options) {}

  [[nodiscard]] Registration find(const Points& source, const Points& target) override {
    Registration result;
    result.voxel_size = options_.voxel_size.value_or(double{cloud_resolution(source, target)});
    const FeatureCloud from = features(source, options_.source_seen_from, result.voxel_size);
    const FeatureCloud to = features(target, options_.target_seen_from, result.voxel_size);
    const auto found = search_.find(from, to, result.voxel_size, options_.seed);
    if (!found) {
      result.why = fmt::format("no pose: {} and {} voxels have points", from.size(), to.size());
      return result;
    }
    result.is_match = true;
    result.why = "not judged: the method gives a pose for any clouds";
    result.target_from_source = found->target_from_source;
    result.overlap = result.score = found->overlap;
    result.rmse = found->rmse;
    return result;
  }

 private:
  static FeatureCloud features(const Points& cloud, const Point& seen_from, double voxel_size) {
    return {cloud, voxel_size, {seen_from.x, seen_from.y, seen_from.z}};
  }

  Search search_;
  RegistrationOptions options_;
};

}  // namespace glocal
