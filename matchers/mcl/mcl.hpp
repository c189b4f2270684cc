#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/clearance_grid.hpp"
#include "glocal/contact.hpp"
#include "glocal/params.hpp"
#include "glocal/particles.hpp"
#include "glocal/strategies.hpp"
#include "matchers/mcl/beam_model.hpp"
#include "matchers/mcl/free_space.hpp"
#include "matchers/mcl/likelihood_field.hpp"
#include "matchers/mcl/odometry_motion.hpp"
#include "matchers/mcl/resampling.hpp"

namespace glocal::mcl {

/// Monte Carlo localization: a particle filter over robot poses (Dellaert, Fox, Burgard and Thrun 1999;
/// Thrun, Burgard and Fox, Probabilistic Robotics, Table 8.3), with the number of particles adapted by
/// KLD-sampling and, if asked for, new particles where the filter has lost its robot. It begins with
/// particles all over the map's free space and goes on with increments of odometry. Parameters have the names
/// and defaults of AMCL (Nav2), unless their descriptions say otherwise.
///
/// It looks at the latest scan only; the local map just says in which frame a hypothesis is told, and how
/// good it is by eq. 4. Hypotheses are the particles, those in one cell of pose space told as their mean, and
/// their score is the contact of the latest scan (hypotheses_of()). Without a scan there are no hypotheses;
/// the motion is made up for with the next one.
///
/// `proposals` counts particles, `points_tested` looks at the end of a beam.
class Mcl final : public Matcher {
 public:
  struct Params {
    int max_particles = 2000;
    double recovery_alpha_slow = 0.0;
    double recovery_alpha_fast = 0.0;
    double update_min_d = 0.25;
    double update_min_a_deg = 11.5;
    OdometryNoise noise = {};
    std::string laser_model_type = "likelihood_field";
    double likelihood_exponent = 1.0;
    double z_hit = 0.5;
    double laser_max_range = 100.0;
    std::optional<double> contact_epsilon = {};
    ParticleMerging merging = {};
  };

  /// Throws ConfigError where the map has no free cell, or is too large for a table of distances or a contact
  /// grid.
  Mcl(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override;

 private:
  /// Beams that are looked at, in the robot's frame.
  struct Beams {
    Point origin;
    Points hits;
    std::vector<double> ranges;  ///< m; met_nothing for the last ones.
    Points reach;  ///< Where each beam would be at the largest range, if nothing were in its way.
  };
  [[nodiscard]] Beams beams_of(const Scan& scan) const;
  void begin(Rng& rng);
  [[nodiscard]] bool is_due(const Pose2& moved) const;
  void update(const Pose2& moved, const Beams& beams, Rng& rng);
  void score(const Beams& beams, const MotionBatch& poses, std::size_t size,
             LikelihoodField::Sums& scores) const;
  [[nodiscard]] double beam_score(const Beams& beams, const Transform& map_from_robot) const;
  [[nodiscard]] double term(double likelihood) const;
  void weigh(std::vector<double>& log_likelihoods);
  void resample(Rng& rng);
  [[nodiscard]] std::size_t sample_size(double share_of_new, Rng& rng) const;

  Params params_;
  bool is_product_;  ///< Likelihoods of beams are multiplied; else AMCL's sum of cubes.
  int threads_;
  std::shared_ptr<const FreeSpace> free_space_;
  std::shared_ptr<const LikelihoodField> field_;  ///< Null for the beam model.
  std::shared_ptr<const ClearanceGrid> grid_;     ///< Null for the likelihood field.
  std::shared_ptr<const ContactIndex> contact_;
  BeamModelRule beam_rule_;

  Particles particles_;                  ///< As of the last update.
  std::optional<Pose2> odom_from_last_;  ///< Of the last update; none before the first.
  RecoveryAverages averages_;
};
void describe(ParamVisitor& v, Mcl::Params& p);

}  // namespace glocal::mcl
