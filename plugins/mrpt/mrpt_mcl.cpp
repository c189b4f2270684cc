#include "mrpt_mcl.hpp"

#include <mrpt/maps/CPointsMap.h>
#include <mrpt/obs/CActionCollection.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFParticles.h>
#include <mrpt/random/RandomGenerators.h>

#include <cmath>
#include <cstddef>
#include <cstdint>

#include "range_scan.hpp"

namespace glocal::mrpt_plugin {
namespace {

/// Seeding it would not do: it may still have the other one of a pair of normal numbers.
void renew_generator(Rng& rng) {
  mrpt::random::getRandomGenerator() =
      mrpt::random::CRandomGenerator(static_cast<std::uint32_t>(rng.next() >> 32U));
}

mrpt::obs::CActionCollection movement(const Pose2& moved, const MrptMotionModel& model) {
  mrpt::obs::CActionRobotMovement2D made;
  made.computeFromOdometry({moved.x, moved.y, moved.theta}, mrpt_options(model));
  // MRPT gives each increment of mmThrun the weight 1 and draws as if all of them added up to 1: always the
  // first.
  if (auto* const increments = dynamic_cast<mrpt::poses::CPosePDFParticles*>(made.poseChange.get())) {
    const double share = -std::log(static_cast<double>(increments->size()));
    for (auto& increment : increments->m_particles) increment.log_w = share;
  }
  mrpt::obs::CActionCollection all;
  all.insert(made);
  return all;
}

}  // namespace

MrptMcl::MrptMcl(const Params& params, const StageSetup& setup)
    : params_(params),
      grid_(mrpt_grid(*setup.map)),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))) {
  set_options(params.likelihood_options, *grid_.cells);
  algorithm_.m_options = mrpt_options(params.pf_options);
  algorithm_.logging_enable_console_output = false;
}

void MrptMcl::reset() {
  filter_.reset();
  odom_from_last_.reset();
}

MatchResult MrptMcl::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  const Observation& latest = request.latest;
  MatchResult result;
  if (latest.scan.hits.empty()) return result;
  renew_generator(rng);
  if (!filter_) begin();
  const Pose2 odom_from_robot = seen_from_above(latest.odom_from_robot);
  const Pose2 moved = odom_from_last_ ? inverse(*odom_from_last_) * odom_from_robot : Pose2{};
  const std::size_t ends = update(moved, latest.scan);
  odom_from_last_ = odom_from_robot;
  result.proposals = filter_->particlesCount();
  result.points_tested = result.proposals * ends;
  if (local.points.empty()) return result;
  result.hypotheses =
      hypotheses_of(particles(), {}, params_.merging, *contact_, local, latest.scan, request.omega_max);
  return result;
}

void MrptMcl::begin() {
  filter_ = std::make_unique<mrpt::slam::CMonteCarloLocalization2D>();
  filter_->logging_enable_console_output = false;
  filter_->options.metricMap = grid_.cells;
  filter_->options.KLD_params = mrpt_options(params_.kld_params);
  filter_->resetUniformFreeSpace(grid_.cells.get(), 0.7, params_.particles_count);
}

std::size_t MrptMcl::update(const Pose2& moved, const Scan& scan) {
  const auto seen = mrpt_scan(scan);
  const mrpt::obs::CActionCollection actions = movement(moved, params_.motion_model);
  mrpt::obs::CSensoryFrame observations;
  observations.insert(seen);
  algorithm_.executeOn(*filter_, &actions, &observations);
  const auto* const points = seen->getAuxPointsMap<mrpt::maps::CPointsMap>();
  const std::size_t decimation = grid_.cells->likelihoodOptions.LF_decimation;
  return (points->size() + decimation - 1) / decimation;
}

Particles MrptMcl::particles() const {
  Particles result;
  result.poses.reserve(filter_->m_particles.size());
  double sum = 0.0;
  for (const auto& particle : filter_->m_particles) {
    result.poses.push_back(grid_.map_from_cells *
                           Pose2{particle.d.x, particle.d.y, wrap_angle(particle.d.phi)});
    // MRPT has logarithms, the largest of which is 0.
    result.weights.push_back(std::exp(particle.log_w));
    sum += result.weights.back();
  }
  for (double& weight : result.weights) weight /= sum;
  return result;
}

void describe(ParamVisitor& v, MrptMcl::Params& p) {
  v.field("particles_count", p.particles_count,
          {.doc = "Number of particles at the start, all over free space.",
           .min = 1,
           .max = 10e6,
           .audience = Audience::tuner});
  v.field("pf_options", p.pf_options, {.doc = "The particle filter (TParticleFilterOptions)."});
  v.field("kld_params", p.kld_params, {.doc = "Its adaptive number of particles (TKLDParams)."});
  v.field("likelihood_options", p.likelihood_options,
          {.doc = "How likely a scan is (COccupancyGridMap2D::TLikelihoodOptions)."});
  v.field("motion_model", p.motion_model,
          {.doc = "How odometry errs (CActionRobotMovement2D::TMotionModelOptions)."});
  v.require(
      p.pf_options.pf_algorithm == "pfStandardProposal" || p.motion_model.model_selection == "mmGaussian",
      "motion_model",
      "must have the model_selection mmGaussian with pfAuxiliaryPFStandard: MRPT 2.5 would move all "
      "particles alike");
  describe_contact_epsilon(v, p.contact_epsilon);
}

}  // namespace glocal::mrpt_plugin
