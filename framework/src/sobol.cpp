#include "sobol.hpp"

#include <array>

namespace glocal {
namespace {

constexpr std::size_t most_initial = 7;

/// A line of new-joe-kuo-6: degree and inner coefficients of a primitive polynomial, and the first numbers m.
struct Polynomial {
  std::size_t degree;
  std::uint32_t coefficients;
  std::array<std::uint32_t, most_initial> initial;
};

/// Of dimensions 2, 3 and so on.
constexpr std::array<Polynomial, Sobol::most_dimensions - 1> polynomials = {{
    {1, 0, {1}},
    {2, 1, {1, 3}},
    {3, 1, {1, 3, 1}},
    {3, 2, {1, 1, 1}},
    {4, 1, {1, 1, 3, 3}},
    {4, 4, {1, 3, 5, 13}},
    {5, 2, {1, 1, 5, 5, 17}},
    {5, 4, {1, 1, 5, 5, 5}},
    {5, 7, {1, 1, 7, 11, 19}},
    {5, 11, {1, 1, 5, 1, 1}},
    {5, 13, {1, 1, 1, 3, 11}},
    {5, 14, {1, 3, 5, 5, 31}},
    {6, 1, {1, 3, 3, 9, 7, 49}},
    {6, 13, {1, 1, 1, 15, 21, 21}},
    {6, 16, {1, 3, 1, 13, 27, 49}},
    {6, 19, {1, 1, 1, 15, 7, 5}},
    {6, 22, {1, 3, 1, 15, 13, 25}},
    {6, 25, {1, 1, 5, 5, 19, 61}},
    {7, 1, {1, 3, 7, 11, 23, 15, 103}},
    {7, 4, {1, 3, 7, 13, 13, 15, 69}},
    {7, 7, {1, 1, 3, 13, 7, 35, 63}},
    {7, 8, {1, 3, 5, 9, 1, 25, 53}},
    {7, 14, {1, 3, 1, 13, 9, 35, 107}},
    {7, 19, {1, 3, 1, 5, 27, 61, 31}},
    {7, 21, {1, 1, 5, 11, 19, 41, 61}},
    {7, 28, {1, 3, 5, 3, 3, 13, 69}},
    {7, 31, {1, 1, 7, 13, 1, 19, 1}},
    {7, 32, {1, 3, 7, 5, 13, 19, 59}},
    {7, 37, {1, 1, 3, 9, 25, 29, 41}},
    {7, 41, {1, 3, 5, 13, 23, 1, 55}},
    {7, 42, {1, 3, 7, 3, 13, 59, 17}},
    {7, 50, {1, 3, 1, 3, 5, 53, 69}},
    {7, 55, {1, 1, 5, 5, 23, 33, 13}},
    {7, 56, {1, 1, 7, 7, 1, 61, 123}},
    {7, 59, {1, 1, 7, 9, 13, 61, 49}},
    {7, 62, {1, 3, 3, 5, 3, 55, 33}},
}};

}  // namespace

Sobol::Sobol(std::size_t dimensions) {
  for (std::size_t d = 0; d < dimensions; ++d) {
    std::vector<std::uint32_t> v(bits);
    // The first dimension is van der Corput's sequence.
    const Polynomial polynomial = d == 0 ? Polynomial{bits, 0, {}} : polynomials.at(d - 1);
    const std::size_t degree = polynomial.degree;
    for (std::size_t k = 0; k < bits; ++k) {
      if (k < degree) {
        v[k] = (d == 0 ? 1U : polynomial.initial.at(k)) << (bits - 1 - k);
        continue;
      }
      v[k] = v[k - degree] ^ (v[k - degree] >> degree);
      for (std::size_t i = 1; i < degree; ++i) {
        if (((polynomial.coefficients >> (degree - 1 - i)) & 1U) != 0) v[k] ^= v[k - i];
      }
    }
    directions_.push_back(std::move(v));
  }
}

std::vector<std::uint32_t> Sobol::point(std::uint32_t index) const {
  const std::uint32_t gray = index ^ (index >> 1U);
  std::vector<std::uint32_t> x(directions_.size());
  for (std::size_t d = 0; d < x.size(); ++d) {
    for (std::size_t k = 0; k < bits; ++k) {
      if (((gray >> k) & 1U) != 0) x[d] ^= directions_[d][k];
    }
  }
  return x;
}

}  // namespace glocal
