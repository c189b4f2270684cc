// The least and the most that is taken from files and messages, whatever their format; docs/limits.md has
// them for users.
#pragma once

#include <cstdint>
#include <string>

#include "glocal/global_map.hpp"

namespace glocal {

/// Side of a map's cells, or how far its points lie apart, m.
inline constexpr double least_resolution = 0.001, largest_resolution = 100.0;

/// Stamps, ns before or after 1970: 145 years, so that their differences fit into 64 bits.
inline constexpr std::int64_t latest_stamp_ns = 4'600'000'000'000'000'000;

/// How long a scan takes at most, s: what is told of its readings' times.
inline constexpr double longest_scan_s = 1000.0;

// Each says why a value cannot be taken, and what to do; empty if it can. NaN cannot.

[[nodiscard]] std::string fault_of_resolution(double metres);
[[nodiscard]] std::string fault_of_stamp(double seconds);
[[nodiscard]] std::string fault_of_stamp_ns(std::int64_t ns);
/// Times of a scan's first and last reading, after its stamp or by the driver's own clock.
[[nodiscard]] std::string fault_of_scan_times(double first_s, double last_s);
/// A map as it was loaded: its resolution, number of cells, and distance from the origin of its frame; and
/// from MapData::origin, where single precision must still tell places apart that are an eighth of the
/// resolution from each other.
[[nodiscard]] std::string fault_of_map(const MapData& map);

}  // namespace glocal
