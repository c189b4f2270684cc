// Draws triples of points at random.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "glocal/points.hpp"
#include "glocal/rng.hpp"
#include "matchers/common/triangle.hpp"

namespace glocal {

/// Uniform triples of a point set or, with a radius, triples whose second and third point lie within that
/// radius (in the plane) of the first. Draw number n of a seed is always the same triple, so draws can be
/// repeated and split over threads.
class TripleSampler {
 public:
  /// `local_radius` 0: uniform over all points. The points must outlive the sampler and must not be empty.
  TripleSampler(const Points& points, double local_radius);

  /// Fills in the triples of `batch.numbers`. Where a local draw finds no other point near, it is three times
  /// the same point, of which no relation comes.
  void draw(std::uint64_t seed, TripleBatch& batch) const;

 private:
  [[nodiscard]] Triple draw_local(Rng rng) const;
  [[nodiscard]] std::optional<std::uint32_t> draw_near(std::uint32_t centre, Rng& rng) const;
  [[nodiscard]] std::size_t cell_of(float x, float y) const;

  const Points& points_;
  std::uint32_t size_;
  // Points sorted by square cells of side `local_radius`, so that the neighbours of a point are three runs of
  // `order_`.
  float radius_ = 0.0F;
  float cell_ = 0.0F;  ///< Side of the cells, the radius or more.
  float min_x_ = 0.0F, min_y_ = 0.0F;
  std::size_t columns_ = 0;
  std::vector<std::uint32_t> order_;
  std::vector<std::uint32_t> starts_;  ///< Where each cell begins in order_; one more at the end.
};

}  // namespace glocal
