// The features of a map, and which of them look like a given one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "matchers/common/oriented_points.hpp"
#include "matchers/iransac/hashed_vectors.hpp"
#include "matchers/iransac/shape_context.hpp"

namespace glocal::iransac {

/// Shape contexts of all surface points of a map. Built once and read by all.
class FeatureIndex {
 public:
  /// With hashing, only what it finds is compared with a vector; without, all of them are. (A kd-tree is
  /// slower than that: vectors have a hundred dimensions and more, and all are about as far apart.)
  FeatureIndex(OrientedPoints oriented_points, const ShapeContextRule& rule,
               const std::optional<HashRule>& hashing, int threads);

  [[nodiscard]] const OrientedPoints& oriented_points() const { return oriented_points_; }
  /// Numbers of the surface points whose vectors are nearest, at most so many, the nearest first.
  [[nodiscard]] std::vector<std::uint32_t> nearest(const float* vector, std::size_t most) const;
  [[nodiscard]] std::size_t memory_bytes() const;

 private:
  OrientedPoints oriented_points_;
  FeatureVectors vectors_;
  std::optional<HashedVectors> hashed_;
};

}  // namespace glocal::iransac
