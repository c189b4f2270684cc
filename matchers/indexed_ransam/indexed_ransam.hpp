#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/common/beam_evidence.hpp"
#include "matchers/common/candidates.hpp"
#include "matchers/indexed_ransam/exact_search.hpp"
#include "matchers/indexed_ransam/pose_judge.hpp"
#include "matchers/indexed_ransam/relation_index.hpp"
#include "matchers/indexed_ransam/step_candidates.hpp"

namespace glocal::indexed_ransam {

/// Random sample matching against an index: the map's oriented point pairs (two points with their normals)
/// are sorted once, or its triangles where few points have a normal, so every draw from the local map meets
/// partners. The best distinct poses are refined before they are judged, carried to the next step beside
/// fresh ones, and judged by contact, by beams through walls, and by what the map does not show.
///
/// Hypotheses are the best distinct poses (candidates); their score is contact (Omega, eq. 4) less
/// `blocked_weight` times the share of blocked beams, plus `unknown_weight` times the share of points in
/// unknown cells, less `free_space_weight` times that of points in free cells out of contact, less
/// `fit_weight` times the mean distance to the map as a share of contact_epsilon.
class IndexedRansam final : public Matcher {
 public:
  struct Params {
    int iterations = 1200;
    int first_iterations = 4800;
    std::optional<double> contact_epsilon = {};
    double min_contact = 0.2;
    int candidates = 40;
    int best = 10;
    int carried = 10;
    PoseRefinement refinement = {};
    BeamRule beams = {.weight = 1.0, .cap = 0.3};
    double unknown_weight = 0.1;
    double min_length = 0.5;
    std::string relation = "auto";
    ExactSearchRule exact_search = {};
  };

  /// Throws ConfigError where the map is too large for a contact grid, a distance field or a pyramid.
  IndexedRansam(const Params& params, const StageSetup& setup);

  /// Proposals of a step on an index of so many points, where `iterations` are enough for 80,000: the chance
  /// that one is right falls with the number of places. At most 24,000, but for `iterations`.
  [[nodiscard]] static std::size_t proposals_on(std::size_t points, int iterations);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  [[nodiscard]] MatchResult go_on(const LocalMap& local, std::size_t looks) override;
  [[nodiscard]] std::vector<Hypothesis> rescore(std::vector<Hypothesis> found,
                                                const LocalMap& local) override;
  void reset() override;
  [[nodiscard]] std::optional<MapIndexInfo> map_index() const override { return map_index_; }

 private:
  /// Says in `map_index_` what it took.
  [[nodiscard]] std::shared_ptr<const RelationIndex> built_index(int threads);
  [[nodiscard]] std::size_t proposals_of_step();
  /// The last step, until its exact search is over, or the next one.
  struct OpenStep {
    OpenStep(Points some_points, const MatchRequest& request, const ContactIndex& contact,
             const Params& params);
    OpenStep(const OpenStep&) = delete;  // Candidates refer to what is here.
    OpenStep& operator=(const OpenStep&) = delete;

    Points sample;
    PoseGate gate;
    double omega_max;
    StepCandidates candidates;
    std::vector<Hypothesis> best = {};
    std::size_t proposals = 0, points_tested = 0;  ///< Apart from those of the candidates.
  };
  void settle(OpenStep& step, const LocalMap& local) const;

  Params params_;
  std::shared_ptr<const GlobalMap> map_;
  RelationRule relation_;
  MapIndexInfo map_index_;
  /// Made before the other indexes: while it is made it takes much more memory than in the end.
  std::shared_ptr<const RelationIndex> index_;
  std::size_t proposals_ = 0;  ///< In a step.
  std::shared_ptr<const ContactIndex> contact_;
  CandidateRefiner refiner_;
  PoseJudge judge_;
  ExactSearch exact_search_;
  std::size_t looks_per_step_;
  std::unique_ptr<OpenStep> open_ = {};
  std::vector<Pose2> carried_;  ///< map_from_local of the last step's best.
  int epoch_ = 0;               ///< Of the local map in whose frame they are.
  int steps_ = 0;               ///< In that frame.
};
void describe(ParamVisitor& v, IndexedRansam::Params& p);

}  // namespace glocal::indexed_ransam
