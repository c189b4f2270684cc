#pragma once

namespace glocal {

/// The whole number at or below a value that an integer can hold. Without the call to the library that
/// std::floor is on older processors.
template <class Integer>
[[nodiscard]] constexpr Integer rounded_down(double value) {
  const auto towards_zero = static_cast<Integer>(value);
  return static_cast<double>(towards_zero) > value ? towards_zero - 1 : towards_zero;
}

}  // namespace glocal
