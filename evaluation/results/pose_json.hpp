// Poses as results have them: docs/file-formats.md says what is in them.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>

#include "glocal/motion.hpp"
#include "glocal/pose3.hpp"

namespace glocal {

/// {x, y, theta} where the motion is planar; else {x, y, z, qx, qy, qz, qw, theta}, of which theta is the
/// heading, for readers that look from above. m and rad; qw is not negative.
[[nodiscard]] nlohmann::ordered_json to_json(const Pose3& pose, Motion motion);

/// The other way round, of either form. Throws a std::exception where it is neither.
[[nodiscard]] Pose3 pose_of(const nlohmann::ordered_json& json);

/// "x y z qx qy qz qw", as evo reads it; qw is not negative.
[[nodiscard]] std::string tum_text(const Pose3& pose);

}  // namespace glocal
