#include "matchers/indexed_ransam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "matchers/grid_search.hpp"

namespace glocal {
namespace {

SurfaceRule surface_rule(const IndexedRansam::Params& p) {
  return {.thinning = p.thinning, .radius = p.normal_radius};
}

DipoleRule dipole_rule(const IndexedRansam::Params& p) {
  return {.min_length = p.min_length,
          .max_length = p.max_length,
          .length_cell = p.length_cell,
          .angle_cells = p.angle_cells,
          .max_entries = static_cast<std::size_t>(p.max_entries)};
}

/// What the index depends on, besides the map.
std::string index_key(const IndexedRansam::Params& p) {
  return fmt::format("{} {} {} {} {} {} {}", p.min_length, p.max_length, p.length_cell, p.angle_cells,
                     p.max_entries, p.thinning, p.normal_radius);
}

/// Two points drawn until their distance is in range: in a large local map most pairs are too far apart.
/// Given up after some tries.
DipoleIndex::Dipole draw_dipole(const Surfaces& s, double min_length, double max_length, Rng& rng) {
  constexpr int most_tries = 32;
  const auto n = static_cast<std::uint32_t>(s.size());
  DipoleIndex::Dipole dipole{};
  for (int i = 0; i < most_tries; ++i) {
    dipole = {rng.below(n), rng.below(n)};
    const float dx = s.x[dipole.second] - s.x[dipole.first];
    const float dy = s.y[dipole.second] - s.y[dipole.first];
    const double squared = dx * dx + dy * dy;
    if (squared >= min_length * min_length && squared < max_length * max_length) break;
  }
  return dipole;
}

/// The motion that lays one dipole on another, middle on middle.
void lay(const Surfaces& local, const DipoleIndex::Dipole& from, const Surfaces& map,
         const DipoleIndex::Dipole& to, MotionBatch& motions, std::size_t i) {
  const float ux = local.x[from.second] - local.x[from.first];
  const float uy = local.y[from.second] - local.y[from.first];
  const float vx = map.x[to.second] - map.x[to.first];
  const float vy = map.y[to.second] - map.y[to.first];
  const float lengths = std::sqrt((ux * ux + uy * uy) * (vx * vx + vy * vy));
  const float c = (ux * vx + uy * vy) / lengths;
  const float s = (ux * vy - uy * vx) / lengths;
  const float mx = 0.5F * (local.x[from.first] + local.x[from.second]);
  const float my = 0.5F * (local.y[from.first] + local.y[from.second]);
  motions.cosine[i] = c;
  motions.sine[i] = s;
  motions.x[i] = 0.5F * (map.x[to.first] + map.x[to.second]) - (c * mx - s * my);
  motions.y[i] = 0.5F * (map.y[to.first] + map.y[to.second]) - (s * mx + c * my);
}

}  // namespace

void describe(ParamVisitor& v, IndexedRansam::ExactSearch& p) {
  v.field("after_steps", p.after_steps,
          {.doc = "After so many steps in a row without a clear best pose; 0 never searches.", .min = 0});
  v.field("margin", p.margin,
          {.doc = "A best pose is clear if no other is within this of its quality.", .min = 0.0, .max = 1.0});
  v.field("cell", p.cell,
          {.doc = "Translations are multiples of this; at most contact_epsilon.",
           .unit = "m",
           .min = 0.01,
           .max = 1.0});
  v.field("min_rotation_step", p.min_rotation_step,
          {.doc = "Rotations differ by what moves the farthest point by one cell, but by this at least.",
           .unit = "rad",
           .min = 0.0001,
           .max = 0.1});
  v.field("max_poses", p.max_poses, {.doc = "Poses it adds at most.", .min = 1, .max = 10000});
}

void describe(ParamVisitor& v, IndexedRansam::Params& p) {
  v.field("iterations", p.iterations,
          {.doc = "Dipoles drawn from the local map in a step.", .min = 0, .max = 10e6});
  v.field("first_iterations", p.first_iterations,
          {.doc = "The same in the first steps, when nothing is carried yet.", .min = 0, .max = 10e6});
  v.field("first_steps", p.first_steps, {.doc = "How many steps those are.", .min = 0});
  v.field("contact_epsilon", p.contact_epsilon,
          {.doc = "Distance at which a point is in contact with the map (epsilon of eq. 4).",
           .unit = "m",
           .above = 0.0});
  v.field("min_contact", p.min_contact,
          {.doc = "Contact a pose needs before it is refined: the right one may have little then.",
           .min = 0.0,
           .max = 1.0});
  v.field("contact_points", p.contact_points,
          {.doc = "Points looked at for that.", .min = 16, .max = 100000});
  v.field("modes", p.modes, {.doc = "Distinct poses that are refined and judged.", .min = 1, .max = 10000});
  v.field("best", p.best, {.doc = "Of these, the best that become hypotheses.", .min = 1, .max = 10000});
  v.field("carried", p.carried,
          {.doc = "Of those, the best that go on to the next step.", .min = 0, .max = 10000});
  v.field("mode_distance", p.mode_distance,
          {.doc = "Robot poses nearer to each other are one mode.", .unit = "m", .above = 0.0});
  v.field("mode_rotation", p.mode_rotation,
          {.doc = "… if they are turned by less.", .unit = "rad", .above = 0.0});
  v.field("refinement_points", p.refinement_points, {.doc = "Points used to refine a pose.", .min = 3});
  v.field("refinement", p.refinement, {.doc = "How poses are refined on the distance field."});
  v.field("field_cell", p.field_cell,
          {.doc = "Side of a cell of the distance field.", .unit = "m", .min = 0.01, .max = 1.0});
  v.field("blocked_weight", p.blocked_weight,
          {.doc = "What the share of beams through occupied cells takes off the quality.", .min = 0.0});
  v.field("unknown_weight", p.unknown_weight,
          {.doc = "What the share of points in unknown cells adds to it.", .min = 0.0, .max = 1.0});
  v.field("beam_scans", p.beam_scans,
          {.doc = "Latest scans whose beams are looked at.", .min = 1, .max = 1000});
  v.field("beams", p.beams, {.doc = "Beams of each.", .min = 1, .max = 10000});
  v.field("beam_margin", p.beam_margin,
          {.doc = "Before its hit a beam may touch occupied cells for this far.", .unit = "m", .min = 0.0});
  v.field("min_length", p.min_length, {.doc = "Shortest dipole.", .unit = "m", .above = 0.0});
  v.field("max_length", p.max_length, {.doc = "Longest dipole.", .unit = "m", .max = 100.0, .above = 0.0});
  v.require(p.max_length > p.min_length, "max_length", "must be above min_length");
  v.field("length_cell", p.length_cell,
          {.doc = "Dipoles in a bin differ in length by less.", .unit = "m", .min = 0.01});
  v.field("angle_cells", p.angle_cells,
          {.doc = "Bins of each of a dipole's two angles in a full turn.", .min = 4, .max = 360});
  v.field("max_entries", p.max_entries,
          {.doc = "Of more dipoles an even share is kept; each takes 8 bytes.", .min = 1000, .max = 100e6});
  v.field(
      "thinning", p.thinning,
      {.doc = "The map gives one point to dipoles in each square of this side.", .unit = "m", .min = 0.01});
  v.field("normal_radius", p.normal_radius,
          {.doc = "Neighbourhood that gives a point's normal; at most twice the thinning.",
           .unit = "m",
           .above = 0.0});
  v.require(p.normal_radius <= 2.0 * p.thinning, "normal_radius", "must be at most twice the thinning");
  v.field("exact_search", p.exact_search,
          {.doc = "When an exact search of the whole map, as branch_and_bound makes it, adds its poses."});
  v.require(p.exact_search.after_steps == 0 || p.exact_search.cell <= p.contact_epsilon, "exact_search",
            "cell must be at most contact_epsilon");
}

IndexedRansam::IndexedRansam(const Params& params, const StageSetup& setup)
    : params_(params),
      threads_(setup.threads),
      map_(setup.map),
      contact_(contact_index(*setup.map, "bitset", params.contact_epsilon)),
      index_(setup.map->index<DipoleIndex>(
          index_key(params),
          [&] { return DipoleIndex(surfaces_of(*setup.map, surface_rule(params)), dipole_rule(params)); })),
      field_(setup.map->index<DistanceField>(
          fmt::format("{}", params.field_cell),
          [&] { return DistanceField(setup.map->points(), params.field_cell); })),
      clearance_(setup.map->index<ClearanceGrid>("", [&] { return ClearanceGrid(setup.map->grid()); })),
      pyramid_(params.exact_search.after_steps > 0
                   ? contact_pyramid(*setup.map, params.exact_search.cell, params.contact_epsilon)
                   : nullptr),
      beams_({.scans = params.beam_scans, .beams = params.beams, .margin = params.beam_margin}) {}

void IndexedRansam::reset() {
  beams_.clear();
  carried_.clear();
  generation_ = 0;
  steps_ = 0;
  undecided_ = 0;
}

MatchResult IndexedRansam::match(const LocalMap& local, const Observation& latest, double omega_max,
                                 Rng& rng) {
  MatchResult result;
  if (local.points.empty()) return result;
  if (local.generation != generation_) reset();
  generation_ = local.generation;
  beams_.add(local, latest.scan);

  const Points sample = sample_of(local.points, static_cast<std::size_t>(params_.contact_points), rng);
  std::vector<Mode> modes;
  for (const Mode& mode : carried_) {
    modes.push_back({mode.map_from_local, contact_->share(sample, Transform(mode.map_from_local))});
  }
  const int draws = steps_++ < params_.first_steps ? params_.first_iterations : params_.iterations;
  draw(surfaces_of(local, surface_rule(params_)), sample, static_cast<std::size_t>(draws), rng, modes,
       result);
  if (pyramid_ && undecided_ >= params_.exact_search.after_steps) {
    search_exactly(sample, local.local_from_robot, modes, result);
    undecided_ = 0;
  }

  modes = distinct(std::move(modes), local.local_from_robot);
  const Points anchors = first_of(sample, static_cast<std::size_t>(params_.refinement_points));
  for (Mode& mode : modes) {
    mode.map_from_local = refined_pose(*field_, anchors, mode.map_from_local, params_.refinement);
    mode.quality = contact_->share(sample, Transform(mode.map_from_local));
  }
  modes = distinct(std::move(modes), local.local_from_robot);  // some have become one
  const std::vector<Mode> best = judged(modes, local, sample);
  const bool clear =
      !best.empty() && (best.size() == 1 || best[0].quality - best[1].quality >= params_.exact_search.margin);
  undecided_ = clear ? 0 : undecided_ + 1;
  carried_ = {best.begin(), best.begin() + std::min(std::ssize(best), std::ptrdiff_t{params_.carried})};
  result.checks += modes.size() * local.points.size();
  for (const Mode& mode : best) {
    if (mode.quality < omega_max) break;
    result.hypotheses.push_back(
        {mode.map_from_local, mode.map_from_local * local.local_from_robot, std::min(mode.quality, 1.0)});
  }
  return result;
}

void IndexedRansam::draw(const Surfaces& surfaces, const Points& sample, std::size_t draws, Rng& rng,
                         std::vector<Mode>& modes, MatchResult& result) const {
  const auto n = static_cast<std::uint32_t>(surfaces.size());
  if (n < 2) return;
  MotionBatch motions;
  std::size_t size = 0;
  for (std::size_t i = 0; i < draws; ++i) {
    const DipoleIndex::Dipole dipole = draw_dipole(surfaces, params_.min_length, params_.max_length, rng);
    const auto partners = index_->find(surfaces, dipole);
    if (partners.empty()) continue;
    const DipoleIndex::Dipole& partner = partners[rng.below(static_cast<std::uint32_t>(partners.size()))];
    lay(surfaces, dipole, index_->surfaces(), partner, motions, size++);
    if (size < MotionBatch::capacity) continue;
    test(motions, size, sample, modes, result);
    size = 0;
  }
  test(motions, size, sample, modes, result);
}

void IndexedRansam::test(const MotionBatch& motions, std::size_t size, const Points& sample,
                         std::vector<Mode>& modes, MatchResult& result) const {
  constexpr std::size_t first_look = 16;
  const std::size_t looked_at = std::min(first_look, sample.size());
  ContactIndex::BatchColumn begins{};
  ContactIndex::BatchColumn at_most{};
  contact_->count_at_most(sample, looked_at, motions, size, begins, at_most);
  result.collisions += size;
  for (std::size_t i = 0; i < size; ++i) {
    // Even the coarse look is below what is asked for.
    if (static_cast<double>(at_most[i]) < params_.min_contact * static_cast<double>(looked_at)) {
      result.checks += looked_at;
      continue;
    }
    result.checks += sample.size();
    const double share = contact_->share(sample, motions[i]);
    if (share >= params_.min_contact) modes.push_back({motions[i].pose(), share});
  }
}

/// Adds the best poses of the whole map, where draws did not settle the matter.
void IndexedRansam::search_exactly(const Points& sample, const Pose2& local_from_robot,
                                   std::vector<Mode>& modes, MatchResult& result) const {
  const GridSearchResult found =
      search_grid(*pyramid_, sample, local_from_robot,
                  {.min_quality = params_.min_contact,
                   .min_rotation_step = params_.exact_search.min_rotation_step,
                   .distance = params_.mode_distance,
                   .rotation = params_.mode_rotation,
                   .max_poses = static_cast<std::size_t>(params_.exact_search.max_poses)},
                  threads_);
  for (const GridSearchResult::Pose& pose : found.poses) {
    modes.push_back({pose.map_from_local, contact_->share(sample, Transform(pose.map_from_local))});
  }
  result.collisions += found.tested;
  result.checks += found.checks;
}

std::vector<Mode> IndexedRansam::distinct(std::vector<Mode> modes, const Pose2& local_from_robot) const {
  return distinct_modes(std::move(modes), local_from_robot, {params_.mode_distance, params_.mode_rotation},
                        static_cast<std::size_t>(params_.modes));
}

double IndexedRansam::unknown_share(const Points& sample, const Pose2& map_from_local) const {
  if (params_.unknown_weight == 0.0) return 0.0;
  const Transform transform(map_from_local);
  std::size_t unknown = 0;
  for (std::size_t i = 0; i < sample.size(); ++i) {
    const Point p = transform(sample[i]);
    if (map_->grid().at(p.x, p.y) == Cell::unknown) ++unknown;
  }
  return static_cast<double>(unknown) / static_cast<double>(sample.size());
}

/// The best modes by their quality, which falls. Beams take most of the time, and only take quality off:
/// modes are looked at in the order of what they could reach, until no other one can be among the best.
std::vector<Mode> IndexedRansam::judged(const std::vector<Mode>& modes, const LocalMap& local,
                                        const Points& sample) const {
  const auto better = [](const Mode& a, const Mode& b) { return a.quality > b.quality; };
  std::vector<Mode> at_most;
  for (const Mode& mode : modes) {
    at_most.push_back(
        {mode.map_from_local, contact_->share(local.points, Transform(mode.map_from_local)) +
                                  params_.unknown_weight * unknown_share(sample, mode.map_from_local)});
  }
  std::stable_sort(at_most.begin(), at_most.end(), better);
  const auto most = static_cast<std::size_t>(params_.best);
  std::vector<Mode> best;
  for (const Mode& mode : at_most) {
    if (best.size() == most && best.back().quality >= mode.quality) break;
    const double blocked = beams_.blocked_share(*clearance_, mode.map_from_local);
    const Mode now{mode.map_from_local, mode.quality - params_.blocked_weight * blocked};
    best.insert(std::upper_bound(best.begin(), best.end(), now, better), now);
    if (best.size() > most) best.pop_back();
  }
  return best;
}

}  // namespace glocal
