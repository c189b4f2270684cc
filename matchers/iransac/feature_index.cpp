#include "matchers/iransac/feature_index.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace glocal::iransac {
namespace {

std::vector<std::uint32_t> all_of(std::size_t n) {
  std::vector<std::uint32_t> numbers(n);
  std::iota(numbers.begin(), numbers.end(), 0U);
  return numbers;
}

/// Hash functions are part of an index, not of a run: all trials share them.
constexpr std::uint64_t hash_seed = 1;

}  // namespace

FeatureIndex::FeatureIndex(OrientedPoints oriented_points, const ShapeContextRule& rule,
                           const std::optional<HashRule>& hashing, int threads)
    : oriented_points_(std::move(oriented_points)),
      vectors_(shape_contexts(oriented_points_, all_of(oriented_points_.size()), rule, threads)) {
  if (hashing) hashed_.emplace(vectors_, *hashing, Rng(hash_seed));
}

std::vector<std::uint32_t> FeatureIndex::nearest(const float* vector, std::size_t most) const {
  std::vector<std::pair<float, std::uint32_t>> by_distance;
  for (const std::uint32_t i : hashed_ ? hashed_->find(vector) : all_of(vectors_.size())) {
    by_distance.emplace_back(squared_distance(vector, vectors_[i], vectors_.dimensions), i);
  }
  const auto end = by_distance.begin() + static_cast<std::ptrdiff_t>(std::min(most, by_distance.size()));
  std::partial_sort(by_distance.begin(), end, by_distance.end());
  std::vector<std::uint32_t> found;
  for (auto it = by_distance.begin(); it != end; ++it) found.push_back(it->second);
  return found;
}

std::size_t FeatureIndex::memory_bytes() const {
  return vectors_.values.size() * sizeof(float) + oriented_points_.size() * 3 * sizeof(float) +
         (hashed_ ? hashed_->memory_bytes() : 0);
}

}  // namespace glocal::iransac
