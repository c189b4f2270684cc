#include "octomap_map.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <cstddef>

#include "glocal/error.hpp"
#include "tree_file.hpp"

namespace glocal::octomap_plugin {
namespace {

/// Smallest voxels of a tree, numbered along x, y and z as in octomap::OcTreeKey.
struct Voxel {
  int x, y, z;
};

/// The number of the voxel that begins at the tree's origin.
constexpr int middle = 1 << 15;

/// Calls visit(voxel, occupied) for each smallest voxel whose centre lies between the heights. Leaves of any
/// size are taken apart.
template <class Visit>
void for_each_voxel(const octomap::OcTree& tree, const OctomapMap::Params& params, Visit visit) {
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const bool occupied = leaf->getOccupancy() > params.occupied_above;
    const octomap::OcTreeKey first = leaf.getIndexKey();
    const int side = 1 << (tree.getTreeDepth() - leaf.getDepth());
    for (int z = first[2]; z < first[2] + side; ++z) {
      const double height = tree.keyToCoord(static_cast<octomap::key_type>(z));
      if (height < params.min_height || height > params.max_height) continue;
      for (int y = first[1]; y < first[1] + side; ++y) {
        for (int x = first[0]; x < first[0] + side; ++x) visit(Voxel{x, y, z}, occupied);
      }
    }
  }
}

}  // namespace

void describe(ParamVisitor& v, OctomapMap::Params& p) {
  v.field("path", p.path, {.doc = "A .bt or .ot file of OctoMap.", .required = true});
  v.field("min_height", p.min_height,
          {.doc = "Voxels whose centre is lower are left out.", .unit = "m", .min = -1000.0, .max = 1000.0});
  v.field(
      "max_height", p.max_height,
      {.doc = "Voxels whose centre is higher are left out: a planar laser sees a band around its own height.",
       .unit = "m",
       .min = -1000.0,
       .max = 1000.0});
  v.require(p.min_height < p.max_height, "max_height", "must be above min_height");
  v.field("occupied_above", p.occupied_above,
          {.doc = "Probability above which a voxel is occupied; .bt files know only yes and no.",
           .min = 0.0,
           .max = 1.0});
  v.field("min_voxels", p.min_voxels,
          {.doc = "A cell of the plan is occupied if so many voxels above one another are.",
           .min = 1,
           .max = 65536});
  v.field(
      "points", p.points,
      {.doc = "Points of the map: the plan's occupied cells, or every occupied voxel in space. There a "
              "cell of the plan is free if one of its voxels is: a robot may be over a floor; and the map "
              "knows of its free voxels.",
       .choices = {"plan", "space"}});
  v.field("tree_pose", p.tree_pose,
          {.doc = "Pose of the tree's frame in the map's: x, y (m), yaw (deg).",
           .min = -1e6,
           .max = 1e6,
           .min_items = 3,
           .max_items = 3,
           .formerly = "map_from_tree"});
}

OctomapMap::OctomapMap(const Params& params, const SourceSetup& setup) : params_(params) {
  setup.note_input(params.path.resolved);
}

MapData OctomapMap::load() {
  const auto refuse = [&](const char* why) { throw ConfigError(params_.path.resolved, why); };
  const std::unique_ptr<octomap::OcTree> tree = read_tree(params_.path.resolved);
  const bool in_space = params_.points == "space";
  Eigen::AlignedBox2i extent;
  for_each_voxel(*tree, params_,
                 [&](const Voxel& v, bool /*occupied*/) { extent.extend(Eigen::Vector2i(v.x, v.y)); });
  if (extent.isEmpty()) refuse("has no voxel between min_height and max_height; take a wider band");

  MapData map;
  OccupancyGrid& grid = map.grid;
  map.origin = origin_near({params_.tree_pose[0], params_.tree_pose[1], 0.0});
  const Pose2 map_from_tree{params_.tree_pose[0] - map.origin.x(), params_.tree_pose[1] - map.origin.y(),
                            wrap_angle(radians(params_.tree_pose[2]))};
  const double side = tree->getResolution();
  const auto corner = [&](int key) {
    return tree->keyToCoord(static_cast<octomap::key_type>(key)) - side / 2.0;
  };
  grid.map_from_grid = map_from_tree * Pose2{corner(extent.min().x()), corner(extent.min().y()), 0.0};
  grid.resolution = side;
  grid.width = extent.sizes().x() + 1;
  grid.height = extent.sizes().y() + 1;
  constexpr double most_cells = 64e6;
  constexpr std::size_t most_bricks = 4'000'000;
  if (static_cast<double>(grid.width) * grid.height > most_cells) {
    refuse("covers more than 64 million cells; cut it smaller, or reduce its depth");
  }
  const auto cells = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  if (in_space) map.free_voxels = FreeVoxels(map_from_tree, side);
  std::vector<int> occupied_voxels(cells, 0);
  grid.cells = PackedCells(cells);
  for_each_voxel(*tree, params_, [&](const Voxel& v, bool occupied) {
    const std::size_t cell = grid.index(v.x - extent.min().x(), v.y - extent.min().y());
    if (!occupied) {
      grid.cells[cell] = Cell::free;
      if (in_space) map.free_voxels.add(v.x - middle, v.y - middle, v.z - middle);
      if (map.free_voxels.bricks() > most_bricks)
        refuse(
            "has free space in more than 4 million cubes of 8 voxels a side; cut it smaller, or reduce its "
            "depth");
      return;
    }
    ++occupied_voxels[cell];
    if (!in_space) return;
    const Pose2 centre = grid.centre(v.x - extent.min().x(), v.y - extent.min().y());
    map.points.push_back({static_cast<float>(centre.x), static_cast<float>(centre.y),
                          static_cast<float>(tree->keyToCoord(static_cast<octomap::key_type>(v.z)))});
  });
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const bool is_over_floor = in_space && grid.cells[cell] == Cell::free;
    if (occupied_voxels[cell] >= params_.min_voxels && !is_over_floor) grid.cells[cell] = Cell::occupied;
  }
  if (!in_space) map.points = occupied_centres(grid);
  if (map.points.empty()) refuse("has nothing occupied between min_height and max_height; take a wider band");
  return map;
}

}  // namespace glocal::octomap_plugin
