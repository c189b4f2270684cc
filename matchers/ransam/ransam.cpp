#include "matchers/ransam/ransam.hpp"

#include <cmath>

#include "glocal/extent.hpp"

namespace glocal::ransam {
namespace {

double diameter_bound(const Points& points) {
  return std::hypot(extent_of(points.x).length(), extent_of(points.y).length());
}

}  // namespace

void describe(ParamVisitor& v, Ransam::Params& p) {
  describe(v, p.triples);
  describe(v, p.beams);
}

Ransam::Ransam(const Params& params, const StageSetup& setup)
    : params_(params),
      setup_(setup),
      contact_(
          contact_index(*setup.map, params.triples.contact, setup.epsilon(params.triples.contact_epsilon))),
      matching_(setup.map->points(), find_relations, params.triples, setup.threads),
      beams_(params.beams) {
  if (params.beams.weight > 0.0) clearance_ = clearance_grid(*setup.map, setup.threads);
}

MatchResult Ransam::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  if (local.points.empty()) return {};
  if (clearance_) beams_.add(local, request.latest.scan);
  const TripleMatching::Draws draws{rng.next(), rng.next()};
  const QualityTest quality(local.points, contact_, extrapolation_rule(params_.triples), request.omega_max,
                            rng);
  return matching_.match(local.points, diameter_bound(local.points), local.local_from_robot, draws,
                         [&](const TripleBatch& local_triples, const TripleBatch& map_triples) {
                           MatchResult found = test_hypotheses(request, quality, local_triples, map_triples);
                           if (clearance_) ask_beams(found.hypotheses, request.omega_max);
                           return found;
                         });
}

MatchResult Ransam::test_hypotheses(const MatchRequest& request, const QualityTest& quality,
                                    const TripleBatch& local_triples, const TripleBatch& map_triples) const {
  MotionBatch poses;
  ContactIndex::BatchColumn starts;
  least_squares_motions(request.local.points, local_triples, setup_.map->points(), map_triples,
                        poses);  // eq. 3
  for (std::size_t i = 0; i < local_triples.size; ++i) {
    starts[i] = static_cast<std::uint32_t>(mix64(local_triples.numbers[i]));
  }
  const QualityTest::Outcome outcome = quality.test(poses, local_triples.size, starts);
  MatchResult found{
      .hypotheses = {}, .proposals = local_triples.size, .points_tested = outcome.points_tested};
  for (const auto& [i, omega] : outcome.passed) {
    const Hypothesis h = Hypothesis::by_contact(poses[i].pose(), omega);
    if (request.gate.allows(h.map_from_local)) found.hypotheses.push_back(h);
  }
  return found;
}

void Ransam::ask_beams(std::vector<Hypothesis>& hypotheses, double omega_max) const {
  for (Hypothesis& h : hypotheses)
    h.score -= beams_.penalty(*clearance_, seen_from_above(h.map_from_local), h.score - omega_max);
  std::erase_if(hypotheses, [&](const Hypothesis& h) { return h.score < omega_max; });
}

}  // namespace glocal::ransam
