// The tilts that an exact search divides.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <functional>
#include <numbers>
#include <vector>

#include "glocal/pose3.hpp"

namespace glocal {

/// Tilts in squares of rotation vectors whose z is 0 (exponential map). A square's parts are its quarters.
class TiltSquares {
 public:
  /// Larger ones are of no interest, rad.
  static constexpr double most_tilt = radians(10.0);

  /// As large as they may be: `fit` says whether a reach (rad) is small enough.
  explicit TiltSquares(const std::function<bool(double reach)>& fit);

  /// How many there are, with a tilt of interest, before they are halved.
  [[nodiscard]] std::size_t size() const { return first_.size(); }
  /// After so many halvings, rad.
  [[nodiscard]] double side(int halvings) const { return std::ldexp(first_side_, -halvings); }
  /// How far from the middle of a square its tilts are, at most, rad: exponentials of vectors are no farther
  /// from each other than the vectors.
  [[nodiscard]] double reach(int halvings) const { return side(halvings) / std::numbers::sqrt2; }
  /// The rotation vector in the middle of the first square of that number, or of one of its parts. The last
  /// two bits of `quarters` say which quarter the last halving has taken, the two before them the one before.
  [[nodiscard]] Vector3 middle(std::size_t number, std::size_t quarters, int halvings) const;
  /// Whether a square with this middle has a tilt of interest.
  [[nodiscard]] bool is_of_interest(const Vector3& middle, int halvings) const;

  /// How far the tilts of a square move a point aside from where its middle puts it, m. The point is so high
  /// over what it is tilted about, then, and so far from it.
  [[nodiscard]] static double aside(double reach, double height, double distance);
  /// The largest tilt of a square of interest, rad.
  [[nodiscard]] static double largest(double reach) { return most_tilt + 2.0 * reach; }

 private:
  double first_side_;
  std::vector<std::array<std::size_t, 2>> first_;  ///< Column and row of each.
};

}  // namespace glocal
