// Searches for one cloud in another by features of their points, as cloud registrars.
#pragma once

#include <fmt/format.h>

#include "glocal/cloud_registrar.hpp"
#include "glocal/cloud_resolution.hpp"

namespace glocal {

/// Registers clouds by a search (feature_matcher.hpp says what that is), with its published settings.
template <class Search>
class FeatureRegistrar final : public CloudRegistrar {
 public:
  using Params = Search;

  FeatureRegistrar(const Params& search, const RegistrationOptions& options)
      : search_(search), options_(options) {}

  [[nodiscard]] Registration find(const Points& source, const Points& target) override {
    Registration result;
    result.voxel_size = options_.voxel_size.value_or(double{cloud_resolution(source, target)});
    const Cloud from{source, result.voxel_size, as_vector(options_.source_seen_from)};
    const Cloud to{target, result.voxel_size, as_vector(options_.target_seen_from)};
    const auto found = search_.find(from, to, result.voxel_size, options_.seed);
    if (!found) {
      result.why = fmt::format("no pose: {} and {} voxels have points", from.size(), to.size());
      return result;
    }
    result.is_match = true;
    result.why = "not judged: the method trusts every pose it gives";
    result.target_from_source = found->target_from_source;
    result.overlap = result.score = found->overlap;
    result.rmse = found->rmse;
    return result;
  }

 private:
  using Cloud = typename Search::Cloud;

  Search search_;
  RegistrationOptions options_;
};

}  // namespace glocal
