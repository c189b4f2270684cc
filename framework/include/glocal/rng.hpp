// Random numbers as an argument: one seed, and a derived stream for every stage, step and chunk of work.
#pragma once

#include <cstdint>
#include <initializer_list>

namespace glocal {

/// One round of SplitMix64's output function (Steele, Lea and Flood 2014): a bijection that scatters all
/// bits.
[[nodiscard]] constexpr std::uint64_t mix64(std::uint64_t z) {
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
  return z ^ (z >> 31U);
}

/// A SplitMix64 generator. Standard distributions differ between libraries, so the ones results depend on are
/// here.
class Rng {
 public:
  explicit constexpr Rng(std::uint64_t seed) : state_(seed) {}

  /// An independent generator named by numbers (trial, step, stage, chunk …). Does not advance this one.
  [[nodiscard]] constexpr Rng stream(std::initializer_list<std::uint64_t> names) const {
    std::uint64_t seed = mix64(state_ + golden);
    for (const std::uint64_t name : names) seed = mix64((seed ^ name) + golden);
    return Rng(seed);
  }

  [[nodiscard]] constexpr std::uint64_t next() { return mix64(state_ += golden); }

  /// Leaves out the next n numbers, at once: number k of a seed can be had without those before it.
  constexpr void skip(std::uint64_t n) { state_ += n * golden; }

  /// Uniform in [0, n), by multiplication (the bias of at most n / 2^32 is of no matter for n below a
  /// million); n > 0.
  [[nodiscard]] constexpr std::uint32_t below(std::uint32_t n) {
    return static_cast<std::uint32_t>(((next() >> 32U) * n) >> 32U);
  }

  /// Uniform in [0, 1).
  [[nodiscard]] constexpr double uniform() { return static_cast<double>(next() >> 11U) * 0x1.0p-53; }
  [[nodiscard]] constexpr double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Normal with mean 0 (Box-Muller, one of the pair).
  [[nodiscard]] double normal(double standard_deviation);

 private:
  static constexpr std::uint64_t golden = 0x9e3779b97f4a7c15ULL;
  std::uint64_t state_;
};

}  // namespace glocal
