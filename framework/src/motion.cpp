#include "glocal/motion.hpp"

namespace glocal {

const char* to_string(Motion motion) {
  switch (motion) {
    case Motion::planar:
      return "planar";
    case Motion::upright:
      return "upright";
    case Motion::free:
      return "free";
  }
  return "";
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
