#include "glocal/step_result.hpp"

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

}  // namespace glocal
