// A robot's recording whose messages are drawn, in any of the formats that are read.
#pragma once

#include <string>

#include "fuzz/draw.hpp"

namespace glocal::fuzz {

/// A drive of a few scans with tf, odometry and a map, as an MCAP file, a ROS 1 bag or an SQLite database:
/// with what the input says about numbers, names, order, compression, and messages that are not there.
[[nodiscard]] std::string drawn_recording(Draw& draw);

}  // namespace glocal::fuzz
