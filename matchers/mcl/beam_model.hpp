// How likely a measured range is where the map says what a beam should meet.
#pragma once

#include <limits>

namespace glocal::mcl {

/// Parameters of the model, with the names and defaults of AMCL (Nav2). The four weights need not add up to
/// 1: only their shares count.
struct BeamModelRule {
  double z_hit = 0.5;         ///< Of beams that meet what the map says.
  double z_short = 0.05;      ///< Of beams that meet something before that.
  double z_max = 0.05;        ///< Of beams that meet nothing.
  double z_rand = 0.5;        ///< Of beams that meet anything anywhere.
  double sigma_hit = 0.2;     ///< Standard deviation of a hit, m.
  double lambda_short = 0.1;  ///< Rate at which too short beams get rarer with their range, 1/m.
  double max_range = 100.0;   ///< m
};

/// What a beam has measured: a range (m), or that it met nothing.
constexpr double met_nothing = std::numeric_limits<double>::infinity();

/// p(z | x, m) of a measured range where the beam should end at `expected` (m; met_nothing where the map has
/// nothing there): a normal distribution about it, an exponential one of things before it, a peak at the
/// largest range and a uniform distribution, each normalised (Thrun, Burgard and Fox, Probabilistic Robotics,
/// eq. 6.4 to 6.12). A density in 1/m, for met_nothing a probability.
[[nodiscard]] double beam_likelihood(double measured, double expected, const BeamModelRule& rule);

}  // namespace glocal::mcl
