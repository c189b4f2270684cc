#include "octomap_map.hpp"

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>

#include "glocal/error.hpp"
#include "tree_file.hpp"

namespace glocal::octomap_plugin {
namespace {

/// A leaf of any size between the heights: smallest voxels from `first` up to before `end`, numbered along x,
/// y and z as in octomap::OcTreeKey.
struct Block {
  Eigen::Vector3i first, end;
  bool occupied = false;
};

/// The number of the voxel that begins at the tree's origin.
constexpr int middle = 1 << 15;

/// Calls visit(block) for each leaf that has voxels whose centres lie between the heights.
template <class Visit>
void for_each_block(const octomap::OcTree& tree, const OctomapMap::Params& params, Visit visit) {
  const auto height = [&](int z) { return tree.keyToCoord(static_cast<octomap::key_type>(z)); };
  for (auto leaf = tree.begin_leafs(); leaf != tree.end_leafs(); ++leaf) {
    const octomap::OcTreeKey key = leaf.getIndexKey();
    const int side = 1 << (tree.getTreeDepth() - leaf.getDepth());
    Block block{{key[0], key[1], key[2]}, {key[0] + side, key[1] + side, key[2] + side}};
    int& low = block.first.z();
    int& high = block.end.z();
    while (low < high && height(low) < params.min_height) ++low;
    while (low < high && height(high - 1) > params.max_height) --high;
    if (low == high) continue;
    block.occupied = leaf->getOccupancy() > params.occupied_above;
    visit(block);
  }
}

/// Calls visit(x, y, z) for each smallest voxel of a block.
template <class Visit>
void for_each_voxel(const Block& block, Visit visit) {
  for (int z = block.first.z(); z < block.end.z(); ++z) {
    for (int y = block.first.y(); y < block.end.y(); ++y) {
      for (int x = block.first.x(); x < block.end.x(); ++x) visit(x, y, z);
    }
  }
}

/// What a tree has between the heights.
struct Size {
  Eigen::AlignedBox2i extent;            ///< Of the voxels, along x and y.
  std::uint64_t free = 0, occupied = 0;  ///< Smallest voxels.
};

/// Leaf by leaf: a few bytes may be more voxels than there is time for.
Size size_of(const octomap::OcTree& tree, const OctomapMap::Params& params) {
  Size size;
  for_each_block(tree, params, [&](const Block& block) {
    size.extent.extend(Eigen::Vector2i(block.first.head<2>()));
    size.extent.extend(Eigen::Vector2i(block.end.head<2>() - Eigen::Vector2i::Ones()));
    const Eigen::Vector3i sides = block.end - block.first;
    (block.occupied ? size.occupied : size.free) +=
        static_cast<std::uint64_t>(sides.cast<std::int64_t>().prod());
  });
  return size;
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
  const Size size = size_of(*tree, params_);
  const Eigen::AlignedBox2i& extent = size.extent;
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
  constexpr std::size_t most_bricks = 4'000'000, voxels_of_brick = 512;
  constexpr std::uint64_t most_bytes = 2'000'000'000, point_size = 3 * sizeof(float);
  constexpr const char* too_much_free_space =
      "has free space in more than 4 million cubes of 8 voxels a side; cut it smaller, or reduce its depth";
  if (static_cast<double>(grid.width) * grid.height > most_cells) {
    refuse("covers more than 64 million cells; cut it smaller, or reduce its depth");
  }
  if (size.occupied * point_size > most_bytes)
    refuse(
        "its occupied voxels have more than 2 GB as points; if it is the right file, cut it smaller, or "
        "reduce its depth");
  if (size.free > most_bricks * voxels_of_brick) refuse(too_much_free_space);
  const auto cells = static_cast<std::size_t>(grid.width) * static_cast<std::size_t>(grid.height);
  if (in_space) map.free_voxels = FreeVoxels(map_from_tree, side);
  std::vector<int> occupied_voxels(cells, 0);
  grid.cells = PackedCells(cells);
  if (in_space) map.points.reserve(size.occupied);
  const auto add_free = [&](int x, int y, int z) {
    grid.cells[grid.index(x - extent.min().x(), y - extent.min().y())] = Cell::free;
    if (in_space) map.free_voxels.add(x - middle, y - middle, z - middle);
    if (map.free_voxels.bricks() > most_bricks) refuse(too_much_free_space);
  };
  const auto add_occupied = [&](int x, int y, int z) {
    const int column = x - extent.min().x();
    const int row = y - extent.min().y();
    ++occupied_voxels[grid.index(column, row)];
    if (!in_space) return;
    const Pose2 centre = grid.centre(column, row);
    map.points.push_back({static_cast<float>(centre.x), static_cast<float>(centre.y),
                          static_cast<float>(tree->keyToCoord(static_cast<octomap::key_type>(z)))});
  };
  for_each_block(*tree, params_, [&](const Block& block) {
    if (block.occupied) {
      for_each_voxel(block, add_occupied);
    } else {
      for_each_voxel(block, add_free);
    }
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
