#include "matchers/indexed_ransam/indexed_ransam.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "matchers/common/point_pair.hpp"
#include "matchers/common/triple_sampler.hpp"
#include "matchers/grid_search/grid_search.hpp"

namespace glocal {
namespace {

OrientedPointRule oriented_point_rule(const IndexedRansam::Params& p) {
  return {.voxel_size = p.voxel_size, .radius = p.normal_radius};
}

OrientedPairRule pair_rule(const IndexedRansam::Params& p) {
  return {.min_length = p.min_length,
          .max_length = p.max_length,
          .length_cell = p.length_cell,
          .angle_cells = p.angle_cells,
          .max_entries = static_cast<std::size_t>(p.max_entries)};
}

TriangleRule triangle_rule(const IndexedRansam::Params& p) {
  return {.cell = p.length_cell,
          .min_side = p.min_length,
          .min_height = p.min_height,
          .max_side = std::min(p.max_length, largest_side(p.length_cell))};
}

/// What the index depends on, besides the map.
std::string index_key(const IndexedRansam::Params& p) {
  return fmt::format(
      "relation {}, min_oriented_share {}, min_length {}, max_length {}, length_cell {}, angle_cells {}, "
      "min_height {}, max_entries {}, voxel_size {}, normal_radius {}",
      p.relation, p.min_oriented_share, p.min_length, p.max_length, p.length_cell, p.angle_cells,
      p.min_height, p.max_entries, p.voxel_size, p.normal_radius);
}

IndexOrigin index_origin(const IndexedRansam::Params& p, const GlobalMap& map) {
  return {digest_of(map), index_key(p)};
}

RelationIndex read_index(const IndexedRansam::Params& p, const GlobalMap& map) {
  const SavedIndex saved(p.index_file.resolved, index_origin(p, map));
  // Which of the two `auto` has chosen for this map.
  const bool triangles =
      p.relation == "triangle" || (p.relation == "auto" && saved.kind() == TriangleIndex::kind);
  if (triangles) return TriangleIndex(saved);
  return OrientedPairIndex(saved, pair_rule(p));
}

RelationIndex build_index(const IndexedRansam::Params& p, const GlobalMap& map, int threads) {
  const bool triangles =
      p.relation == "triangle" ||
      (p.relation == "auto" && share_of_oriented_points(map, oriented_point_rule(p)) < p.min_oriented_share);
  if (triangles) {
    return TriangleIndex(voxel_downsampled(map.points(), p.voxel_size), triangle_rule(p),
                         static_cast<std::size_t>(p.max_entries), threads);
  }
  return OrientedPairIndex(oriented_points_of(map, oriented_point_rule(p)), pair_rule(p), threads);
}

/// Two points drawn until their distance is in range: in a large local map most pairs are too far apart.
/// Given up after some tries.
OrientedPairIndex::OrientedPair draw_pair(const OrientedPoints& s, double min_length, double max_length,
                                          Rng& rng) {
  constexpr int most_tries = 32;
  const auto n = static_cast<std::uint32_t>(s.size());
  OrientedPairIndex::OrientedPair pair{};
  for (int i = 0; i < most_tries; ++i) {
    pair = {rng.below(n), rng.below(n)};
    const float dx = s.x[pair.second] - s.x[pair.first];
    const float dy = s.y[pair.second] - s.y[pair.first];
    const double squared = dx * dx + dy * dy;
    if (squared >= min_length * min_length && squared < max_length * max_length) break;
  }
  return pair;
}

PointPair ends_of(const OrientedPoints& s, const OrientedPairIndex::OrientedPair& pair) {
  return {Point{s.x[pair.first], s.y[pair.first]}, Point{s.x[pair.second], s.y[pair.second]}};
}

/// Share of the points for which a condition holds where a pose puts them.
template <class Condition>
double share_where(const Points& points, const Pose2& map_from_points, Condition condition) {
  const Transform transform(map_from_points);
  std::size_t count = 0;
  for (std::size_t i = 0; i < points.size(); ++i) count += condition(transform(points[i])) ? 1 : 0;
  return static_cast<double>(count) / static_cast<double>(points.size());
}

}  // namespace

void describe(ParamVisitor& v, IndexedRansam::ExactSearch& p) {
  v.field("after_steps", p.after_steps,
          {.doc = "In the last of so many steps in a row without a clear best pose; 0 never searches.",
           .min = 0});
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

void describe(ParamVisitor& v, AdaptiveBudget& p) {
  v.field("limit", p.limit,
          {.doc = "Oriented point pairs drawn in a step at most; 0 draws as many as iterations and "
                  "first_iterations say.",
           .min = 0,
           .max = 10e6});
  v.field(
      "chunk", p.chunk,
      {.doc = "Oriented point pairs drawn between looks at the best distinct poses.", .min = 1, .max = 10e6});
  v.field("stable_candidates", p.stable_candidates,
          {.doc = "So many of the best must stay the same …", .min = 1});
  v.field("stable_chunks", p.stable_chunks, {.doc = "… over so many chunks in a row.", .min = 1});
}

void describe(ParamVisitor& v, IndexedRansam::Params& p) {
  v.field("iterations", p.iterations,
          {.doc = "Oriented point pairs or triangles drawn from the local map in a step.",
           .min = 0,
           .max = 10e6});
  v.field("first_iterations", p.first_iterations,
          {.doc = "The same in the first steps, when nothing is carried yet.", .min = 0, .max = 10e6});
  v.field("first_steps", p.first_steps, {.doc = "How many steps those are.", .min = 0});
  v.field("adaptive", p.adaptive, {.doc = "Draw until the best poses stay the same."});
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
  v.field("candidates", p.candidates,
          {.doc = "Distinct poses that are refined and judged.", .min = 1, .max = 10000});
  v.field("best", p.best, {.doc = "Of these, the best that become hypotheses.", .min = 1, .max = 10000});
  v.field("carried", p.carried,
          {.doc = "Of those, the best that go on to the next step.", .min = 0, .max = 10000});
  describe(v, p.candidate);
  v.field("refinement", p.refinement, {.doc = "How poses are refined on the distance field."});
  v.field("uncertainty", p.uncertainty, {.doc = "What the covariance of a hypothesis is made from."});
  v.field("field_cell", p.field_cell,
          {.doc = "Side of a cell of the distance field.", .unit = "m", .min = 0.01, .max = 1.0});
  describe(v, p.beams);
  v.field("unknown_weight", p.unknown_weight,
          {.doc = "What the share of points in unknown cells adds to the quality.", .min = 0.0, .max = 1.0});
  v.field("min_length", p.min_length,
          {.doc = "Shortest oriented point pair, or side of a triangle.", .unit = "m", .above = 0.0});
  v.field("max_length", p.max_length,
          {.doc = "Longest oriented point pair, or side of a triangle.",
           .unit = "m",
           .max = 100.0,
           .above = 0.0});
  v.require(p.max_length > p.min_length, "max_length", "must be above min_length");
  v.field("length_cell", p.length_cell,
          {.doc = "Oriented point pairs in a bin, or sides of triangles, differ in length by less.",
           .unit = "m",
           .min = 0.01});
  v.field(
      "angle_cells", p.angle_cells,
      {.doc = "Bins of each of an oriented point pair's two angles in a full turn.", .min = 4, .max = 360});
  constexpr double most_bins = 16e6;
  v.require((p.max_length - p.min_length) / p.length_cell * p.angle_cells * p.angle_cells <= most_bins,
            "length_cell",
            "must be larger, or angle_cells smaller: there would be more than 16 million bins");
  v.field("relation", p.relation,
          {.doc = "What is drawn and sorted: two points with their normals, three points, or three where few "
                  "have normals.",
           .choices = {"oriented_pair", "triangle", "auto"}});
  v.field("min_oriented_share", p.min_oriented_share,
          {.doc = "Share of the map's points that have a normal, below which auto takes triangles.",
           .min = 0.0,
           .max = 1.0});
  v.field("min_height", p.min_height,
          {.doc = "Flatter triangles give poor poses: the height over the longest side.",
           .unit = "m",
           .min = 0.0});
  v.field(
      "max_entries", p.max_entries,
      {.doc =
           "Of more oriented point pairs (8 bytes each) or triangles (12 to 20 bytes) an even share is kept.",
       .min = 1000,
       .max = 100e6});
  v.field("voxel_size", p.voxel_size,
          {.doc = "The map gives one point to oriented point pairs in each square of this side.",
           .unit = "m",
           .min = 0.01});
  v.field("normal_radius", p.normal_radius,
          {.doc = "Neighbourhood that gives a point's normal; at most twice the voxel_size.",
           .unit = "m",
           .above = 0.0});
  v.require(p.normal_radius <= 2.0 * p.voxel_size, "normal_radius", "must be at most twice the voxel_size");
  v.field("index_file", p.index_file,
          {.doc = "Index of the map as glocal map index saves it, to be read instead of built.",
           .may_be_missing = true});
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
      field_(distance_field(*setup.map, params.field_cell)),
      refiner_(params.candidate, static_cast<std::size_t>(params.candidates), params.refinement, field_,
               contact_),
      clearance_(clearance_grid(*setup.map)),
      pyramid_(params.exact_search.after_steps > 0
                   ? contact_pyramid(*setup.map, params.exact_search.cell, params.contact_epsilon)
                   : nullptr),
      beams_(params.beams) {
  const auto start = std::chrono::steady_clock::now();
  const bool is_saved = !params.index_file.text.empty();
  index_ =
      setup.map->index<RelationIndex>(params.index_file.resolved.string() + ": " + index_key(params), [&] {
        return is_saved ? read_index(params, *setup.map) : build_index(params, *setup.map, setup.threads);
      });
  const std::chrono::duration<double, std::milli> time = std::chrono::steady_clock::now() - start;
  map_index_ = std::visit(
      [&](const auto& index) {
        return MapIndexInfo{index.size(), index.memory_bytes(), time.count()};
      },
      *index_);
  if (is_saved) setup.note_input(params.index_file.resolved);
}

std::string IndexedRansam::saved_index() const {
  return std::visit([&](const auto& index) { return index.saved(index_origin(params_, *map_)); }, *index_);
}

void IndexedRansam::reset() {
  beams_.clear();
  carried_.clear();
  epoch_ = 0;
  steps_ = 0;
  undecided_ = 0;
}

MatchResult IndexedRansam::match(const LocalMap& local, const Observation& latest, double omega_max,
                                 Rng& rng) {
  MatchResult result;
  if (local.points.empty()) return result;
  if (local.epoch != epoch_) reset();
  epoch_ = local.epoch;
  beams_.add(local, latest.scan);

  const Points sample = sample_of(local.points, static_cast<std::size_t>(params_.contact_points), rng);
  std::vector<Candidate> candidates;
  for (const Candidate& candidate : carried_) {
    candidates.push_back(
        {candidate.map_from_local, contact_->share(sample, Transform(candidate.map_from_local))});
  }
  const LocalPoints points = points_to_draw(local);
  if (params_.adaptive.limit > 0) {
    draw_until_stable(points, sample, local.local_from_robot, rng, candidates, result);
  } else {
    const int draws = steps_++ < params_.first_steps ? params_.first_iterations : params_.iterations;
    draw(points, sample, static_cast<std::size_t>(draws), rng, candidates, result);
  }
  std::vector<Candidate> best = settled(candidates, local, sample, result);
  undecided_ = is_clear(best) ? 0 : undecided_ + 1;
  if (pyramid_ && undecided_ >= params_.exact_search.after_steps) {
    search_exactly(sample, local.local_from_robot, candidates, result);
    best = settled(candidates, local, sample, result);
    undecided_ = 0;
  }
  carried_ = {best.begin(), best.begin() + std::min(std::ssize(best), std::ptrdiff_t{params_.carried})};
  for (const Candidate& candidate : best) {
    if (candidate.quality < omega_max) break;
    result.hypotheses.push_back(hypothesis(candidate, local, sample));
  }
  return result;
}

/// The best of the candidates, refined; `candidates` keeps the distinct ones.
std::vector<Candidate> IndexedRansam::settled(std::vector<Candidate>& candidates, const LocalMap& local,
                                              const Points& sample, MatchResult& result) const {
  candidates = refiner_.refined(std::move(candidates), local.local_from_robot, sample, sample);
  result.points_tested += candidates.size() * local.points.size();
  return judged(candidates, local, sample);
}

bool IndexedRansam::is_clear(const std::vector<Candidate>& best) const {
  if (best.empty()) return false;
  return best.size() == 1 || best[0].quality - best[1].quality >= params_.exact_search.margin;
}

Hypothesis IndexedRansam::hypothesis(const Candidate& candidate, const LocalMap& local,
                                     const Points& sample) const {
  const Pose2 map_from_robot = candidate.map_from_local * local.local_from_robot;
  return {.map_from_local = candidate.map_from_local,
          .quality = contact_->share(local.points, Transform(candidate.map_from_local)),
          .score = std::min(candidate.quality, 1.0),
          .covariance = pose_covariance(*field_, sample, candidate.map_from_local, map_from_robot,
                                        params_.refinement.kernel, params_.uncertainty),
          .free_space_violation = free_space_violation(sample, candidate.map_from_local)};
}

/// Oriented point pairs are drawn from oriented points, triangles from points.
IndexedRansam::LocalPoints IndexedRansam::points_to_draw(const LocalMap& local) const {
  if (std::holds_alternative<TriangleIndex>(*index_))
    return voxel_downsampled(local.points, params_.voxel_size);
  return oriented_points_of(local, oriented_point_rule(params_));
}

void IndexedRansam::draw(const LocalPoints& points, const Points& sample, std::size_t draws, Rng& rng,
                         std::vector<Candidate>& candidates, MatchResult& result) const {
  if (const auto* triangles = std::get_if<TriangleIndex>(index_.get())) {
    draw_triangles(*triangles, std::get<Points>(points), sample, draws, rng, candidates, result);
  } else {
    draw_pairs(std::get<OrientedPairIndex>(*index_), std::get<OrientedPoints>(points), sample, draws, rng,
               candidates, result);
  }
}

void IndexedRansam::draw_pairs(const OrientedPairIndex& index, const OrientedPoints& oriented_points,
                               const Points& sample, std::size_t draws, Rng& rng,
                               std::vector<Candidate>& candidates, MatchResult& result) const {
  const auto n = static_cast<std::uint32_t>(oriented_points.size());
  if (n < 2) return;
  MotionBatch motions;
  std::size_t size = 0;
  for (std::size_t i = 0; i < draws; ++i) {
    const OrientedPairIndex::OrientedPair pair =
        draw_pair(oriented_points, params_.min_length, params_.max_length, rng);
    const auto partners = index.find(oriented_points, pair);
    if (partners.empty()) continue;
    const OrientedPairIndex::OrientedPair& partner =
        partners[rng.below(static_cast<std::uint32_t>(partners.size()))];
    lay(ends_of(oriented_points, pair), ends_of(index.oriented_points(), partner), motions, size++);
    if (size < MotionBatch::capacity) continue;
    test(motions, size, sample, candidates, result);
    size = 0;
  }
  test(motions, size, sample, candidates, result);
}

/// A candidate that fresh draws make better stays the same one; another one among the best begins the count
/// anew.
void IndexedRansam::draw_until_stable(const LocalPoints& points, const Points& sample,
                                      const Pose2& local_from_robot, Rng& rng,
                                      std::vector<Candidate>& candidates, MatchResult& result) const {
  const AdaptiveBudget& budget = params_.adaptive;
  const auto best_of = [&] {
    std::vector<Pose2> robots;
    for (std::size_t i = 0;
         i < std::min(candidates.size(), static_cast<std::size_t>(budget.stable_candidates)); ++i)
      robots.push_back(candidates[i].map_from_local * local_from_robot);
    return robots;
  };
  candidates = refiner_.distinct(std::move(candidates), local_from_robot);
  std::vector<Pose2> before = best_of();
  for (int drawn = 0, stable = 0; drawn < budget.limit && stable < budget.stable_chunks;) {
    const int draws = std::min(budget.chunk, budget.limit - drawn);
    draw(points, sample, static_cast<std::size_t>(draws), rng, candidates, result);
    drawn += draws;
    candidates = refiner_.distinct(std::move(candidates), local_from_robot);
    const std::vector<Pose2> best = best_of();
    const auto was_there = [&](const Pose2& robot) {
      return std::any_of(before.begin(), before.end(), [&](const Pose2& other) {
        return is_same_candidate(robot, other, params_.candidate);
      });
    };
    const bool same =
        !best.empty() && best.size() == before.size() && std::all_of(best.begin(), best.end(), was_there);
    stable = same ? stable + 1 : 0;
    before = best;
  }
}

/// The second and third point near the first, as in the map's triangles: farther ones would have no partner.
void IndexedRansam::draw_triangles(const TriangleIndex& index, const Points& points, const Points& sample,
                                   std::size_t draws, Rng& rng, std::vector<Candidate>& candidates,
                                   MatchResult& result) const {
  const TriangleRule rule = triangle_rule(params_);
  const TripleSampler sampler(points, rule.max_side);
  const std::uint64_t seed = rng.next();
  RelationBatch relations;
  TripleBatch drawn;
  TripleBatch from;
  TripleBatch to;
  MotionBatch motions;
  for (std::size_t begin = 0; begin < draws; begin += TripleBatch::capacity) {
    drawn.clear();
    for (std::size_t i = begin; i < std::min(draws, begin + TripleBatch::capacity); ++i) {
      drawn.add_number(static_cast<std::uint32_t>(i));
    }
    sampler.draw(seed, drawn);
    relations.size = 0;
    find_relations(points, drawn, rule, false, relations);
    from.clear();
    to.clear();
    for (std::size_t i = 0; i < relations.size; ++i) {
      const auto partners = index.find(relations.relations[i]);
      if (partners.empty()) continue;
      const std::size_t n = relations.numbers[i] - begin;
      from.add({drawn.first[n], drawn.second[n], drawn.third[n]});
      to.add(partners[rng.below(static_cast<std::uint32_t>(partners.size()))]);
    }
    least_squares_motions(points, from, index.points(), to, motions);
    test(motions, from.size, sample, candidates, result);
  }
}

void IndexedRansam::test(const MotionBatch& motions, std::size_t size, const Points& sample,
                         std::vector<Candidate>& candidates, MatchResult& result) const {
  // A cheap look at 16 points spares most wrong poses the closer one. To ask for contact of one more point
  // instead, as Winkelbach et al. do, is no faster and loses more poses; both is slower than this alone
  // (bench_indexed, look).
  constexpr std::size_t first_look = 16;
  const std::size_t looked_at = std::min(first_look, sample.size());
  ContactIndex::BatchColumn begins{};
  ContactIndex::BatchColumn at_most{};
  contact_->count_at_most(sample, looked_at, motions, size, begins, at_most);
  result.proposals += size;
  for (std::size_t i = 0; i < size; ++i) {
    // Even the coarse look is below what is asked for.
    if (static_cast<double>(at_most[i]) < params_.min_contact * static_cast<double>(looked_at)) {
      result.points_tested += looked_at;
      continue;
    }
    result.points_tested += sample.size();
    const double share = contact_->share(sample, motions[i]);
    if (share >= params_.min_contact) candidates.push_back({motions[i].pose(), share});
  }
}

/// Adds the best poses of the whole map, where draws did not settle the matter.
void IndexedRansam::search_exactly(const Points& sample, const Pose2& local_from_robot,
                                   std::vector<Candidate>& candidates, MatchResult& result) const {
  const GridSearchResult found =
      search_grid(*pyramid_, sample, local_from_robot,
                  {.min_quality = params_.min_contact,
                   .min_rotation_step = params_.exact_search.min_rotation_step,
                   .distance = params_.candidate.distance,
                   .rotation = params_.candidate.rotation,
                   .max_poses = static_cast<std::size_t>(params_.exact_search.max_poses)},
                  threads_);
  for (const GridSearchResult::Pose& pose : found.poses) {
    candidates.push_back({pose.map_from_local, contact_->share(sample, Transform(pose.map_from_local))});
  }
  result.proposals += found.tested;
  result.points_tested += found.points_tested;
}

double IndexedRansam::free_space_violation(const Points& sample, const Pose2& map_from_local) const {
  return share_where(sample, map_from_local, [&](const Point& p) {
    return map_->grid().at(p.x, p.y) == Cell::free && field_->at(p.x, p.y).distance > params_.contact_epsilon;
  });
}

double IndexedRansam::unknown_share(const Points& sample, const Pose2& map_from_local) const {
  if (params_.unknown_weight == 0.0) return 0.0;
  return share_where(sample, map_from_local,
                     [&](const Point& p) { return map_->grid().at(p.x, p.y) == Cell::unknown; });
}

/// The best candidates by their quality, which falls. Beams take most of the time, and only take quality off:
/// candidates are looked at in the order of what they could reach, until no other one can be among the best.
std::vector<Candidate> IndexedRansam::judged(const std::vector<Candidate>& candidates, const LocalMap& local,
                                             const Points& sample) const {
  const auto better = [](const Candidate& a, const Candidate& b) { return a.quality > b.quality; };
  std::vector<Candidate> at_most;
  for (const Candidate& candidate : candidates) {
    at_most.push_back({candidate.map_from_local,
                       contact_->share(local.points, Transform(candidate.map_from_local)) +
                           params_.unknown_weight * unknown_share(sample, candidate.map_from_local)});
  }
  std::stable_sort(at_most.begin(), at_most.end(), better);
  const auto most = static_cast<std::size_t>(params_.best);
  std::vector<Candidate> best;
  for (const Candidate& candidate : at_most) {
    if (best.size() == most && best.back().quality >= candidate.quality) break;
    const Candidate now{candidate.map_from_local,
                        candidate.quality - beams_.penalty(*clearance_, candidate.map_from_local)};
    best.insert(std::upper_bound(best.begin(), best.end(), now, better), now);
    if (best.size() > most) best.pop_back();
  }
  return best;
}

}  // namespace glocal
