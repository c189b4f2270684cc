#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/common/beam_evidence.hpp"
#include "matchers/common/candidates.hpp"
#include "matchers/grid_search/contact_pyramid.hpp"
#include "matchers/indexed_ransam/oriented_pair_index.hpp"
#include "matchers/indexed_ransam/triangle_index.hpp"

namespace glocal {

using RelationIndex = std::variant<OrientedPairIndex, TriangleIndex>;

/// When a step's draws end: once the best distinct poses have stayed the same over some chunks of draws, be
/// it because all worth finding are found or because what was carried on is still best.
struct AdaptiveBudget {
  int limit = 0;  ///< Draws at most; 0: a fixed number instead.
  int chunk = 100;
  int stable_candidates = 5;
  int stable_chunks = 3;
};

/// Random sample matching against an index: the map's oriented point pairs (two points with their normals)
/// are sorted once, or its triangles where few points have a normal, so every draw from the local map meets
/// partners. The best distinct poses are refined before they are judged, carried to the next step beside
/// fresh ones, and judged by contact, by beams through walls, and by what the map does not show.
///
/// Hypotheses are the best distinct poses (candidates); their score is contact (Omega, eq. 4) less
/// `blocked_weight` times the share of blocked beams, plus `unknown_weight` times the share of points in
/// unknown cells.
class IndexedRansam final : public Matcher {
 public:
  /// When an exact search (search_grid) adds its poses to the candidates.
  struct ExactSearch {
    int after_steps = 0;
    double margin = 0.1;
    double cell = 0.05;
    double min_rotation_step = 0.005;
    int max_poses = 50;
  };
  struct Params {
    int iterations = 600;
    int first_iterations = 1500;
    int first_steps = 4;
    AdaptiveBudget adaptive = {};
    double contact_epsilon = 0.10;
    double min_contact = 0.2;
    int contact_points = 128;
    int candidates = 40;
    int best = 10;
    int carried = 10;
    CandidateRule candidate = {};
    PoseRefinement refinement = {};
    PoseUncertainty uncertainty = {};
    double field_cell = 0.05;
    BeamRule beams = {.weight = 1.0, .cap = 0.3};
    double unknown_weight = 0.1;
    double min_length = 0.5;
    double max_length = 6.0;
    double length_cell = 0.1;
    int angle_cells = 24;
    std::string relation = "auto";
    double min_oriented_share = 0.3;
    double min_height = 0.3;
    int max_entries = 1000000;
    double voxel_size = 0.1;
    double normal_radius = 0.2;
    FilePath index_file = {};
    ExactSearch exact_search = {};
  };

  /// Throws ConfigError where the map is too large for a contact grid, a distance field or a pyramid, or
  /// index_file is not the index of this map and these parameters.
  IndexedRansam(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const LocalMap& local, const Observation& latest, double omega_max,
                                  Rng& rng) override;
  void reset() override;
  [[nodiscard]] std::optional<MapIndexInfo> map_index() const override { return map_index_; }

  /// The content of an index_file for these parameters and this map.
  [[nodiscard]] std::string saved_index() const;

 private:
  using LocalPoints = std::variant<OrientedPoints, Points>;
  [[nodiscard]] LocalPoints points_to_draw(const LocalMap& local) const;
  void draw(const LocalPoints& points, const Points& sample, std::size_t draws, Rng& rng,
            std::vector<Candidate>& candidates, MatchResult& result) const;
  void draw_until_stable(const LocalPoints& points, const Points& sample, const Pose2& local_from_robot,
                         Rng& rng, std::vector<Candidate>& candidates, MatchResult& result) const;
  void draw_pairs(const OrientedPairIndex& index, const OrientedPoints& oriented_points, const Points& sample,
                  std::size_t draws, Rng& rng, std::vector<Candidate>& candidates, MatchResult& result) const;
  void draw_triangles(const TriangleIndex& index, const Points& points, const Points& sample,
                      std::size_t draws, Rng& rng, std::vector<Candidate>& candidates,
                      MatchResult& result) const;
  void test(const MotionBatch& motions, std::size_t size, const Points& sample,
            std::vector<Candidate>& candidates, MatchResult& result) const;
  void search_exactly(const Points& sample, const Pose2& local_from_robot, std::vector<Candidate>& candidates,
                      MatchResult& result) const;
  [[nodiscard]] std::vector<Candidate> settled(std::vector<Candidate>& candidates, const LocalMap& local,
                                               const Points& sample, MatchResult& result) const;
  [[nodiscard]] bool is_clear(const std::vector<Candidate>& best) const;
  [[nodiscard]] Hypothesis hypothesis(const Candidate& candidate, const LocalMap& local,
                                      const Points& sample) const;
  [[nodiscard]] double free_space_violation(const Points& sample, const Pose2& map_from_local) const;
  [[nodiscard]] double unknown_share(const Points& sample, const Pose2& map_from_local) const;
  [[nodiscard]] std::vector<Candidate> judged(const std::vector<Candidate>& candidates, const LocalMap& local,
                                              const Points& sample) const;

  Params params_;
  int threads_;
  std::shared_ptr<const GlobalMap> map_;
  std::shared_ptr<const ContactIndex> contact_;
  std::shared_ptr<const RelationIndex> index_;
  MapIndexInfo map_index_;
  std::shared_ptr<const DistanceField> field_;
  CandidateRefiner refiner_;
  std::shared_ptr<const ClearanceGrid> clearance_;
  std::shared_ptr<const ContactPyramid> pyramid_;  ///< Null without exact search.
  BeamEvidence beams_;
  std::vector<Candidate> carried_;
  int epoch_ = 0;      ///< Of the local map in whose frame the carried ones are.
  int steps_ = 0;      ///< In that frame.
  int undecided_ = 0;  ///< Steps without a clear best candidate, since the last exact search.
};
void describe(ParamVisitor& v, AdaptiveBudget& p);
void describe(ParamVisitor& v, IndexedRansam::ExactSearch& p);
void describe(ParamVisitor& v, IndexedRansam::Params& p);

}  // namespace glocal
