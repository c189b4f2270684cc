#pragma once

#include <vector>

#include "glocal/hypothesis.hpp"

namespace glocal::raters {

/// Each r divided by the sum of all (eq. 8).
inline void normalise(std::vector<Rating>& ratings) {
  double sum = 0.0;
  for (const Rating& rating : ratings) sum += rating.r;
  for (Rating& rating : ratings) rating.r_normalised = rating.r / sum;
}

}  // namespace glocal::raters
