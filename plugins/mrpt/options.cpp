#include "options.hpp"

#include "glocal/pose2.hpp"

namespace glocal::mrpt_plugin {

void describe(ParamVisitor& v, MrptFilterOptions& p) {
  v.field(
      "pf_algorithm", p.pf_algorithm,
      {.doc = "How particles are proposed: by odometry alone, or also by how well the scan fits the place "
              "that each would go to (auxiliary filter), which needs a fixed number of them.",
       .choices = {"pfStandardProposal", "pfAuxiliaryPFStandard"}});
  v.field("resampling_method", p.resampling_method,
          {.doc = "How particles are drawn by their weights; anything but prMultinomial needs a fixed number "
                  "of them.",
           .choices = {"prMultinomial", "prResidual", "prStratified", "prSystematic"}});
  v.field("adaptive_sample_size", p.adaptive_sample_size,
          {.doc = "KLD-sampling. MRPT's default is false; but with a fixed number MRPT 2.5 keeps the weights "
                  "of the particles that it has drawn by them, and so counts each scan again."});
  v.require(!p.adaptive_sample_size || p.pf_algorithm == "pfStandardProposal", "pf_algorithm",
            "must be pfStandardProposal with an adaptive_sample_size: the other one would then draw by a "
            "generator that MRPT seeds from the system, and no run would be like the one before");
  v.require(!p.adaptive_sample_size || p.resampling_method == "prMultinomial", "resampling_method",
            "must be prMultinomial with an adaptive_sample_size");
  v.field("beta", p.beta,
          {.doc = "Particles are drawn anew where the effective share of them is below this; with an "
                  "adaptive sample size and pfStandardProposal they always are.",
           .min = 0.0,
           .max = 1.0});
  v.field("pow_factor", p.pow_factor,
          {.doc = "Likelihoods of scans are raised to this power, as beams err alike.",
           .max = 1.0,
           .above = 0.0,
           .audience = Audience::tuner});
}

mrpt::bayes::CParticleFilter::TParticleFilterOptions mrpt_options(const MrptFilterOptions& p) {
  using Filter = mrpt::bayes::CParticleFilter;
  using Algorithm = mrpt::typemeta::TEnumType<Filter::TParticleFilterAlgorithm>;
  using Resampling = mrpt::typemeta::TEnumType<Filter::TParticleResamplingAlgorithm>;
  Filter::TParticleFilterOptions options;
  options.PF_algorithm = Algorithm::name2value(p.pf_algorithm);
  options.resamplingMethod = Resampling::name2value(p.resampling_method);
  options.adaptiveSampleSize = p.adaptive_sample_size;
  options.BETA = p.beta;
  options.powFactor = p.pow_factor;
  return options;
}

void describe(ParamVisitor& v, MrptKldParams& p) {
  v.field("kld_bin_size_xy", p.kld_bin_size_xy,
          {.doc = "Side of a bin of places.", .unit = "m", .min = 0.001, .audience = Audience::expert});
  v.field("kld_bin_size_phi_deg", p.kld_bin_size_phi_deg,
          {.doc = "Width of a bin of headings.",
           .unit = "deg",
           .min = 0.01,
           .max = 360.0,
           .audience = Audience::expert});
  v.field("kld_delta", p.kld_delta,
          {.doc = "Probability that the error is larger than kld_epsilon.",
           .max = 0.5,
           .above = 0.0,
           .audience = Audience::expert});
  v.field("kld_epsilon", p.kld_epsilon,
          {.doc = "Largest error between the particles and what they stand for.",
           .max = 1.0,
           .above = 0.0,
           .audience = Audience::expert});
  v.field("kld_min_sample_size", p.kld_min_sample_size,
          {.doc = "Smallest number of particles.", .min = 1, .max = 10e6});
  v.field("kld_max_sample_size", p.kld_max_sample_size,
          {.doc = "Largest number of particles from the first step on (MRPT: 100,000).",
           .min = 1,
           .max = 10e6,
           .audience = Audience::tuner});
  v.require(p.kld_min_sample_size <= p.kld_max_sample_size, "kld_min_sample_size",
            "must be at most kld_max_sample_size");
}

mrpt::slam::TKLDParams mrpt_options(const MrptKldParams& p) {
  mrpt::slam::TKLDParams params;
  params.KLD_binSize_XY = p.kld_bin_size_xy;
  params.KLD_binSize_PHI = radians(p.kld_bin_size_phi_deg);
  params.KLD_delta = p.kld_delta;
  params.KLD_epsilon = p.kld_epsilon;
  params.KLD_minSampleSize = static_cast<unsigned>(p.kld_min_sample_size);
  params.KLD_maxSampleSize = static_cast<unsigned>(p.kld_max_sample_size);
  return params;
}

void describe(ParamVisitor& v, MrptLikelihoodOptions& p) {
  v.field("lf_std_hit", p.lf_std_hit,
          {.doc = "Standard deviation of a hit.", .unit = "m", .min = 0.001, .audience = Audience::tuner});
  v.field("lf_z_hit", p.lf_z_hit,
          {.doc = "Weight of beams that meet what the map says.", .min = 0.0, .max = 1.0});
  v.field("lf_z_random", p.lf_z_random,
          {.doc = "Weight of beams that meet anything anywhere.", .min = 1e-6, .max = 1.0});
  v.field("lf_max_range", p.lf_max_range,
          {.doc = "Range of the laser, over which lf_z_random is spread.",
           .unit = "m",
           .min = 0.1,
           .max = 10000.0});
  v.field(
      "lf_decimation", p.lf_decimation,
      {.doc = "Of so many beams one is looked at; of fewer than ten hits all are.", .min = 1, .max = 1000});
  v.field("lf_max_corrs_distance", p.lf_max_corrs_distance,
          {.doc = "Distance from an occupied cell at which the likelihood stops falling.",
           .unit = "m",
           .min = 0.01,
           .max = 20.0,
           .audience = Audience::expert});
  v.field("lf_use_square_dist", p.lf_use_square_dist,
          {.doc = "Squares the distance once more than a normal distribution does.",
           .audience = Audience::expert});
  v.field("lf_alternate_average_method", p.lf_alternate_average_method,
          {.doc = "A scan is as likely as the mean of its beams, not as their product.",
           .audience = Audience::expert});
}

void set_options(const MrptLikelihoodOptions& p, mrpt::maps::COccupancyGridMap2D& map) {
  using Grid = mrpt::maps::COccupancyGridMap2D;
  Grid::TLikelihoodOptions& options = map.likelihoodOptions;
  options.likelihoodMethod = Grid::lmLikelihoodField_Thrun;
  options.LF_stdHit = static_cast<float>(p.lf_std_hit);
  options.LF_zHit = static_cast<float>(p.lf_z_hit);
  options.LF_zRandom = static_cast<float>(p.lf_z_random);
  options.LF_maxRange = static_cast<float>(p.lf_max_range);
  options.LF_decimation = static_cast<std::uint32_t>(p.lf_decimation);
  options.LF_maxCorrsDistance = static_cast<float>(p.lf_max_corrs_distance);
  options.LF_useSquareDist = p.lf_use_square_dist;
  options.LF_alternateAverageMethod = p.lf_alternate_average_method;
}

void describe(ParamVisitor& v, MrptGaussianModel& p) {
  v.field("a1", p.a1, {.doc = "Standard deviation of the place, for each metre driven.", .min = 0.0});
  v.field("a2_deg", p.a2_deg,
          {.doc = "Standard deviation of the place, for each degree turned.", .unit = "m/deg", .min = 0.0});
  v.field("a3_deg", p.a3_deg,
          {.doc = "Standard deviation of the heading, for each metre driven.", .unit = "deg/m", .min = 0.0});
  v.field("a4", p.a4, {.doc = "Standard deviation of the heading, for each degree turned.", .min = 0.0});
  v.field("min_std_xy", p.min_std_xy,
          {.doc = "Standard deviation of the place, in any step.", .unit = "m", .min = 1e-6});
  v.field("min_std_phi_deg", p.min_std_phi_deg,
          {.doc = "Standard deviation of the heading, in any step.", .unit = "deg", .min = 1e-6});
}

void describe(ParamVisitor& v, MrptThrunModel& p) {
  v.field("n_particles_count", p.n_particles_count,
          {.doc = "Increments drawn in a step, which particles take at random.",
           .min = 1,
           .max = 1000000,
           .audience = Audience::expert});
  v.field("alfa1_rot_rot", p.alfa1_rot_rot,
          {.doc = "Standard deviation of a rotation, for each degree turned.", .min = 0.0});
  v.field("alfa2_rot_trans_deg", p.alfa2_rot_trans_deg,
          {.doc = "Standard deviation of a rotation, for each metre driven.", .unit = "deg/m", .min = 0.0});
  v.field("alfa3_trans_trans", p.alfa3_trans_trans,
          {.doc = "Standard deviation of the way, for each metre driven.", .min = 0.0});
  v.field("alfa4_trans_rot_deg", p.alfa4_trans_rot_deg,
          {.doc = "Standard deviation of the way, for each degree turned.", .unit = "m/deg", .min = 0.0});
  v.field("additional_std_xy", p.additional_std_xy,
          {.doc = "Standard deviation of the place, in any step.", .unit = "m", .min = 0.0});
  v.field("additional_std_phi_deg", p.additional_std_phi_deg,
          {.doc = "Standard deviation of the heading, in any step.", .unit = "deg", .min = 0.0});
}

void describe(ParamVisitor& v, MrptMotionModel& p) {
  v.field("model_selection", p.model_selection,
          {.doc = "How odometry errs: a normal distribution of the increment, or rotation, way and rotation "
                  "(Probabilistic Robotics, Table 5.6).",
           .choices = {"mmGaussian", "mmThrun"}});
  v.field("gaussian_model", p.gaussian_model, {.doc = "Noise of mmGaussian."});
  v.field("thrun_model", p.thrun_model, {.doc = "Noise of mmThrun."});
}

mrpt::obs::CActionRobotMovement2D::TMotionModelOptions mrpt_options(const MrptMotionModel& p) {
  using Movement = mrpt::obs::CActionRobotMovement2D;
  Movement::TMotionModelOptions options;
  options.modelSelection = p.model_selection == "mmThrun" ? Movement::mmThrun : Movement::mmGaussian;
  const MrptGaussianModel& normal = p.gaussian_model;
  options.gaussianModel = {normal.a1, degrees(normal.a2_deg), radians(normal.a3_deg),
                           normal.a4, normal.min_std_xy,      radians(normal.min_std_phi_deg)};
  const MrptThrunModel& thrun = p.thrun_model;
  options.thrunModel.nParticlesCount = static_cast<std::uint32_t>(thrun.n_particles_count);
  options.thrunModel.alfa1_rot_rot = static_cast<float>(thrun.alfa1_rot_rot);
  options.thrunModel.alfa2_rot_trans = static_cast<float>(radians(thrun.alfa2_rot_trans_deg));
  options.thrunModel.alfa3_trans_trans = static_cast<float>(thrun.alfa3_trans_trans);
  options.thrunModel.alfa4_trans_rot = static_cast<float>(degrees(thrun.alfa4_trans_rot_deg));
  options.thrunModel.additional_std_XY = static_cast<float>(thrun.additional_std_xy);
  options.thrunModel.additional_std_phi = static_cast<float>(radians(thrun.additional_std_phi_deg));
  return options;
}

}  // namespace glocal::mrpt_plugin
