// A set of points that changes from step to step, as the spans of steps in which each point is there.
#pragma once

#include <compare>
#include <cstddef>
#include <nlohmann/json_fwd.hpp>
#include <vector>

#include "report/millimetres.hpp"

namespace glocal {

/// A point is in all frames from `from` up to, but without, `to`.
struct PointLife {
  GridPoint at;
  int from = 0;
  int to = 0;

  friend auto operator<=>(const PointLife&, const PointLife&) = default;  // NOLINT(modernize-use-nullptr)
};

/// The sets of steps 0, 1, 2 … A local map of tens of thousands of points changes in a few of them from one
/// step to the next, so that lives are far fewer than points. Where they would still be too many, only every
/// 2nd, 4th … step is kept as a frame: as few are left out as it takes.
class PointLives {
 public:
  /// At most so many lives, unless the first step alone has more.
  explicit PointLives(std::size_t most) : most_(most) {}

  /// The set at the next step. In space at most 20,000 of its points are kept (thinned_in_space).
  void add(const Points& points);

  /// Allows fewer lives from now on.
  void keep_at_most(std::size_t most);

  /// The steps that are kept: frame i is of step steps()[i].
  [[nodiscard]] std::vector<std::size_t> steps() const;
  /// Ascending; a point that leaves and comes back has several.
  [[nodiscard]] std::vector<PointLife> lives() const;

 private:
  [[nodiscard]] int frames() const { return static_cast<int>((added_ + stride_ - 1) / stride_); }
  void leave_out_every_other();

  std::size_t most_;
  std::size_t added_ = 0;         ///< Steps.
  std::size_t stride_ = 1;        ///< Steps from one frame to the next.
  std::vector<PointLife> ended_;  ///< In no order.
  std::vector<PointLife> there_;  ///< In the last frame, ascending; `to` means nothing yet.
};

/// {"steps", "x", "y", "from", "to"}, and "z" if any point is above or below 0.
[[nodiscard]] nlohmann::ordered_json to_json(const PointLives& lives);

}  // namespace glocal
