// How the place differs from its map, as a trial has seen it.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "evaluation/running/drive.hpp"
#include "evaluation/running/trials.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/global_map.hpp"

namespace glocal {

/// Something that the map lacks, or that is gone. A box along the axes of the map's frame, m.
struct MapChange {
  double x = 0.0, y = 0.0;  ///< Its middle.
  double width = 0.0, height = 0.0;
  std::size_t views = 0;  ///< Scans that tell it, in one of its cells at most.
};

/// Finds them from scans of a robot that knows where it is. What at least three scans from different poses
/// tell counts, so that those who walk by do not. Of a map with a grid, in the plane.
class MapChanges {
 public:
  /// The map must outlive this.
  explicit MapChanges(const GlobalMap& map);

  /// `map_from_robot` is relative to the map's origin. A scan from the pose of the last one says nothing new.
  void add(const Scan& scan, const Pose2& map_from_robot);

  /// What stands where the map is free, at least 0.25 m from all that it shows.
  [[nodiscard]] std::vector<MapChange> brought() const;
  /// What the map shows and rays pass through.
  [[nodiscard]] std::vector<MapChange> taken() const;

 private:
  /// A square of some grid.
  using Square = std::pair<int, int>;
  struct Views {
    std::uint32_t hits = 0;    ///< Scans with a hit there.
    std::uint32_t passes = 0;  ///< Scans with a ray that goes on behind it, and no hit.
  };
  using Squares = std::map<Square, Views>;
  /// What one scan says of squares.
  struct Seen {
    std::set<Square> hit, passed;
    void add_to(Squares& squares) const;
  };
  void follow(const Pose2& from, const Pose2& to, Seen& wide, Seen& cells) const;
  void add_hit(const Pose2& hit, Seen& wide, Seen& cells) const;
  /// Changed squares that touch, as boxes.
  template <class IsChanged>
  [[nodiscard]] std::vector<MapChange> groups(const Squares& squares, double side, std::size_t least,
                                              IsChanged is_changed) const;

  const GlobalMap& map_;
  std::shared_ptr<const DistanceField> distances_;
  Squares wide_;   ///< Squares of 0.2 m, for what is new: hits of several scans never fall into one cell.
  Squares cells_;  ///< Occupied cells of the map.
  std::optional<Pose2> last_;
};

/// Where a results folder has those of a trial.
[[nodiscard]] std::string changes_file(std::size_t trial);

/// A file as changes_json() makes it. Throws ConfigError for any other.
[[nodiscard]] nlohmann::ordered_json read_changes(const std::filesystem::path& file);

/// The changes that a trial with a declared pose has seen up to its last step, as JSON; none without such a
/// pose, in space, and on a map without a grid.
[[nodiscard]] std::optional<std::string> changes_json(const TrialRecord& trial, const Drive& drive,
                                                      const GlobalMap& map);

}  // namespace glocal
