#include "glocal/step_result.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstddef>

namespace glocal {

namespace {

constexpr std::array verdict_names = {"searching", "ambiguous", "localized", "unknown_place"};
static_assert(verdict_names.size() == static_cast<std::size_t>(VerdictKind::unknown_place) + 1);

constexpr std::array setup_fault_names = {"repeated_scans", "upside_down",   "mount_angle", "late_scans",
                                          "stuck_ranges",   "biased_ranges", "mirrored"};
static_assert(setup_fault_names.size() == static_cast<std::size_t>(SetupFault::mirrored) + 1);

}  // namespace

const char* to_string(VerdictKind kind) {
  return verdict_names[static_cast<std::size_t>(kind)];
}

const char* to_string(SetupFault fault) {
  return setup_fault_names[static_cast<std::size_t>(fault)];
}

std::string SetupCheck::why() const {
  if (!fault) return "";
  switch (*fault) {
    case SetupFault::repeated_scans:
      return "the same scan comes again and again while the robot moves: does the sensor's driver hang?";
    case SetupFault::upside_down:
      return "the scans turn the other way than odometry: is the sensor mounted upside down, or is the order "
             "of its beams reversed?";
    case SetupFault::mount_angle:
      return fmt::format(
          "the scans move {:.0f} deg to the {} of where odometry says: does the sensor look {:.0f} deg too "
          "far to the {}? Correct the angle at which it is said to be mounted",
          std::abs(*mount_angle_deg), *mount_angle_deg > 0.0 ? "right" : "left", std::abs(*mount_angle_deg),
          *mount_angle_deg > 0.0 ? "left" : "right");
    case SetupFault::late_scans:
      return fmt::format(
          "the scans tell the motions that odometry told {} observations before: do they come late, or are "
          "the clocks of both not the same?",
          *late_by);
    case SetupFault::stuck_ranges:
      return fmt::format(
          "{:.0f} % of the ranges stay the same while the robot drives and turns: does the sensor's "
          "driver repeat what it has read, or is something in its view?",
          100.0 * stuck_share);
    case SetupFault::biased_ranges:
      return fmt::format(
          "straight walls look bent as they do when all ranges are {:.1f} m too {}: are the sensor's offset "
          "and unit right?",
          std::abs(*range_bias_m), *range_bias_m > 0.0 ? "long" : "short");
    case SetupFault::mirrored:
      return "mirrored, the scans fit the map better: have left and right changed places in scans and "
             "odometry, or on the map?";
  }
  return "";
}

}  // namespace glocal
