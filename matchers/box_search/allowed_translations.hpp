#pragma once

#include "glocal/pose2.hpp"
#include "glocal/prior.hpp"

namespace glocal {

/// Those translations of one rotation that a gate allows.
class AllowedTranslations {
 public:
  /// `map_from_local` before any translation; `cell`: what translations are multiples of (m).
  AllowedTranslations(const PoseGate& gate, const Pose2& map_from_local, double cell);

  /// Whether one of a rectangle of translations may be allowed; of a single one, whether it is.
  [[nodiscard]] bool any(int column, int row, int columns = 1, int rows = 1) const;

 private:
  Pose2 map_from_start_;  ///< Before any translation.
  double cell_;
  StartRegion region_;
  bool none_;  ///< Since the rotation is not allowed.
};

}  // namespace glocal
