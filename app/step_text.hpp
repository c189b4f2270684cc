// What is said of a step while a robot is localized.
#pragma once

#include <string>

#include "glocal/global_map.hpp"
#include "glocal/step_result.hpp"

namespace glocal::app {

/// "x 1.23 y 4.56 heading 78.9 deg", with the height where the motion is not planar.
[[nodiscard]] std::string text_of(const Pose3& pose, Motion motion);

/// The same with the name of the map before it, where there are several: "first floor: x 1.23 …".
[[nodiscard]] std::string text_of(const MapPlace& place, Motion motion);

/// "step   3    1.20 m  localized      x 1.23 y 4.56 heading 78.9 deg, 99 %", after so much way (m).
[[nodiscard]] std::string text_of(const StepResult& result, const GlobalMap& map, double way);

}  // namespace glocal::app
