// How good a pose is, by all that is known of it.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "glocal/clearance_grid.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/global_map.hpp"
#include "glocal/hypothesis.hpp"
#include "glocal/local_map.hpp"
#include "glocal/observation.hpp"
#include "matchers/common/beam_evidence.hpp"
#include "matchers/common/candidates.hpp"

namespace glocal::indexed_ransam {

struct JudgeRule {
  BeamRule beams = {.weight = 1.0, .cap = 0.3};
  double unknown_weight = 0.1;      ///< What the share of points in unknown cells adds to the score.
  double free_space_weight = 0.25;  ///< What the share of points in space known to be free takes from it.
  double fit_weight = 0.05;  ///< What points take from it that are as far from the map as contact allows.
  std::size_t most = 10;     ///< Poses that are left.
  double contact_epsilon = 0.10;
  double kernel = 0.15;  ///< m; of the refinement that led to a pose.
};

/// Judges poses by the contact of all points of the local map (Omega, eq. 4), by beams through walls, by what
/// the map does not show, by what it shows to be free, and by how well they fit: a score is Omega less the
/// weighted share of blocked beams, plus the weighted share of points in unknown cells, less that of points
/// in free cells out of contact, less the weighted misfit. Contact alone tells no place in a corridor from
/// the like in another one.
class PoseJudge {
 public:
  PoseJudge(const JudgeRule& rule, std::shared_ptr<const GlobalMap> map,
            std::shared_ptr<const ContactIndex> contact, std::shared_ptr<const DistanceField> field,
            int threads = 1);

  /// Takes in the beams of a scan, made where the robot is now; forget() forgets them all.
  void take_in(const LocalMap& local, const Scan& scan) { beams_.add(local, scan); }
  void forget() { beams_.clear(); }

  /// The best of the candidates, by falling score, which may be above 1. `sample` are some of the local map's
  /// points.
  [[nodiscard]] std::vector<Hypothesis> best_of(const std::vector<Candidate>& candidates,
                                                const LocalMap& local, const Points& sample) const;

  /// What a matcher tells of a pose: a score of at most 1, how uncertain the pose is, how much of the local
  /// map lies in space known to be free, and what beams say for it.
  [[nodiscard]] Hypothesis to_hypothesis(Hypothesis judged, const LocalMap& local,
                                         const Points& sample) const;

 private:
  /// What the map tells of the places of points, shares of them.
  struct PlaceEvidence {
    double unknown = 0.0;        ///< In cells of which nothing is known.
    double in_free_space = 0.0;  ///< In cells known to be free, out of contact.
    double misfit = 0.0;         ///< Mean distance to the map over contact_epsilon, each at most 1.
  };
  /// Memory to look places up in.
  struct LookUps {
    std::vector<Cell> cells;
    FieldValues field;
  };
  [[nodiscard]] PlaceEvidence evidence_at(const Pose2& map_from_local, const Points& sample,
                                          LookUps& memory) const;

  JudgeRule rule_;
  std::shared_ptr<const GlobalMap> map_;
  std::shared_ptr<const ContactIndex> contact_;
  std::shared_ptr<const DistanceField> field_;
  std::shared_ptr<const ClearanceGrid> clearance_;
  BeamEvidence beams_;
};

}  // namespace glocal::indexed_ransam
