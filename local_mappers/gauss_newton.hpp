// What registrations by Gauss-Newton steps have in common.
#pragma once

#include "glocal/params.hpp"

namespace glocal::local_mappers {

/// Describes the members of registrations' parameters that say how steps are made.
template <class RegistrationParams>
void describe_gauss_newton(ParamVisitor& v, RegistrationParams& p) {
  v.field("pointwise_weight", p.pointwise_weight,
          {.doc = "Weight of matches without normals, which count point to point; others have weight 1.",
           .min = 0.0,
           .max = 1.0});
  v.field("max_iterations", p.max_iterations, {.doc = "Gauss-Newton steps.", .min = 1, .max = 1000});
  v.field("damping", p.damping,
          {.doc = "Added to the diagonal of the normal equations per match: keeps directions still that no "
                  "match sees.",
           .max = 1.0,
           .above = 0.0});
}

}  // namespace glocal::local_mappers
