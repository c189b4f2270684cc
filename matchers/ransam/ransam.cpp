#include "matchers/ransam/ransam.hpp"

#include <algorithm>
#include <cmath>

#include "matchers/common/merge.hpp"
#include "matchers/ransam/space_ransam.hpp"

namespace glocal {
namespace {

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

TripleMatchingRule triple_matching_rule(const Ransam::Params& p) {
  return {.iterations = static_cast<std::size_t>(p.iterations),
          .local_radius = p.local_radius,
          .neighbour_cells = p.neighbour_cells,
          .table_bits = static_cast<unsigned>(p.table_bits)};
}

ExtrapolationRule extrapolation_rule(const Ransam::Params& p) {
  return {
      .kind = p.extrapolation == "wald" ? ExtrapolationRule::Kind::wald : ExtrapolationRule::Kind::interval,
      .batch = p.extrapolation_batch,
      .confidence_z = p.extrapolation_z,
      .false_rejects = p.wald_false_rejects,
      .background = p.wald_background};
}

std::unique_ptr<Matcher> Ransam::make(const Params& params, const StageSetup& setup) {
  if (setup.motion == Motion::planar) return std::make_unique<Ransam>(params, setup);
  return std::make_unique<SpaceRansam>(params, setup);
}

Ransam::Ransam(const Params& params, const StageSetup& setup)
    : params_(params),
      setup_(setup),
      contact_(contact_index(*setup.map, params.contact, setup.epsilon(params.contact_epsilon))),
      matching_(setup.map->points(), find_relations, triple_matching_rule(params), setup.threads),
      beams_(params.beams) {
  if (params.beams.weight > 0.0) clearance_ = clearance_grid(*setup.map);
}

MatchResult Ransam::match(const LocalMap& local, const Observation& latest, double omega_max, Rng& rng) {
  if (local.points.empty()) return {};
  if (clearance_) beams_.add(local, latest.scan);
  const TripleMatching::Draws draws{rng.next(), rng.next()};
  const QualityTest quality(local.points, contact_, extrapolation_rule(params_), omega_max, rng);
  // A triangle of the map that is larger than the whole local map has no partner there.
  const TriangleRule rule{.cell = params_.relation_cell,
                          .min_side = params_.min_side,
                          .min_height = params_.min_height,
                          .max_side = std::min(diameter_bound(local.points) + params_.relation_cell,
                                               largest_side(params_.relation_cell))};
  const std::vector<MatchResult> chunks = matching_.match(
      local.points, rule, draws, [&](const TripleBatch& local_triples, const TripleBatch& map_triples) {
        MatchResult found = test_hypotheses(local, quality, local_triples, map_triples);
        if (clearance_) ask_beams(found.hypotheses, omega_max);
        return found;
      });
  return joined(chunks, local.local_from_robot, static_cast<std::size_t>(params_.max_hypotheses));
}

MatchResult Ransam::test_hypotheses(const LocalMap& local, const QualityTest& quality,
                                    const TripleBatch& local_triples, const TripleBatch& map_triples) const {
  MotionBatch poses;
  ContactIndex::BatchColumn starts;
  least_squares_motions(local.points, local_triples, setup_.map->points(), map_triples, poses);  // eq. 3
  for (std::size_t i = 0; i < local_triples.size; ++i) {
    starts[i] = static_cast<std::uint32_t>(mix64(local_triples.numbers[i]));
  }
  const QualityTest::Outcome outcome = quality.test(poses, local_triples.size, starts);
  MatchResult found{
      .hypotheses = {}, .proposals = local_triples.size, .points_tested = outcome.points_tested};
  for (const auto& [i, omega] : outcome.passed) {
    const Hypothesis h = Hypothesis::by_contact(poses[i].pose(), omega);
    if (gate_.allows(h.map_from_local)) found.hypotheses.push_back(h);
  }
  return found;
}

void Ransam::ask_beams(std::vector<Hypothesis>& hypotheses, double omega_max) const {
  for (Hypothesis& h : hypotheses)
    h.score -= beams_.penalty(*clearance_, seen_from_above(h.map_from_local), h.score - omega_max);
  std::erase_if(hypotheses, [&](const Hypothesis& h) { return h.score < omega_max; });
}

}  // namespace glocal
