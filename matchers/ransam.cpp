#include "matchers/ransam.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "glocal/parallel.hpp"

namespace glocal {
namespace {

/// Draws handled together by one thread. Fixed, so that the answer does not depend on the number of threads.
constexpr std::size_t draws_per_chunk = 8192;
/// Triangles computed before their slots are touched, so that the memory has time to answer the prefetches.
constexpr std::size_t draws_in_flight = 64;

unsigned table_bits(const Ransam::Params& p) {
  if (p.table_bits > 0) return static_cast<unsigned>(p.table_bits);
  // Four slots a draw: about one entry in ten is lost to another relation in its slot.
  return static_cast<unsigned>(std::bit_width(static_cast<unsigned>(p.iterations) * 4U - 1U));
}

/// Canonical triangles of the draws [begin, end), a few dozen at a time: `prepare(relation)` for each as soon
/// as it is known, then `use(triangle, draw)` for each of the same few dozen.
template <class Prepare, class Use>
void for_each_triangle(const TripleSampler& sampler, const Points& points, const TriangleRule& rule,
                       std::uint64_t seed, std::size_t begin, std::size_t end, Prepare prepare, Use use) {
  struct Pending {
    CanonicalTriangle triangle;
    std::size_t draw;
  };
  std::array<Pending, draws_in_flight> pending;
  while (begin < end) {
    const std::size_t stop = std::min(begin + draws_in_flight, end);
    std::size_t n = 0;
    for (std::size_t draw = begin; draw < stop; ++draw) {
      const std::optional<Triple> triple = sampler.draw(seed, draw);
      if (!triple) continue;
      const auto triangle = canonical_triangle(points, *triple, rule);
      if (!triangle) continue;
      prepare(triangle->relation);
      pending[n++] = {*triangle, draw};
    }
    for (std::size_t i = 0; i < n; ++i) use(pending[i].triangle, pending[i].draw);
    begin = stop;
  }
}

double diameter_bound(const Points& points) {
  const auto extent = [](const std::vector<float>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    return static_cast<double>(*high) - static_cast<double>(*low);
  };
  return std::hypot(extent(points.x), extent(points.y));
}

}  // namespace

void describe(ParamVisitor& v, Ransam::Params& p) {
  v.field("iterations", p.iterations,
          {.doc = "Triples drawn from each of the two maps in a step.", .min = 1, .max = 100e6});
  v.field("contact_epsilon", p.contact_epsilon,
          {.doc = "Distance at which a point is in contact with the map (epsilon of eq. 4): 0.06 m for a map "
                  "of 3 cm, 0.10 m "
                  "for real maps of 5 cm.",
           .unit = "m",
           .above = 0.0});
  v.field("relation_cell", p.relation_cell,
          {.doc = "Side lengths are quantised to this; equal triples are relations in common.",
           .unit = "m",
           .above = 0.0});
  v.field("min_side", p.min_side,
          {.doc = "Triples with a shorter side give poor poses and are skipped.", .unit = "m", .min = 0.0});
  v.field(
      "min_height", p.min_height,
      {.doc = "So are flat ones, whose third point is nearer to the longest side.", .unit = "m", .min = 0.0});
  v.field("local_radius", p.local_radius,
          {.doc = "Draw the second and third point within this distance of the first, on both sides: many "
                  "more correct "
                  "collisions. 0 draws from all points, as the paper does.",
           .unit = "m",
           .min = 0.0});
  v.field(
      "extrapolation_batch", p.extrapolation_batch,
      {.doc = "Points looked at before the bound on a hypothesis's quality is computed again (k of eq. 5).",
       .min = 1});
  v.field("extrapolation_z", p.extrapolation_z,
          {.doc = "Half width of the bound's interval in standard deviations (1.96 is the paper's 95 %).",
           .min = 0.0});
  v.field("table_bits", p.table_bits,
          {.doc = "The hash table has 2^this slots of 8 bytes; 0 chooses four slots a draw.",
           .min = 0,
           .max = 30});
}

Ransam::Ransam(const Params& params, const StageSetup& setup)
    : params_(params),
      setup_(setup),
      contact_(ContactGrid::of(*setup.map, params.contact_epsilon)),
      sampler_(setup.map->points(), params.local_radius),
      rule_{.cell = params.relation_cell, .min_side = params.min_side, .min_height = params.min_height},
      table_(table_bits(params)),
      map_triples_(static_cast<std::size_t>(params.iterations)) {}

MatchResult Ransam::match(const LocalMap& local, const Observation& /*latest*/, double omega_max, Rng& rng) {
  if (local.points.empty()) return {};
  const std::uint64_t map_seed = rng.next();
  const std::uint64_t local_seed = rng.next();
  const QualityTest quality(local.points, contact_, {params_.extrapolation_batch, params_.extrapolation_z},
                            rng);

  // A triangle of the map that is larger than the whole local map has no partner there.
  rule_.max_side =
      std::min(diameter_bound(local.points) + rule_.cell, rule_.cell * (1U << relation_side_bits));
  draw_map_triples(map_seed);

  const TripleSampler local_sampler(local.points, params_.local_radius);
  std::vector<Chunk> chunks(chunk_count());
  parallel_for(setup_.threads, chunks.size(), [&](std::size_t i) {
    chunks[i] = match_local_triples(local, local_sampler, quality, local_seed, omega_max, i);
  });

  MatchResult result;
  for (const Chunk& chunk : chunks) {
    result.hypotheses.insert(result.hypotheses.end(), chunk.hypotheses.begin(), chunk.hypotheses.end());
    result.collisions += chunk.collisions;
    result.checks += chunk.checks;
  }
  std::stable_sort(result.hypotheses.begin(), result.hypotheses.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.quality > b.quality; });
  return result;
}

std::size_t Ransam::chunk_count() const {
  return (map_triples_.size() + draws_per_chunk - 1) / draws_per_chunk;
}

void Ransam::draw_map_triples(std::uint64_t seed) {
  first_draw_ = table_.begin_fill(map_triples_.size());
  parallel_for(setup_.threads, chunk_count(), [&](std::size_t chunk) {
    const std::size_t begin = chunk * draws_per_chunk;
    const std::size_t end = std::min(begin + draws_per_chunk, map_triples_.size());
    for_each_triangle(
        sampler_, setup_.map->points(), rule_, seed, begin, end, [&](Relation r) { table_.prefetch(r); },
        [&](const CanonicalTriangle& triangle, std::size_t draw) {
          map_triples_[draw] = triangle.triple;
          table_.insert(triangle.relation, first_draw_ + draw);
        });
  });
}

Ransam::Chunk Ransam::match_local_triples(const LocalMap& local, const TripleSampler& sampler,
                                          const QualityTest& quality, std::uint64_t seed, double omega_max,
                                          std::size_t chunk) const {
  Chunk found;
  const std::size_t begin = chunk * draws_per_chunk;
  const std::size_t end = std::min(begin + draws_per_chunk, map_triples_.size());
  for_each_triangle(
      sampler, local.points, rule_, seed, begin, end, [&](Relation r) { table_.prefetch(r); },
      [&](const CanonicalTriangle& triangle, std::size_t draw) {
        const auto partner = table_.find(triangle.relation);  // eq. 2
        if (!partner) return;
        const Triple& map_triple = map_triples_[*partner - first_draw_];
        const Transform map_from_local =
            least_squares_motion(local.points, triangle.triple, setup_.map->points(), map_triple);  // eq. 3
        const auto start = static_cast<std::uint32_t>(mix64(draw));
        const QualityTest::Outcome outcome = quality.test(map_from_local, omega_max, start);
        ++found.collisions;
        found.checks += outcome.checks;
        if (outcome.quality) {
          const Pose2 pose = map_from_local.pose();
          found.hypotheses.push_back({pose, pose * local.local_from_robot, *outcome.quality});
        }
      });
  return found;
}

}  // namespace glocal
