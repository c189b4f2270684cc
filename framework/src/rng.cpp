#include "glocal/rng.hpp"

#include <cmath>
#include <numbers>

namespace glocal {

double Rng::normal(double standard_deviation) {
  const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
  return standard_deviation * radius * std::cos(2.0 * std::numbers::pi * uniform());
}

}  // namespace glocal
