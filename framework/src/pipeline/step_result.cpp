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
  }
  return "";
}

}  // namespace glocal
