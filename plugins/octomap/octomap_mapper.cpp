#include "octomap_mapper.hpp"

#include "tree_file.hpp"

namespace glocal::octomap_plugin {

void describe(ParamVisitor& v, OctomapMapper::Params& p) {
  v.strategy("poses", p.poses, *p.mappers,
             {.doc = "Finds the poses at which scans are put into the octree."});
  v.field("resolution", p.resolution, {.doc = "Side of a voxel.", .unit = "m", .min = 0.005, .max = 1.0});
  v.field("hit_probability", p.hit_probability,
          {.doc = "That a voxel is occupied, if one ray ends in it.", .max = 0.99, .above = 0.5});
  v.field("miss_probability", p.miss_probability,
          {.doc = "That a voxel is occupied, if one ray passes through it.", .min = 0.01, .max = 0.49});
  v.field("max_probability", p.max_probability,
          {.doc = "No voxel becomes more certainly occupied: what is nearer to 0.5 fades sooner.",
           .max = 0.999,
           .above = 0.5});
  v.field("min_probability", p.min_probability,
          {.doc = "No voxel becomes more certainly free.", .min = 0.001, .max = 0.49});
  v.require(p.max_probability >= p.hit_probability, "max_probability", "must not be below hit_probability");
  v.require(p.min_probability <= p.miss_probability, "min_probability", "must not be above miss_probability");
}

OctomapMapper::OctomapMapper(const Params& params, const StageSetup& setup)
    : poses_(params.mappers->make(params.poses, setup)), tree_(params.resolution) {
  tree_.setProbHit(params.hit_probability);
  tree_.setProbMiss(params.miss_probability);
  tree_.setClampingThresMax(params.max_probability);
  tree_.setClampingThresMin(params.min_probability);
}

void OctomapMapper::add(const Observation& observation) {
  poses_->add(observation);
  const LocalMap& inner = poses_->map();
  if (inner.epoch != map_.epoch) start_over();
  map_.epoch = inner.epoch;
  map_.local_from_robot = inner.local_from_robot;
  cast_rays(observation.scan, seen_from_above(map_.local_from_robot));
  ++observations_;
  collect_points();
}

void OctomapMapper::reset() {
  poses_->reset();
  start_over();
  map_.epoch = poses_->map().epoch;
}

void OctomapMapper::start_over() {
  tree_.clear();
  voxels_.clear();
  voxel_of_.clear();
  observations_ = 0;
  map_ = {};
}

void OctomapMapper::cast_rays(const Scan& scan, const Pose2& local_from_robot) {
  const Transform transform(local_from_robot);
  const auto local = [&](const Point& p) {
    const Point q = transform(p);
    return octomap::point3d(q.x, q.y, q.z);
  };
  const octomap::point3d origin = local(scan.origin);
  octomap::KeySet occupied;
  octomap::KeySet passed;
  octomap::KeyRay ray;
  const auto is_within = [&](const octomap::point3d& p) {
    octomap::OcTreeKey any;
    return tree_.coordToKeyChecked(p, any);
  };
  const auto pass = [&](const octomap::point3d& end) {
    // OctoMap prints a line for each ray that the tree cannot hold.
    if (!is_within(origin) || !is_within(end)) return;
    if (tree_.computeRayKeys(origin, end, ray)) passed.insert(ray.begin(), ray.end());
  };
  for (std::size_t i = 0; i < scan.hits.size(); ++i) {
    const octomap::point3d end = local(scan.hits[i]);
    octomap::OcTreeKey key;
    if (!tree_.coordToKeyChecked(end, key)) continue;  // beyond what the tree can hold
    pass(end);
    occupied.insert(key);
    add_hit(key, end);
  }
  for (std::size_t i = 0; i < scan.free_ends.size(); ++i) pass(local(scan.free_ends[i]));
  // Sets are in no order, but each voxel is changed once: the order does not matter.
  for (const octomap::OcTreeKey& key : passed) {
    if (occupied.find(key) == occupied.end()) tree_.updateNode(key, false, true);
  }
  for (const octomap::OcTreeKey& key : occupied) tree_.updateNode(key, true, true);
  tree_.updateInnerOccupancy();
}

void OctomapMapper::add_hit(const octomap::OcTreeKey& key, const octomap::point3d& end) {
  const auto [entry, is_new] = voxel_of_.try_emplace(key, voxels_.size());
  if (is_new) voxels_.push_back({key, observations_});
  Voxel& voxel = voxels_[entry->second];
  voxel.x += end.x();
  voxel.y += end.y();
  voxel.z += end.z();
  voxel.hits += 1.0;
}

void OctomapMapper::collect_points() {
  map_.points.clear();
  map_.ends.clear();
  for (const Voxel& voxel : voxels_) {
    map_.ends.resize(voxel.observation, map_.points.size());
    if (!tree_.isNodeOccupied(tree_.search(voxel.key))) continue;
    map_.points.push_back({static_cast<float>(voxel.x / voxel.hits), static_cast<float>(voxel.y / voxel.hits),
                           static_cast<float>(voxel.z / voxel.hits)});
  }
  map_.ends.resize(observations_, map_.points.size());
}

std::vector<MapFile> OctomapMapper::files() const {
  return {{"bt", bt_file(tree_)}};
}

}  // namespace glocal::octomap_plugin
