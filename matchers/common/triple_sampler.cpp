#include "matchers/common/triple_sampler.hpp"

#include <algorithm>
#include <array>
#include <numeric>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "matchers/common/triple_sampler.cpp"
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

/// Uniform triples of n points, n < 2^31: those of `batch.numbers`. The same for all instruction sets. Timed
/// by bench_sampling.
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

namespace {

/// A point of the 3 x 3 cells around another one lies within the radius with a probability of pi / 9 if
/// points are spread evenly; along a wall it is much higher.
constexpr int attempts_to_find_a_neighbour = 8;
/// Random numbers set aside for each draw.
constexpr std::uint64_t numbers_per_draw = 1 + 2 * attempts_to_find_a_neighbour;

}  // namespace

TripleSampler::TripleSampler(const Points& points, double local_radius)
    : points_(points),
      size_(static_cast<std::uint32_t>(points.size())),
      radius_(static_cast<float>(local_radius)) {
  if (radius_ <= 0.0F) return;
  const auto [low_x, high_x] = std::minmax_element(points.x.begin(), points.x.end());
  const auto [low_y, high_y] = std::minmax_element(points.y.begin(), points.y.end());
  min_x_ = *low_x;
  min_y_ = *low_y;
  // Wider cells than the radius do no harm but time: so many in a row at most.
  constexpr float most_cells = 4096.0F;
  cell_ = std::max({radius_, (*high_x - min_x_) / most_cells, (*high_y - min_y_) / most_cells});
  // With a margin of one cell all around, so that every point has eight neighbouring cells.
  columns_ = static_cast<std::size_t>((*high_x - min_x_) / cell_) + 3;
  const std::size_t rows = static_cast<std::size_t>((*high_y - min_y_) / cell_) + 3;

  starts_.assign(columns_ * rows + 1, 0);
  for (std::size_t i = 0; i < points.size(); ++i) ++starts_[cell_of(points.x[i], points.y[i]) + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  order_.resize(points.size());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (std::uint32_t i = 0; i < size_; ++i) order_[next[cell_of(points.x[i], points.y[i])]++] = i;
}

std::size_t TripleSampler::cell_of(float x, float y) const {
  const std::size_t row = static_cast<std::size_t>((y - min_y_) / cell_) + 1;
  return row * columns_ + static_cast<std::size_t>((x - min_x_) / cell_) + 1;
}

void TripleSampler::draw(std::uint64_t seed, TripleBatch& batch) const {
  if (radius_ <= 0.0F) {
    HWY_DYNAMIC_DISPATCH(draw_uniform_in_vectors)(seed, size_, batch);
    return;
  }
  for (std::size_t i = 0; i < batch.size; ++i) {
    Rng rng(seed);
    rng.skip(batch.numbers[i] * numbers_per_draw);
    const Triple triple = draw_local(rng);
    batch.first[i] = triple[0];
    batch.second[i] = triple[1];
    batch.third[i] = triple[2];
  }
}

Triple TripleSampler::draw_local(Rng rng) const {
  const std::uint32_t first = rng.below(size_);
  const auto second = draw_near(first, rng);
  const auto third = draw_near(first, rng);
  if (!second || !third) return {first, first, first};
  return {first, *second, *third};
}

std::optional<std::uint32_t> TripleSampler::draw_near(std::uint32_t centre, Rng& rng) const {
  const float x = points_.x[centre];
  const float y = points_.y[centre];
  const std::size_t cell = cell_of(x, y);
  struct Run {
    std::uint32_t begin, length;
  };
  std::array<Run, 3> runs{};
  std::uint32_t candidates = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const std::size_t left = cell + i * columns_ - columns_ - 1;
    runs[i] = {starts_[left], starts_[left + 3] - starts_[left]};
    candidates += runs[i].length;
  }
  for (int attempt = 0; attempt < attempts_to_find_a_neighbour; ++attempt) {
    std::uint32_t pick = rng.below(candidates);
    std::size_t run = 0;
    while (pick >= runs[run].length) pick -= runs[run++].length;
    const std::uint32_t candidate = order_[runs[run].begin + pick];
    const float dx = points_.x[candidate] - x;
    const float dy = points_.y[candidate] - y;
    if (dx * dx + dy * dy <= radius_ * radius_) return candidate;
  }
  return std::nullopt;
}

}  // namespace glocal
#endif
