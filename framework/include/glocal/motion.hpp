// How a robot can move, which says what of its pose is looked for.
#pragma once

#include <array>
#include <cstddef>
#include <string>

namespace glocal {

/// What of a robot's pose is not known beforehand.
enum class Motion {
  planar,   ///< x, y and heading: z is 0, and nothing tilts.
  upright,  ///< x, y, z and heading: which way is up is known.
  free,     ///< All six.
};

inline constexpr std::array every_motion{Motion::planar, Motion::upright, Motion::free};
static_assert(every_motion.size() == static_cast<std::size_t>(Motion::free) + 1);

/// The name used in YAML and messages.
[[nodiscard]] const char* to_string(Motion motion);

/// The motions that a strategy can work with. A class of strategies says it with a member
/// `static constexpr Motions motions`; one that says nothing works in the plane only.
struct Motions {
  bool planar = true;
  bool upright = false;
  bool free = false;

  [[nodiscard]] constexpr bool contain(Motion motion) const {
    return std::array{planar, upright, free}[static_cast<std::size_t>(motion)];
  }

  friend bool operator==(const Motions&, const Motions&) = default;
};

inline constexpr Motions all_motions{.planar = true, .upright = true, .free = true};
inline constexpr Motions motions_in_space{.planar = false, .upright = true, .free = true};

/// "planar or upright".
[[nodiscard]] std::string to_string(const Motions& motions);

}  // namespace glocal
