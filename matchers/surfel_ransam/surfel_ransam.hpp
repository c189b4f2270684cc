#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/surfel_ransam/surfel_index.hpp"
#include "matchers/surfels/pose_search.hpp"

namespace glocal::surfel_ransam {

/// Indexed random sample matching in space: pairs of surfels of the local map meet pairs of the map that are
/// alike. The best distinct poses are refined point to plane, carried to the next step beside fresh ones, and
/// judged by contact with normals, by what the latest scan looked through and by points where the map is
/// free.
///
/// Hypotheses are the best distinct poses; their score is the contact (mean of the share of surfels and of
/// the share of points) less the share of the map's surfels that the latest scan
/// looked through, and less `free_space_weight` times the share of points where the map is free.
class SurfelRansam final : public Matcher {
 public:
  static constexpr Motions motions = motions_in_space;

  struct Params {
    std::optional<double> contact_epsilon = {};
    std::optional<double> voxel_size = {};
    int best = 10;
    int carried = 10;
    int pairs = 300000;
    int rounds = 4;
    double free_space_weight = 1.0;
  };

  /// Throws ConfigError where the map is too large, or has hardly any surfaces.
  SurfelRansam(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  [[nodiscard]] MatchResult go_on(const LocalMap& local, std::size_t looks) override;
  [[nodiscard]] std::vector<Hypothesis> rescore(std::vector<Hypothesis> found,
                                                const LocalMap& local) override;
  void reset() override;
  [[nodiscard]] std::optional<MapIndexInfo> map_index() const override;

 private:
  /// Rounds of a step at most.
  [[nodiscard]] std::size_t rounds_of_step() const;
  /// For poses of the prepared local map, beside those that are known.
  [[nodiscard]] surfels::PoseSearch search_of(const LocalMap& local, const PoseGate& gate, std::size_t rounds,
                                              std::span<const RigidMotion> known, const Rng& rng) const;
  [[nodiscard]] Hypothesis to_hypothesis(const surfels::FoundPose& pose, const LocalMap& local) const;
  /// Share of points where the map is known to be free, away from its points.
  [[nodiscard]] double free_space_violation(const Points& points, const Pose3& map_from_points) const;

  Params params_;
  bool upright_;
  std::shared_ptr<const GlobalMap> map_;
  SurfelIndexRule rule_;
  std::shared_ptr<const ContactIndex> contact_;
  std::shared_ptr<const SurfelIndex> index_;
  std::size_t looks_per_step_;
  std::optional<surfels::PreparedCloud> prepared_;  ///< The local map of the last match().
  /// That of the last match().
  struct OpenStep {
    surfels::PoseSearch search;
    double omega_max;
  };
  std::optional<OpenStep> open_;
  std::vector<RigidMotion> carried_;  ///< map_from_local of the last step's best.
  int epoch_ = 0;                     ///< Of the local map in whose frame they are.
};
void describe(ParamVisitor& v, SurfelRansam::Params& p);

}  // namespace glocal::surfel_ransam
