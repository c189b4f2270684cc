// The bits of windows over a map, for many sizes of windows.
#pragma once

#include <cstddef>
#include <vector>

#include "glocal/points.hpp"
#include "matchers/box_search/cell_frame.hpp"
#include "matchers/box_search/window_bits.hpp"

namespace glocal {

/// Windows of one size, which are sorted by where they begin within 2^level cells.
struct WindowKind {
  int level = 0;   ///< They are 2^level cells wide and `wider` more.
  int wider = 0;   ///< These come before the cell that names a window.
  int height = 1;  ///< Layers of cells.
  int step = 1;    ///< One begins every so many layers of cells, those of window 0 at layer 0.

  /// How many layers of windows begin below the first layer of cells, but reach it.
  [[nodiscard]] int layers_before() const { return (height - 1) / step; }
  /// How many layers of windows have a cell of the frame.
  [[nodiscard]] std::size_t layers(const CellFrame& frame) const {
    const int layers = (frame.layers + step - 1) / step + layers_before();
    return static_cast<std::size_t>(layers);
  }
};

/// The bits of windows of each kind over the cells within `epsilon` (m) of a point of the map: by their
/// centres, or, with `anywhere`, by the nearest of their places.
[[nodiscard]] std::vector<WindowBits> windows_of_map(const Points& map_points, const CellFrame& frame,
                                                     double epsilon, bool anywhere,
                                                     const std::vector<WindowKind>& kinds, int threads);

}  // namespace glocal
