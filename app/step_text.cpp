#include "app/step_text.hpp"

#include <fmt/format.h>

namespace glocal::app {

std::string text_of(const Pose3& pose, Motion motion) {
  const std::string height = motion == Motion::planar ? "" : fmt::format(" z {:.2f}", pose.z);
  return fmt::format("x {:.2f} y {:.2f}{} heading {:.1f} deg", pose.x, pose.y, height,
                     degrees(pose.heading()));
}

std::string text_of(const MapPlace& place, Motion motion) {
  const std::string pose = text_of(place.map_from_robot, motion);
  return place.map.empty() ? pose : fmt::format("{}: {}", place.map, pose);
}

std::string text_of(const StepResult& result, const GlobalMap& map, double way) {
  const auto pose = result.estimate();
  const auto& estimate = result.verdict.estimate;
  return fmt::format("step {:3}  {:6.2f} m  {:13}  {}{}", result.step, way, to_string(result.verdict.kind),
                     pose ? text_of(map.place_of(*pose), result.motion) : "no pose",
                     estimate ? fmt::format(", {:.0f} %", 100.0 * estimate->confidence) : "");
}

}  // namespace glocal::app
