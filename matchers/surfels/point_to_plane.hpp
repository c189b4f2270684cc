// Refinement of a motion between clouds of surfels.
#pragma once

#include "matchers/surfels/prepared_cloud.hpp"
#include "matchers/surfels/rigid_motion.hpp"
#include "matchers/surfels/surfel_contact.hpp"

namespace glocal::surfels {

/// The motion near a given one that brings the first surfels of a sample, n at most, nearest to the planes of
/// those they lie on: so many steps of Gauss and Newton with Tukey's weights (Chen and Medioni 1991).
/// `upright` leaves which way is up as it is: only turns about z.
[[nodiscard]] RigidMotion refined(const RigidMotion& target_from_source, const SurfelSample& sample,
                                  std::size_t n, const SurfelContact& target, int steps, bool upright);

}  // namespace glocal::surfels
