#include "glocal/motion.hpp"

#include <array>
#include <cstddef>

namespace glocal {

namespace {

constexpr std::array motion_names = {"planar", "upright", "free"};
static_assert(motion_names.size() == every_motion.size());

}  // namespace

const char* to_string(Motion motion) {
  return motion_names[static_cast<std::size_t>(motion)];
}

std::string to_string(const Motions& motions) {
  std::string text;
  for (const Motion motion : every_motion) {
    if (!motions.contain(motion)) continue;
    text += text.empty() ? "" : " or ";
    text += to_string(motion);
  }
  return text;
}

}  // namespace glocal
