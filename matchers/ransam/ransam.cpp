#include "matchers/ransam/ransam.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "glocal/parallel.hpp"
#include "matchers/common/merge.hpp"

namespace glocal {
namespace {

/// Draws handled together by one thread. Fixed, so that the answer does not depend on the number of threads.
constexpr std::size_t draws_per_chunk = RelationBatch::probes * TripleBatch::capacity;
/// Chunks of the map's relations kept in memory: 4.5 MB.
constexpr std::size_t chunks_at_a_time = 256;

unsigned table_bits(const Ransam::Params& p) {
  if (p.table_bits > 0) return static_cast<unsigned>(p.table_bits);
  // Two slots a draw. Half of the draws of a map have no relation worth keeping, so about one entry in eight
  // is lost to another relation in its slot; a larger table costs more time than it gains.
  return static_cast<unsigned>(std::bit_width(static_cast<unsigned>(p.iterations) * 2U - 1U));
}

ExtrapolationRule extrapolation_rule(const Ransam::Params& p) {
  return {
      .kind = p.extrapolation == "wald" ? ExtrapolationRule::Kind::wald : ExtrapolationRule::Kind::interval,
      .batch = p.extrapolation_batch,
      .confidence_z = p.extrapolation_z,
      .false_rejects = p.wald_false_rejects,
      .background = p.wald_background};
}

/// Adds the relations of draws [begin, end) of a seed.
void add_relations_of_draws(const TripleSampler& sampler, const Points& points, const TriangleRule& rule,
                            bool neighbours, std::uint64_t seed, std::size_t begin, std::size_t end,
                            RelationBatch& relations) {
  TripleBatch triples;
  while (begin < end) {
    triples.clear();
    while (begin < end && !triples.full()) triples.add_number(static_cast<std::uint32_t>(begin++));
    sampler.draw(seed, triples);
    find_relations(points, triples, rule, neighbours, relations);
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
          {.doc = "Triples drawn from each of the two maps in a step.",
           .min = 1,
           .max = 100e6,
           .audience = Audience::tuner});
  describe_contact_epsilon(v, p.contact_epsilon);
  v.field("relation_cell", p.relation_cell,
          {.doc = "Side lengths are quantised to this; equal triples are relations in common.",
           .unit = "m",
           .above = 0.0,
           .audience = Audience::tuner});
  v.field("min_side", p.min_side,
          {.doc = "Triples with a side shorter than this give poor poses and are skipped.",
           .unit = "m",
           .min = 0.0});
  v.field("min_height", p.min_height,
          {.doc = "Triples whose third point is nearer than this to their longest side give poor poses and "
                  "are skipped.",
           .unit = "m",
           .min = 0.0});
  v.field("local_radius", p.local_radius,
          {.doc = "Draw the second and third point within this distance of the first, on both sides: many "
                  "more correct "
                  "collisions. 0 draws from all points, as the paper does.",
           .unit = "m",
           .min = 0.0,
           .audience = Audience::expert});
  v.field(
      "extrapolation_batch", p.extrapolation_batch,
      {.doc = "Points looked at before the bound on a hypothesis's quality is computed again (k of eq. 5).",
       .min = 1,
       .audience = Audience::expert});
  v.field("extrapolation_z", p.extrapolation_z,
          {.doc = "Half width of the bound's interval in standard deviations (1.96 is the paper's 95 %).",
           .min = 0.0,
           .audience = Audience::expert});
  v.field(
      "extrapolation", p.extrapolation,
      {.doc = "When a hypothesis is given up early: at the interval of eq. 5, or by Wald's sequential test, "
              "whose share of false rejects holds however often it looks.",
       .choices = {"interval", "wald"},
       .audience = Audience::expert});
  v.field("wald_false_rejects", p.wald_false_rejects,
          {.doc = "Share of hypotheses just as good as the threshold that Wald's test may give up.",
           .max = 0.5,
           .above = 0.0,
           .audience = Audience::expert});
  v.field("wald_background", p.wald_background,
          {.doc = "Share of points a wrong pose has in contact by chance, for Wald's test; at most half the "
                  "threshold is taken.",
           .max = 0.9,
           .above = 0.0,
           .audience = Audience::expert});
  p.contact.describe_as("contact", v);
  v.field(
      "neighbour_cells", p.neighbour_cells,
      {.doc = "Look a local triple up in the nearer neighbouring relation cells too (eight look-ups instead "
              "of one), so that sides near a cell's boundary are not lost.",
       .audience = Audience::expert});
  v.field("max_hypotheses", p.max_hypotheses,
          {.doc = "Of more hypotheses than this, those that mean nearly the same pose (5 cm and 2 degrees, "
                  "or coarser until they fit) become one, which counts as many.",
           .min = 100,
           .audience = Audience::expert});
  v.field("table_bits", p.table_bits,
          {.doc = "The hash table has 2^this slots of 8 bytes; 0 chooses two to four slots a draw.",
           .min = 0,
           .max = 30,
           .audience = Audience::expert});
  describe(v, p.beams);
}

Ransam::Ransam(const Params& params, const StageSetup& setup)
    : params_(params),
      setup_(setup),
      contact_(contact_index(*setup.map, params.contact, setup.epsilon(params.contact_epsilon))),
      sampler_(setup.map->points(), params.local_radius),
      table_(table_bits(params)),
      beams_(params.beams) {
  if (params.beams.weight > 0.0) clearance_ = clearance_grid(*setup.map);
}

MatchResult Ransam::match(const LocalMap& local, const Observation& latest, double omega_max, Rng& rng) {
  if (local.points.empty()) return {};
  if (clearance_) beams_.add(local, latest.scan);
  const Draws draws{rng.next(), rng.next()};
  const QualityTest quality(local.points, contact_, extrapolation_rule(params_), omega_max, rng);
  const TripleSampler local_sampler(local.points, params_.local_radius);
  // A triangle of the map that is larger than the whole local map has no partner there.
  const TriangleRule rule{.cell = params_.relation_cell,
                          .min_side = params_.min_side,
                          .min_height = params_.min_height,
                          .max_side = std::min(diameter_bound(local.points) + params_.relation_cell,
                                               largest_side(params_.relation_cell))};

  hash_map_triples(draws.map_seed, rule);
  std::vector<MatchResult> chunks(chunk_count());
  parallel_for(setup_.threads, chunks.size(), [&](std::size_t i) {
    chunks[i] = match_local_triples(local, local_sampler, quality, rule, draws, i);
    if (clearance_) ask_beams(chunks[i].hypotheses, omega_max);
  });

  return joined(chunks, local.local_from_robot, static_cast<std::size_t>(params_.max_hypotheses));
}

std::size_t Ransam::chunk_count() const {
  return (iterations() + draws_per_chunk - 1) / draws_per_chunk;
}

void Ransam::hash_map_triples(std::uint64_t seed, const TriangleRule& rule) {
  const auto draw_chunk = [&](std::size_t chunk, RelationBatch& drawn) {
    drawn.size = 0;
    const std::size_t begin = chunk * draws_per_chunk;
    const std::size_t end = std::min(begin + draws_per_chunk, iterations());
    add_relations_of_draws(sampler_, setup_.map->points(), rule, false, seed, begin, end, drawn);
  };
  table_.begin_fill(iterations());
  if (setup_.threads <= 1) {
    RelationBatch drawn;
    for (std::size_t chunk = 0; chunk < chunk_count(); ++chunk) {
      draw_chunk(chunk, drawn);
      table_.fill(drawn);
    }
    return;
  }
  // Threads that wrote to the whole table would take its lines from each other all the time. So relations are
  // found first, some chunks at a time, and then each thread fills a share of the table of its own.
  const auto shares = static_cast<std::size_t>(setup_.threads);
  for (std::size_t begin = 0; begin < chunk_count(); begin += chunks_at_a_time) {
    drawn_.resize(std::min(chunks_at_a_time, chunk_count() - begin));
    parallel_for(setup_.threads, drawn_.size(), [&](std::size_t i) { draw_chunk(begin + i, drawn_[i]); });
    parallel_for(setup_.threads, shares, [&](std::size_t share) {
      for (const RelationBatch& drawn : drawn_) table_.fill(drawn, share, shares);
    });
  }
}

MatchResult Ransam::match_local_triples(const LocalMap& local, const TripleSampler& local_sampler,
                                        const QualityTest& quality, const TriangleRule& rule,
                                        const Draws& draws, std::size_t chunk) const {
  MatchResult found;
  RelationBatch relations;
  PartnerBatch partners;
  TripleBatch local_triples;
  TripleBatch map_triples;
  const auto test_collisions = [&] {
    test_hypotheses(local, local_sampler, quality, draws, local_triples, map_triples, found);
    local_triples.clear();
    map_triples.clear();
  };
  const std::size_t end = std::min((chunk + 1) * draws_per_chunk, iterations());
  for (std::size_t begin = chunk * draws_per_chunk; begin < end; begin += TripleBatch::capacity) {
    relations.size = 0;
    add_relations_of_draws(local_sampler, local.points, rule, params_.neighbour_cells, draws.local_seed,
                           begin, std::min(begin + TripleBatch::capacity, end), relations);
    table_.find(relations, partners);  // eq. 2
    for (std::size_t i = 0; i < partners.size; ++i) {
      local_triples.add_number(partners.number(i));
      map_triples.add_number(partners.partner(i));
      if (local_triples.full()) test_collisions();
    }
  }
  test_collisions();
  return found;
}

void Ransam::test_hypotheses(const LocalMap& local, const TripleSampler& local_sampler,
                             const QualityTest& quality, const Draws& draws, TripleBatch& local_triples,
                             TripleBatch& map_triples, MatchResult& found) const {
  // Drawing again is cheaper than having kept the triples of all draws.
  local_sampler.draw(draws.local_seed, local_triples);
  sampler_.draw(draws.map_seed, map_triples);
  MotionBatch motions;
  ContactIndex::BatchColumn starts;
  least_squares_motions(local.points, local_triples, setup_.map->points(), map_triples, motions);  // eq. 3
  for (std::size_t i = 0; i < local_triples.size; ++i) {
    starts[i] = static_cast<std::uint32_t>(mix64(local_triples.numbers[i]));
  }
  const QualityTest::Outcome outcome = quality.test(motions, local_triples.size, starts);
  found.proposals += local_triples.size;
  found.points_tested += outcome.points_tested;
  for (const auto& [i, omega] : outcome.passed)
    found.hypotheses.push_back(Hypothesis::by_contact(motions[i].pose(), omega));
}

void Ransam::ask_beams(std::vector<Hypothesis>& hypotheses, double omega_max) const {
  for (Hypothesis& h : hypotheses)
    h.score -= beams_.penalty(*clearance_, seen_from_above(h.map_from_local), h.score - omega_max);
  std::erase_if(hypotheses, [&](const Hypothesis& h) { return h.score < omega_max; });
}

}  // namespace glocal
