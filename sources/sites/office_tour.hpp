// A robot's way through a simulated office.
#pragma once

#include <vector>

#include "glocal/rng.hpp"
#include "sources/sites/office_plan.hpp"

namespace glocal::sites {

/// Way points of a drive of `length` (m): along corridors to places all over the building, and into
/// some of the rooms on the way, and back.
[[nodiscard]] std::vector<simulation::Position> office_tour(const OfficePlan& plan, double length, Rng rng);

}  // namespace glocal::sites
