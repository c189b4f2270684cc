#include "sources/several/several_maps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>

#include "glocal/error.hpp"
#include "glocal/extent.hpp"
#include "sources/several/one_of_several.hpp"

namespace glocal::several {
namespace {

/// m; farther than a laser sees indoors. Unknown cells in between take memory.
constexpr double between_grids = 40.0;
/// m; farther than lidars see. Points leave nothing in between.
constexpr double between_clouds = 200.0;

[[noreturn]] void fail(std::string message) {
  throw ConfigError({{"", 0, 0, std::move(message), "map.several.maps"}});
}

/// What the places of a map are counted in: its cells, its voxels, or else metres.
struct Lattice {
  enum class Kind { cells, voxels, none } kind = Kind::none;
  Pose2 map_from_lattice;
  double side = 1.0;  ///< m
};

const char* to_string(Lattice::Kind kind) {
  switch (kind) {
    case Lattice::Kind::cells:
      return "cells";
    case Lattice::Kind::voxels:
      return "free voxels";
    case Lattice::Kind::none:
      break;
  }
  return "points alone";
}

Lattice lattice_of(const MapData& map) {
  using enum Lattice::Kind;
  if (!map.grid.cells.empty()) return {cells, map.grid.map_from_grid, map.grid.resolution};
  const FreeVoxels& free = map.free_voxels;
  return free.empty() ? Lattice{} : Lattice{voxels, free.map_from_voxels(), free.side()};
}

/// From the first to beyond the last place along the lattice's x axis, in its sides.
struct Columns {
  int first = 0, end = 0;
};

Columns columns_of(const MapData& map, const Lattice& lattice) {
  if (lattice.kind == Lattice::Kind::cells) return {0, map.grid.width};
  const Extent x = extent_of(moved(map.points, inverse(lattice.map_from_lattice)).x);
  return {static_cast<int>(std::floor(x.low / lattice.side)),
          static_cast<int>(std::floor(x.high / lattice.side)) + 1};
}

void append(const Points& more, Points& all) {
  all.x.insert(all.x.end(), more.x.begin(), more.x.end());
  all.y.insert(all.y.end(), more.y.begin(), more.y.end());
  all.z.insert(all.z.end(), more.z.begin(), more.z.end());
}

/// Joins one map after the other.
class SideBySide {
 public:
  void add(const std::string& name, MapData map) {
    const Lattice lattice = lattice_of(map);
    const Columns columns = columns_of(map, lattice);
    if (all_.parts.empty()) begin(name, map, lattice);
    require_alike(name, map, lattice);
    all_.resolution = std::max(all_.resolution, map.resolution);
    resolutions_.emplace_back(name, map.resolution);
    const int shift = all_.parts.empty() ? 0 : end_ + between() - columns.first;
    const Pose2 at{corner_.x + shift * lattice_.side, corner_.y, 0.0};
    const Pose2 common_from_map = at * inverse(lattice.map_from_lattice);
    const int first_column = shift + columns.first - between() / 2;
    place(name, map, common_from_map, corner_.x + first_column * lattice_.side);
    all_.free_voxels.add_shifted(map.free_voxels, shift);
    if (lattice.kind == Lattice::Kind::cells) grids_.push_back({shift, std::move(map.grid)});
    end_ = shift + columns.end;
  }

  /// Once all are there.
  MapData take() {
    if (!grids_.empty()) all_.grid = joined_grid();
    return std::move(all_);
  }

 private:
  struct PlacedGrid {
    int column = 0;  ///< Of the common grid, at which it begins.
    OccupancyGrid grid;
  };

  void begin(const std::string& name, const MapData& map, const Lattice& lattice) {
    first_ = name;
    lattice_ = lattice;
    corner_ = {lattice.map_from_lattice.x, lattice.map_from_lattice.y, 0.0};
    has_normals_ = !map.normals.empty();
    all_.origin = map.origin;
    all_.resolution = map.resolution;
    if (lattice.kind == Lattice::Kind::voxels) all_.free_voxels = FreeVoxels(corner_, lattice.side);
  }

  void require_alike(const std::string& name, const MapData& map, const Lattice& lattice) const {
    if (!map.grid.cells.empty() && !map.free_voxels.empty())
      fail(fmt::format("'{}' has cells and free voxels; give a map that has one of both", name));
    if (lattice.kind != lattice_.kind)
      fail(fmt::format("'{}' has {}, and '{}' has {}; give maps of one kind", name, to_string(lattice.kind),
                       first_, to_string(lattice_.kind)));
    constexpr double rounding = 1e-6;  // messages have them in single precision
    if (std::abs(lattice.side - lattice_.side) > rounding * lattice_.side)
      fail(fmt::format("'{}' has {} of {:g} m, and '{}' of {:g} m; make them anew with the same", name,
                       to_string(lattice.kind), lattice.side, first_, lattice_.side));
    constexpr double alike = 1.5;
    for (const auto& [other, resolution] : resolutions_) {
      const auto [finer, coarser] = std::minmax(map.resolution, resolution);
      if (finer > 0.0 && coarser > alike * finer)
        fail(
            fmt::format("points of '{}' lie {:g} m apart, and those of '{}' {:g} m; make them anew with like "
                        "distances",
                        name, map.resolution, other, resolution));
    }
    if (map.normals.empty() == has_normals_)
      fail(fmt::format("only one of '{}' and '{}' has normals; give them for both, or for none", name,
                       first_));
  }

  /// Columns between two maps.
  [[nodiscard]] int between() const {
    const double metres = lattice_.kind == Lattice::Kind::cells ? between_grids : between_clouds;
    return static_cast<int>(std::ceil(metres / lattice_.side));
  }

  /// `common_from_map` is of places relative to the origins.
  void place(const std::string& name, const MapData& map, const Pose2& common_from_map, double from_x) {
    const Pose3 motion = common_from_map;
    all_.parts.push_back(
        {name, shifted(motion, all_.origin) * Pose3(Vector3(-map.origin)), from_x + all_.origin.x()});
    append(moved(map.points, motion), all_.points);
    append(moved(map.normals, Pose3(motion.rotation)), all_.normals);
    for (const Pose3& pose : map.path) all_.path.push_back(motion * pose);
  }

  [[nodiscard]] OccupancyGrid joined_grid() const {
    OccupancyGrid joined{corner_, lattice_.side, end_, 0, {}};
    for (const PlacedGrid& placed : grids_) joined.height = std::max(joined.height, placed.grid.height);
    const double cells = static_cast<double>(joined.width) * joined.height;
    if (cells > max_grid_cells)
      fail(
          fmt::format("side by side they have {:.0f} million cells, and 1000 million are allowed; give fewer "
                      "maps, or coarser ones",
                      cells / 1e6));
    joined.cells = PackedCells(static_cast<std::size_t>(cells));
    for (const auto& [column, grid] : grids_) {
      for (int row = 0; row < grid.height; ++row) {
        for (int i = 0; i < grid.width; ++i) joined.cell(column + i, row) = grid.cell(i, row);
      }
    }
    return joined;
  }

  MapData all_;
  std::string first_;
  std::vector<std::pair<std::string, double>> resolutions_;  ///< Of each map, by its name.
  Lattice lattice_;                                          ///< Of the first.
  Pose2 corner_;                                             ///< Of the common lattice, which is not turned.
  bool has_normals_ = false;
  int end_ = 0;  ///< Column beyond the last map.
  std::vector<PlacedGrid> grids_;
};

void require_two_names(ParamVisitor& v, const std::vector<NamedMap>& maps) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < maps.size(); ++i) {
    const std::string& name = maps[i].name;
    v.require(!name.empty(), fmt::format("maps[{}].name", i), "must not be empty");
    v.require(names.insert(name).second, fmt::format("maps[{}].name", i),
              fmt::format("must not be '{}' again: results could not say which of them they mean", name));
  }
}

}  // namespace

void describe(ParamVisitor& v, NamedMap& p) {
  v.field("name", p.name, {.doc = "What results and messages call it.", .required = true});
  v.strategy("source", p.source, *p.sources, {.doc = "The map.", .required = true});
}

void describe(ParamVisitor& v, SeveralMaps::Params& p) {
  v.field("maps", p.maps, {.doc = "The robot is on one of them.", .min_items = 1, .required = true},
          {.sources = p.sources});
  require_two_names(v, p.maps);
}

SeveralMaps::SeveralMaps(const Params& params, const SourceSetup& setup) {
  for (const NamedMap& map : params.maps) {
    names_.push_back(map.name);
    sources_.push_back(params.sources->make(map.source, setup_of(sources_.size(), setup)));
  }
}

MapData SeveralMaps::load() {
  SideBySide joined;
  for (std::size_t i = 0; i < names_.size(); ++i) joined.add(names_[i], sources_[i]->load());
  return joined.take();
}

}  // namespace glocal::several
