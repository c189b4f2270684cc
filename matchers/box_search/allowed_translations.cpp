#include "matchers/box_search/allowed_translations.hpp"

namespace glocal {

AllowedTranslations::AllowedTranslations(const PoseGate& gate, const Pose2& map_from_local, double cell)
    : map_from_start_(map_from_local * seen_from_above(gate.local_from_start())),
      cell_(cell),
      region_(gate.prior().region),
      none_(!Prior{.region = {}, .heading = gate.prior().heading}.allows(map_from_start_)) {}

bool AllowedTranslations::any(int column, int row, int columns, int rows) const {
  if (none_ || !region_.is_given()) return !none_;
  return region_.meets(map_from_start_.x + cell_ * column, map_from_start_.y + cell_ * row,
                       map_from_start_.x + cell_ * (column + columns - 1),
                       map_from_start_.y + cell_ * (row + rows - 1));
}

}  // namespace glocal
