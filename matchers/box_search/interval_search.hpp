// The search of one interval of rotations: a first look at its largest boxes, and what is below them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "glocal/pose3.hpp"
#include "matchers/box_search/best_places.hpp"
#include "matchers/box_search/box_pyramid.hpp"
#include "matchers/box_search/pose_boxes.hpp"
#include "matchers/box_search/search_boxes.hpp"

namespace glocal::box_search {

/// What is searched, and for what.
struct Problem {
  const BoxPyramid& pyramid;
  const PoseBoxes& boxes;
  const AllPoses* all_poses;  ///< The boxes, if they are not of a grid.
  const Pose3& local_from_robot;
  const BoxSearchRule& rule;
  const std::optional<Exclusion>& exclusion;
  /// As many take the time of what is not counted: to lay all points of an interval of rotations into cells.
  std::size_t looks_of_interval;

  /// After the tilt of an interval's middle.
  [[nodiscard]] Pose3 tilted_from_robot(int level, std::size_t rotation) const {
    return boxes.tilt() ? boxes.tilted_from_local(level, rotation) * local_from_robot : local_from_robot;
  }
  /// Where in a box of level 0 its middle is, in cells: a pose of a grid is a box.
  [[nodiscard]] double middle_of_box() const { return all_poses != nullptr ? 0.5 : 0.0; }
  /// The pose at the middle of a box of level 0.
  [[nodiscard]] BoxSearchResult::FoundPose found_at(const Box& box) const;
  /// Whether that pose is near an excluded one. Others of the box may be farther away.
  [[nodiscard]] bool is_excluded(const Box& box) const;
};

/// A tile of boxes, by its first one's translation. There are millions of them on a large map.
struct Tile {
  int column, row, layer;
  /// No box of it can have more points in contact.
  std::uint32_t bound = std::numeric_limits<std::uint32_t>::max();
  /// Once its boxes are counted: bit 2 k + i for the one in column i and row k that has a box worth a look.
  std::uint8_t quarters = 0;
};

/// An interval of rotations of the top level, after a first look.
struct Interval {
  std::size_t rotation = 0;
  std::size_t bound = 0;    ///< No box of any tile can have more points in contact.
  std::size_t promise = 0;  ///< What is searched first promises most.
  /// All of the top level that may have a box that reaches the bar; of all poses, those that have one.
  std::vector<Tile> tiles = {};
  int last_layer = 0;  ///< Of translations.
};

/// A first look at an interval, and what was found by the way.
struct FirstLook {
  Interval interval;
  FoundPlaces found;
};

/// First looks at so many neighbouring intervals, from one on. A tile is looked at for all of them before the
/// next one is: their points lie in nearly the same cells, whose bits are at hand then
/// (docs/performance.md).
[[nodiscard]] std::vector<FirstLook> first_looks(const Problem& problem, std::size_t first, std::size_t size);

class WantedBoxes;
struct Bottom;

/// Counts points over the tiles of one interval of rotations, and takes what reaches the bar from them.
class TileSearch {
 public:
  TileSearch(const Problem& problem, std::size_t least) : problem_(problem), least_(least) {}

  /// Whether a box of the tile has so many points in contact, at most. It is then the tile just counted.
  [[nodiscard]] bool reaches(int level, const std::vector<CellPoints>& points, const Tile& tile,
                             std::size_t least);
  [[nodiscard]] const TileCounts& counts() const { return counts_; }

  /// The tile just counted, with the quarters that have a box worth a look, if any has; it is added to
  /// others.
  void add_counted(int level, Tile tile, const WantedBoxes& wanted, std::vector<Tile>& counted) const;
  /// Those of the tile just counted that reach so much, of level 0.
  void add_boxes(Bottom& bottom, const Tile& tile, std::size_t least);

  /// Points that a box must be able to have in contact.
  [[nodiscard]] std::size_t least() const { return least_; }
  /// What is worse than as many of these places as are wanted is not among the best of all.
  void raise();

  [[nodiscard]] const FoundPlaces& found() const { return found_; }
  [[nodiscard]] FoundPlaces& found() { return found_; }

 private:
  void count_middles(Bottom& bottom, const Tile& tile);

  const Problem& problem_;
  std::size_t least_;
  TileCounts counts_, middle_counts_;
  FoundPlaces found_;
};

/// The search below a first look. It can be interrupted after any part.
class IntervalSearch {
 public:
  /// Given up after `most_looks`: what is found is then not all.
  IntervalSearch(const Problem& problem, const Interval& interval, std::size_t least, std::size_t most_looks);

  /// Goes on for the time of about so many looks, at least one part, until it is over. Returns how many it
  /// took.
  std::size_t advance(std::size_t looks);
  [[nodiscard]] bool is_over() const { return open_.empty(); }
  [[nodiscard]] const FoundPlaces& found() const { return search_.found(); }

 private:
  /// What is still to be looked at: some tiles of an interval of a level.
  struct Part {
    int level;
    std::size_t rotation;
    std::vector<Tile> tiles;
  };
  void look_at(const Part& part);
  void look_at_bottom(const Part& part);
  void open_below(int level, std::size_t rotation, const std::vector<Tile>& counted);

  const Problem& problem_;
  std::size_t most_looks_;
  int last_layer_;  ///< Of translations.
  TileSearch search_;
  std::vector<Part> open_;          ///< The last of them comes next.
  std::vector<CellPoints> points_;  ///< Of the rotation that is looked at.
};

}  // namespace glocal::box_search
