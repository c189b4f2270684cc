#include "matchers/ransam/triangle_ransam.hpp"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "glocal/error.hpp"
#include "glocal/extent.hpp"
#include "glocal/voxel_filter.hpp"
#include "matchers/ransam/space_triangle.hpp"
#include "matchers/surfels/rigid_motion.hpp"
#include "matchers/surfels/surfel_contact.hpp"

namespace glocal::ransam {
namespace {

/// Surfaces are looked for in voxels of so many epsilon.
constexpr double epsilons_per_voxel = 2.0;

/// One point of each voxel: a scan is dense where its sensor is near, and those points would be drawn most.
Points spread_evenly(const Points& points, double side) {
  const VoxelGroups groups = voxel_groups(points, side);
  Points firsts;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (groups.of_point[i] == firsts.size()) firsts.push_back(points[i]);
  }
  return firsts;
}

double diagonal(const Points& points) {
  return std::hypot(extent_of(points.x).length(), extent_of(points.y).length(), extent_of(points.z).length());
}

Triangle triangle_of(const Points& points, const Triple& triple) {
  return {as_vector(points[triple[0]]), as_vector(points[triple[1]]), as_vector(points[triple[2]])};
}

/// A triple of a batch, in the order of relations.
Triple ordered_triple(const Points& points, const TripleBatch& batch, std::size_t i) {
  return in_order_of_relation(points, {batch.first[i], batch.second[i], batch.third[i]});
}

Normals normals_of(const Points& normals, const Triple& triple) {
  return {normals[triple[0]], normals[triple[1]], normals[triple[2]]};
}

std::shared_ptr<const SurfacePoints> surfaces_of(const GlobalMap& map, float voxel_size) {
  auto surfaces = map.index<SurfacePoints>(
      fmt::format("{}", voxel_size), [&] { return SurfacePoints(map.points(), map.points(), voxel_size); });
  if (surfaces->points.empty()) {
    throw ConfigError("", fmt::format("the map has no surfaces to be found by voxels of {:.2f} m: "
                                      "triangle_ransam needs them",
                                      voxel_size));
  }
  return surfaces;
}

}  // namespace

SurfacePoints::SurfacePoints(const Points& cloud, const Points& some, float voxel_size) {
  const surfels::Surfels surfels = surfels::surfels_of(cloud, voxel_size, std::nullopt);
  const surfels::SurfelContact contact(surfels, voxel_size, false);
  for (std::size_t i = 0; i < some.size(); ++i) {
    const Point p = some[i];
    const std::uint32_t k = contact.nearest(p);
    if (k == surfels::VoxelTable::none) continue;
    const surfels::SurfelContact::Plane& plane = contact.plane(k);
    if (std::abs(dot(plane.normal, p) - plane.distance) > 0.5F * voxel_size) continue;
    points.push_back(p);
    normals.push_back(plane.normal);
  }
}

void describe(ParamVisitor& v, TriangleRansam::Params& p) {
  describe_triples(v, p.triples);
}

TriangleRansam::TriangleRansam(const Params& params, const StageSetup& setup)
    : params_(params.triples),
      upright_(setup.motion == Motion::upright),
      voxel_size_(static_cast<float>(epsilons_per_voxel * setup.epsilon(params_.contact_epsilon))),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params_.contact_epsilon))),
      map_(surfaces_of(*setup.map, voxel_size_)),
      matching_(map_->points, find_relations_in_space, params_, setup.threads) {}

MatchResult TriangleRansam::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  if (local.points.empty()) return {};
  const TripleMatching::Draws draws{rng.next(), rng.next()};
  const QualityTest quality(local.points, contact_, extrapolation_rule(params_), request.omega_max, rng);
  const Points in_view = surfels::points_in_view(local, voxel_size_);
  const SurfacePoints surfaces(in_view, spread_evenly(in_view, voxel_size_), voxel_size_);
  if (surfaces.points.empty()) return {};
  return matching_.match(surfaces.points, diagonal(surfaces.points), local.local_from_robot, draws,
                         [&](const TripleBatch& local_triples, const TripleBatch& map_triples) {
                           return test_hypotheses(surfaces, request.gate, quality, local_triples,
                                                  map_triples);
                         });
}

MatchResult TriangleRansam::test_hypotheses(const SurfacePoints& local, const PoseGate& gate,
                                            const QualityTest& quality, const TripleBatch& local_triples,
                                            const TripleBatch& map_triples) const {
  MatchResult found;
  found.proposals = local_triples.size;
  Points memory;
  for (std::size_t i = 0; i < local_triples.size; ++i) {
    const Triple from = ordered_triple(local.points, local_triples, i);
    const Triple to = ordered_triple(map_->points, map_triples, i);
    const Triangle triangle = triangle_of(local.points, from);
    Pose3 pose = least_squares_motion(triangle, triangle_of(map_->points, to));  // eq. 3
    RigidMotion motion(pose);
    if (!surfaces_agree(motion, normals_of(local.normals, from), normals_of(map_->normals, to))) continue;
    if (upright_) {
      if (!is_about_upright(motion)) continue;
      motion = made_upright(motion, as_point(1.0 / 3.0 * (triangle[0] + triangle[1] + triangle[2])));
      pose = motion.pose();
    }
    if (!gate.allows(pose)) continue;
    const auto start = static_cast<std::uint32_t>(mix64(local_triples.numbers[i]));
    const QualityTest::Judged judged = quality.test(motion, start, memory);
    found.points_tested += judged.points_tested;
    if (judged.quality) found.hypotheses.push_back(Hypothesis::by_contact(pose, *judged.quality));
  }
  return found;
}

}  // namespace glocal::ransam
