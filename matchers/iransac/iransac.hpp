#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/common/candidates.hpp"
#include "matchers/iransac/feature_index.hpp"
#include "matchers/iransac/preemption.hpp"

namespace glocal::iransac {

/// Incremental random sample consensus over features of the map, after Tanaka and Kondo (ICRA 2006) and, with
/// `lsh`, Saeki, Tanaka and Nagasaka (ICRA 2009).
///
/// As published: features of a map built on the way are looked up in a database of the known map's
/// (generalised shape contexts, optionally by locality-sensitive hashing); pairs of matches propose poses;
/// hypotheses are scored breadth-first by one block of observations after the other, the worse half given up
/// after each (preemption, Nister 2003); each step brings fresh hypotheses, and scores those left from
/// earlier ones by what it has observed anew.
///
/// Ours: which neighbours make a feature (shape_contexts), the comparison of distances and normals before a
/// pair of matches counts, contact (eq. 4) as the score of an observation, and that the best distinct poses
/// are refined and judged by all points before they become hypotheses.
///
/// `proposals` counts fresh poses that entered the preemption, `points_tested` looks at a point.
class IRansac final : public Matcher {
 public:
  struct Params {
    int features = 40;
    int matches = 10;
    bool lsh = false;
    std::optional<double> contact_epsilon = {};
    int best = 10;
  };

  /// Throws ConfigError where the map is too large for a contact grid or a distance field.
  IRansac(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override { pool_.clear(); }
  [[nodiscard]] std::optional<MapIndexInfo> map_index() const override { return map_index_; }

 private:
  void propose(const LocalMap& local, Rng& rng);

  Params params_;
  int threads_;
  std::shared_ptr<const ContactIndex> contact_;
  CandidateRefiner refiner_;
  std::shared_ptr<const FeatureIndex> index_;
  MapIndexInfo map_index_;
  std::vector<ScoredPose> pool_;
  int epoch_ = 0;  ///< Of the local map in whose frame the pool is.
};
void describe(ParamVisitor& v, IRansac::Params& p);

}  // namespace glocal::iransac
