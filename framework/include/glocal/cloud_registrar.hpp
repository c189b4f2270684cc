// Ways to find the pose of one cloud in another, by name.
#pragma once

#include "glocal/points.hpp"
#include "glocal/register_clouds.hpp"
#include "glocal/registry.hpp"

namespace glocal {

/// Finds the pose of one cloud in another, without any guess; made anew for each pair of clouds, from its
/// parameters and perhaps from RegistrationOptions.
/// Contract: the same options and clouds give the same answer, bit for bit, whatever was asked before; no
/// pose is a valid answer (always so for clouds with too few points); `voxel_size` is said. Clouds are not
/// empty and hold finite numbers only.
class CloudRegistrar {
 public:
  virtual ~CloudRegistrar() = default;
  /// A registrar that does not judge its poses says so in `why`, and calls each of them a match. `overlap` is
  /// the share of one cloud on the other, in the registrar's own sense.
  [[nodiscard]] virtual Registration find(const Points& source, const Points& target) = 0;
};

/// All cloud registrars by name.
using CloudRegistrars = Registry<CloudRegistrar, RegistrationOptions>;

}  // namespace glocal
