// A scan, as MRPT has it.
#pragma once

#include <mrpt/obs/CObservation2DRangeScan.h>

#include "glocal/observation.hpp"

namespace glocal::mrpt_plugin {

/// A scan of MRPT is a fan of rays at equal angles, each with a range or none. The rays of a laser are that,
/// once those that measured nothing are filled in; for any others the fan gets so many rays that each point
/// is within 0.01° of one. Of points on one ray the nearest counts. Points that are not numbers, or lie in
/// the sensor itself, are left out. Heights are ignored.
[[nodiscard]] mrpt::obs::CObservation2DRangeScan::Ptr mrpt_scan(const Scan& scan);

}  // namespace glocal::mrpt_plugin
