// Particles of a filter, told as hypotheses.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/contact.hpp"
#include "glocal/hypothesis.hpp"
#include "glocal/local_map.hpp"
#include "glocal/moments.hpp"
#include "glocal/observation.hpp"
#include "glocal/params.hpp"
#include "glocal/pose2.hpp"
#include "glocal/pose_cells.hpp"

namespace glocal {

/// Robot poses, and how likely each of them is.
struct Particles {
  std::vector<Pose2> poses;     ///< map_from_robot
  std::vector<double> weights;  ///< One for each; they add up to 1.
};

/// Sums of the particles in each cell of poses, the heaviest `most` of these first.
[[nodiscard]] std::vector<Sums<Pose2>> cell_sums(const Particles& particles, const PoseBinning& binning,
                                                 std::size_t most);

/// Which particles are one hypothesis: those whose poses lie in one cell.
struct ParticleMerging {
  double distance = 0.25;             ///< Side of a cell, m.
  double rotation = radians(10.0);    ///< Its width in heading.
  std::size_t max_hypotheses = 1000;  ///< The heaviest are kept.
};

/// What a particle filter answers: its cells, with as much support as their weights are worth in particles.
/// The quality is that of the local map (eq. 4), the score the same of the latest scan: weights say how poses
/// compare, not how good they are. `old_from_new` is what the robot has moved since the particles' poses, in
/// its old frame. Those that reach omega_max, by falling score.
[[nodiscard]] std::vector<Hypothesis> hypotheses_of(const Particles& particles, const Pose2& old_from_new,
                                                    const ParticleMerging& merging,
                                                    const ContactIndex& contact, const LocalMap& local,
                                                    const Scan& scan, double omega_max);

}  // namespace glocal
