// Options of MRPT's particle filter, under the names that its configuration files have, in small letters.
#pragma once

#include <mrpt/bayes/CParticleFilter.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CActionRobotMovement2D.h>
#include <mrpt/slam/TKLDParams.h>

#include <string>

#include "glocal/params.hpp"

namespace glocal::mrpt_plugin {

/// mrpt::bayes::CParticleFilter::TParticleFilterOptions.
struct MrptFilterOptions {
  std::string pf_algorithm = "pfStandardProposal";
  std::string resampling_method = "prMultinomial";
  bool adaptive_sample_size = true;
  double beta = 0.5;
  double pow_factor = 1.0;
};
void describe(ParamVisitor& v, MrptFilterOptions& p);
[[nodiscard]] mrpt::bayes::CParticleFilter::TParticleFilterOptions mrpt_options(const MrptFilterOptions& p);

/// mrpt::slam::TKLDParams.
struct MrptKldParams {
  double kld_bin_size_xy = 0.2;
  double kld_bin_size_phi_deg = 10.0;
  double kld_delta = 0.01;
  double kld_epsilon = 0.02;
  int kld_min_sample_size = 250;
  int kld_max_sample_size = 40000;
};
void describe(ParamVisitor& v, MrptKldParams& p);
[[nodiscard]] mrpt::slam::TKLDParams mrpt_options(const MrptKldParams& p);

/// mrpt::maps::COccupancyGridMap2D::TLikelihoodOptions, of the method lmLikelihoodField_Thrun.
struct MrptLikelihoodOptions {
  double lf_std_hit = 0.35;
  double lf_z_hit = 0.95;
  double lf_z_random = 0.05;
  double lf_max_range = 81.0;
  int lf_decimation = 5;
  double lf_max_corrs_distance = 0.3;
  bool lf_use_square_dist = false;
  bool lf_alternate_average_method = false;
};
void describe(ParamVisitor& v, MrptLikelihoodOptions& p);
/// Writes them over the map's.
void set_options(const MrptLikelihoodOptions& p, mrpt::maps::COccupancyGridMap2D& map);

/// mrpt::obs::CActionRobotMovement2D::TMotionModelOptions::TOptions_GaussianModel.
struct MrptGaussianModel {
  double a1 = 0.01;
  double a2_deg = 0.001;
  double a3_deg = 1.0;
  double a4 = 0.05;
  double min_std_xy = 0.01;
  double min_std_phi_deg = 0.2;
};
void describe(ParamVisitor& v, MrptGaussianModel& p);

/// mrpt::obs::CActionRobotMovement2D::TMotionModelOptions::TOptions_ThrunModel.
struct MrptThrunModel {
  int n_particles_count = 300;
  double alfa1_rot_rot = 0.05;
  double alfa2_rot_trans_deg = 4.0;
  double alfa3_trans_trans = 0.01;
  double alfa4_trans_rot_deg = 0.0001;
  double additional_std_xy = 0.001;
  double additional_std_phi_deg = 0.05;
};
void describe(ParamVisitor& v, MrptThrunModel& p);

/// mrpt::obs::CActionRobotMovement2D::TMotionModelOptions.
struct MrptMotionModel {
  std::string model_selection = "mmGaussian";
  MrptGaussianModel gaussian_model = {};
  MrptThrunModel thrun_model = {};
};
void describe(ParamVisitor& v, MrptMotionModel& p);
[[nodiscard]] mrpt::obs::CActionRobotMovement2D::TMotionModelOptions mrpt_options(const MrptMotionModel& p);

}  // namespace glocal::mrpt_plugin
