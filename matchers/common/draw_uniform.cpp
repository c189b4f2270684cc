#include "matchers/common/triple_sampler.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/common/draw_uniform.cpp"
#include <hwy/foreach_target.h>  // compiles this file once for each instruction set
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace glocal::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;
using Words = hn::ScalableTag<std::uint32_t>;
using Vector = hn::Vec<Words>;

/// A bijection that scatters all bits, of the family "xorshift, multiply" with constants found by search
/// (Wellons' hash-prospector). 32-bit products are what vector units have.
HWY_INLINE Vector scatter(Vector v) {
  const Words d;
  v = hn::Mul(hn::Xor(v, hn::ShiftRight<16>(v)), hn::Set(d, 0x21f0aaadU));
  v = hn::Mul(hn::Xor(v, hn::ShiftRight<15>(v)), hn::Set(d, 0x735a2d97U));
  return hn::Xor(v, hn::ShiftRight<15>(v));
}

/// Maps 32 random bits to [0, n): the upper half of the product.
HWY_INLINE Vector below(Vector bits, Vector n) {
  const Words d;
#if HWY_TARGET == HWY_SCALAR  // one lane has no wider one beside it
  return hn::Set(d, static_cast<std::uint32_t>(std::uint64_t{hn::GetLane(bits)} * hn::GetLane(n) >> 32U));
#else
  const hn::Repartition<std::uint64_t, Words> d64;
  const auto even = hn::ShiftRight<32>(hn::MulEven(bits, n));
  const auto odd = hn::MulEven(hn::BitCast(d, hn::ShiftRight<32>(hn::BitCast(d64, bits))), n);
  return hn::Or(hn::BitCast(d, even), hn::BitCast(d, hn::And(odd, hn::Set(d64, 0xffffffff00000000ULL))));
#endif
}

void draw_uniform_in_vectors(std::uint64_t seed, std::uint32_t n, TripleBatch& batch) {
  const Words d;
  const Vector size = hn::Set(d, n);
  const auto low = static_cast<std::uint32_t>(seed);
  const auto high = static_cast<std::uint32_t>(seed >> 32U);
  // Steps of the golden ratio keep the three numbers of a draw apart.
  const Vector step = hn::Set(d, 0x9e3779b9U);
  for (std::size_t i = 0; i < batch.size; i += hn::Lanes(d)) {
    const Vector number = hn::LoadU(d, &batch.numbers[i]);
    const Vector first = hn::Add(scatter(hn::Xor(number, hn::Set(d, low))), hn::Set(d, high));
    const Vector second = hn::Add(first, step);
    const Vector third = hn::Add(second, step);
    hn::StoreU(below(scatter(first), size), d, &batch.first[i]);
    hn::StoreU(below(scatter(second), size), d, &batch.second[i]);
    hn::StoreU(below(scatter(third), size), d, &batch.third[i]);
  }
}

}  // namespace
}  // namespace glocal::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace glocal {

HWY_EXPORT(draw_uniform_in_vectors);

void draw_uniform(std::uint64_t seed, std::uint32_t n, TripleBatch& batch) {
  HWY_DYNAMIC_DISPATCH(draw_uniform_in_vectors)(seed, n, batch);
}

}  // namespace glocal
#endif
