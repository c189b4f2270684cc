// Open3D's global registration as matchers.
#pragma once

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

#include "feature_cloud.hpp"
#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/error.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal {

/// The parameters of a matcher by one of the searches.
template <class Search>
struct Open3dMatcherParams {
  std::optional<double> voxel_size = {};
  int runs = 1;
  Search search = {};
  std::optional<double> contact_epsilon = {};
};

template <class Search>
void describe(ParamVisitor& v, Open3dMatcherParams<Search>& p) {
  v.field("voxel_size", p.voxel_size,
          {.doc = "Side of the voxels of map and local map that give one point each; auto takes three times "
                  "the map's resolution, and at least 0.1 m.",
           .unit = "m",
           .min = 0.01,
           .audience = Audience::tuner});
  v.field("runs", p.runs,
          {.doc = "Independent searches in a step; each gives one pose at most.", .min = 1, .max = 1000});
  v.field("search", p.search, {.doc = "The search."});
  describe_contact_epsilon(v, p.contact_epsilon);
}

/// The map's features, and how long they took.
struct FeatureMap {
  FeatureCloud cloud;
  double build_ms = 0.0;
};

/// The features of a map, made once for all who share it. Throws ConfigError if it has too few points.
[[nodiscard]] std::shared_ptr<const FeatureMap> feature_map(const GlobalMap& map, double voxel_size);

/// Looks for the local map in the whole map by one of the searches; any rotation, and no guess.
template <class Search>
class Open3dMatcher final : public Matcher {
 public:
  using Params = Open3dMatcherParams<Search>;
  static constexpr Motions motions{.planar = false, .free = true};

  Open3dMatcher(const Params& params, const StageSetup& setup)
      : params_(params),
        voxel_size_(params.voxel_size.value_or(fitting_voxel_size(setup.map->resolution()))),
        map_(feature_map(*setup.map, voxel_size_)),
        contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))) {}

  [[nodiscard]] MatchResult match(const LocalMap& local, const Observation& /*latest*/, double omega_max,
                                  Rng& rng) override {
    MatchResult result;
    if (local.points.empty()) return result;
    const FeatureCloud source(local.points, voxel_size_, local.local_from_robot.translation());
    for (int run = 0; run < params_.runs; ++run) {
      const auto found = params_.search.find(source, map_->cloud, voxel_size_, rng.next());
      if (!found) continue;
      const Pose3& map_from_local = found->target_from_source;
      // Contact indexes move points in the plane only.
      const double omega = contact_->share(moved(local.points, map_from_local), Transform(Pose2{}));
      result.points_tested += local.points.size();
      ++result.proposals;
      if (omega >= omega_max) result.hypotheses.push_back(Hypothesis::by_contact(map_from_local, omega));
    }
    std::stable_sort(result.hypotheses.begin(), result.hypotheses.end(),
                     [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; });
    return result;
  }
  void reset() override {}
  [[nodiscard]] std::optional<MapIndexInfo> map_index() const override {
    const auto numbers = static_cast<std::size_t>(map_->cloud.features.data_.size());
    return MapIndexInfo{map_->cloud.size(), numbers * sizeof(double), map_->build_ms};
  }

 private:
  /// The side of voxels (m) that suits a map whose points are so far apart (m; 0 if not known).
  static double fitting_voxel_size(double resolution) {
    constexpr double points_apart = 3.0;
    constexpr double finest = 0.1;
    return std::max(points_apart * resolution, finest);
  }

  Params params_;
  double voxel_size_;  ///< m
  std::shared_ptr<const FeatureMap> map_;
  std::shared_ptr<const ContactIndex> contact_;
};

}  // namespace glocal
