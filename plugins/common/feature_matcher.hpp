// Searches for one cloud in another by features of their points, as matchers.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/cloud_resolution.hpp"
#include "glocal/contact.hpp"
#include "glocal/error.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "plugins/common/matched_pose.hpp"

namespace glocal {

/// The parameters of a matcher by a search.
template <class Search>
struct FeatureMatcherParams {
  std::optional<double> voxel_size = {};
  int runs = 1;
  Search search = {};
  std::optional<double> contact_epsilon = {};
};

template <class Search>
void describe(ParamVisitor& v, FeatureMatcherParams<Search>& p) {
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

/// Looks for the local map in the whole map, without any guess. Where the motion is upright, poses that tilt
/// are dropped.
///
/// A Search is described, has a class `Cloud`, made from (const Points&, double voxel_size,
/// const Vector3& normals_towards), with size() and memory_bytes(), and
/// std::optional<MatchedPose> find(const Cloud& source, const Cloud& target, double voxel_size, std::uint64_t
/// seed) const, which gives the same answer for the same seed.
template <class Search>
class FeatureMatcher final : public Matcher {
 public:
  using Params = FeatureMatcherParams<Search>;
  static constexpr Motions motions = motions_in_space;

  /// Throws ConfigError if the map has too few points.
  FeatureMatcher(const Params& params, const StageSetup& setup)
      : params_(params),
        upright_(setup.motion == Motion::upright),
        voxel_size_(params.voxel_size.value_or(map_voxel_size(setup.map->resolution()))),
        map_(features_of(*setup.map, voxel_size_)),
        contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))) {}

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override {
    const LocalMap& local = request.local;
    MatchResult result;
    if (local.points.empty()) return result;
    const Cloud source(local.points, voxel_size_, local.local_from_robot.translation());
    for (int run = 0; run < params_.runs; ++run) {
      const auto found = params_.search.find(source, map_->cloud, voxel_size_, rng.next());
      if (!found) continue;
      ++result.proposals;
      const Pose3& map_from_local = found->target_from_source;
      if (upright_ && map_from_local.tilt() > most_tilt) continue;
      const double omega = contact_->share(local.points, map_from_local);
      result.points_tested += local.points.size();
      if (omega >= request.omega_max)
        result.hypotheses.push_back(Hypothesis::by_contact(map_from_local, omega));
    }
    std::ranges::stable_sort(result.hypotheses, std::greater<>(), &Hypothesis::score);
    return result;
  }
  void reset() override {}
  [[nodiscard]] std::optional<MapIndexInfo> map_index() const override {
    return MapIndexInfo{map_->cloud.size(), map_->cloud.memory_bytes(), map_->build_ms};
  }

 private:
  using Cloud = typename Search::Cloud;

  /// The map's features, and how long they took.
  struct MapFeatures {
    Cloud cloud;
    double build_ms = 0.0;
  };

  static constexpr double most_tilt = radians(15.0);

  /// Made once for all who share the map.
  static std::shared_ptr<const MapFeatures> features_of(const GlobalMap& map, double voxel_size) {
    const auto result = map.index<MapFeatures>(fmt::format("{}", voxel_size), [&] {
      const auto start = std::chrono::steady_clock::now();
      // Features need a side for each normal. Where a map was seen from is not known: its middle is taken.
      MapFeatures made{Cloud(map.points(), voxel_size, centroid(map.points()))};
      const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
      made.build_ms = time.count();
      return made;
    });
    if (result->cloud.size() >= fewest_points) return result;
    throw ConfigError("",
                      fmt::format("the map has {} voxels of {:.2f} m with points; features need {} or more: "
                                  "take a smaller voxel_size",
                                  result->cloud.size(), voxel_size, fewest_points));
  }

  Params params_;
  bool upright_;
  double voxel_size_;  ///< m
  std::shared_ptr<const MapFeatures> map_;
  std::shared_ptr<const ContactIndex> contact_;
};

}  // namespace glocal
