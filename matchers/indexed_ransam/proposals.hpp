// Poses proposed by what a local map and the known one have in common.
#pragma once

#include <cstddef>
#include <functional>

#include "glocal/local_map.hpp"
#include "glocal/points.hpp"
#include "glocal/rng.hpp"
#include "matchers/indexed_ransam/relation_index.hpp"

namespace glocal::indexed_ransam {

/// Takes the first `size` poses of a batch.
using TakePoses = std::function<void(const MotionBatch& map_from_local, std::size_t size)>;

/// Draws oriented point pairs or triangles from the local map, whichever the index has; lays each pair on up
/// to eight of those in the map that are like it, and each triangle on one, picked at random; and hands on
/// the poses that this gives: `most_poses` (rounded up to eight) where all have partners enough.
void propose(const RelationIndex& index, const RelationRule& rule, const LocalMap& local,
             std::size_t most_poses, Rng& rng, const TakePoses& take);

}  // namespace glocal::indexed_ransam
