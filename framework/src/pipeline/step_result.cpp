#include "glocal/step_result.hpp"

#include <fmt/format.h>

#include <cmath>

namespace glocal {

const char* to_string(VerdictKind kind) {
  switch (kind) {
    case VerdictKind::searching:
      return "searching";
    case VerdictKind::ambiguous:
      return "ambiguous";
    case VerdictKind::localized:
      return "localized";
    case VerdictKind::unknown_place:
      return "unknown_place";
  }
  return "";
}

const char* to_string(SetupFault fault) {
  switch (fault) {
    case SetupFault::repeated_scans:
      return "repeated_scans";
    case SetupFault::upside_down:
      return "upside_down";
    case SetupFault::mount_angle:
      return "mount_angle";
    case SetupFault::late_scans:
      return "late_scans";
    case SetupFault::stuck_ranges:
      return "stuck_ranges";
    case SetupFault::biased_ranges:
      return "biased_ranges";
    case SetupFault::mirrored:
      return "mirrored";
  }
  return "";
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
