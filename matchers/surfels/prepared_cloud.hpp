// A cloud with all that is looked up in it.
#pragma once

#include <cstddef>
#include <optional>

#include "glocal/rng.hpp"
#include "matchers/surfels/range_view.hpp"
#include "matchers/surfels/rigid_motion.hpp"
#include "matchers/surfels/surfel_contact.hpp"
#include "matchers/surfels/surfels.hpp"

namespace glocal::surfels {

/// Some surfels of a cloud in random order, each as often as its weight says.
struct SurfelSample {
  Points points;
  Points normals;
  Point middle = {};  ///< The points' mean.

  [[nodiscard]] std::size_t size() const { return points.size(); }
};
[[nodiscard]] SurfelSample sample_of(const Surfels& surfels, std::size_t n, Rng& rng);

/// A cloud as surfels, with what tells contact with them and what was seen through.
struct PreparedCloud {
  /// Of a cloud in voxels of a side (m). Where it was seen from: a place in its frame, if it was seen from
  /// one; contact then tells the sides of a surface apart. Throws ConfigError if the cloud reaches too far.
  PreparedCloud(const Points& cloud, float voxel_size, const std::optional<Point>& seen_from);

  Surfels surfels;
  SurfelContact contact;
  std::optional<RangeView> view;
};

/// How a cloud, moved, agrees with another one.
struct Agreement {
  double contact = 0.0;       ///< Share of the surfels in contact, by weight, in [0, 1].
  double seen_through = 0.0;  ///< Share that the other's sensor looked through, in [0, 1].
};
[[nodiscard]] Agreement agreement_of(const Surfels& moved, const RigidMotion& motion,
                                     const PreparedCloud& other);

}  // namespace glocal::surfels
