// The particle filter of the Mobile Robot Programming Toolkit, as people use it to localize robots.
#pragma once

#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/slam/CMonteCarloLocalization2D.h>

#include <memory>
#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/params.hpp"
#include "glocal/particles.hpp"
#include "glocal/strategies.hpp"
#include "grid.hpp"
#include "options.hpp"

namespace glocal::mrpt_plugin {

/// Monte Carlo localization by MRPT (mrpt::slam::CMonteCarloLocalization2D). It begins with particles all
/// over free space (resetUniformFreeSpace) and goes on with increments of odometry. It looks at the latest
/// scan only, and at every one. Parameters have MRPT's names and defaults, unless their descriptions say
/// otherwise.
///
/// Hypotheses are the particles, those in one cell of pose space told as their mean, and their score is the
/// contact of the latest scan (hypotheses_of()). Without a scan there are no hypotheses; the motion is made
/// up for with the next one.
///
/// `proposals` counts particles, `points_tested` looks at the end of a beam.
///
/// MRPT draws from a generator that each thread has of its own. It is made anew in each step from the
/// matcher's random numbers, so that an answer does not depend on what else the thread has done. MRPT works
/// in one thread, and its normal distribution is the standard library's.
class MrptMcl final : public Matcher {
 public:
  struct Params {
    int particles_count = 40000;
    MrptFilterOptions pf_options = {};
    MrptKldParams kld_params = {};
    MrptLikelihoodOptions likelihood_options = {};
    MrptMotionModel motion_model = {};
    std::optional<double> contact_epsilon = {};
    ParticleMerging merging = {};
  };

  /// Throws ConfigError where the map has no free cell, or is too large.
  MrptMcl(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override;

 private:
  void begin();
  /// Moves the particles and weighs them by the scan; says how many ends of beams were looked at for each.
  std::size_t update(const Pose2& moved, const Scan& scan);
  [[nodiscard]] Particles particles() const;

  Params params_;
  /// Not shared with other matchers: MRPT keeps likelihoods in it, which it works out where they are first
  /// needed.
  MrptGrid grid_;
  std::shared_ptr<const ContactIndex> contact_;
  mrpt::bayes::CParticleFilter algorithm_;
  std::unique_ptr<mrpt::slam::CMonteCarloLocalization2D> filter_;  ///< None before the first scan.
  std::optional<Pose2> odom_from_last_;                            ///< Of the last update; none before it.
};
void describe(ParamVisitor& v, MrptMcl::Params& p);

}  // namespace glocal::mrpt_plugin
