#include "matchers/ransac/ransac.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "glocal/parallel.hpp"
#include "matchers/common/candidates.hpp"
#include "matchers/common/merge.hpp"
#include "matchers/common/point_pair.hpp"

namespace glocal::ransac {
namespace {

/// Iterations handled together by one thread. Fixed, so that the answer does not depend on the number of
/// threads.
constexpr std::size_t iterations_per_chunk = 65536;
/// Local points nearer to each other give poor headings, m.
constexpr float min_distance = 1.0F;
/// By how much the two distances of a sample may differ, m.
constexpr float tolerance = 0.1F;
/// Of more, those that mean nearly the same pose become one, which counts as many.
constexpr std::size_t most_hypotheses = 1000;
/// Used to refine a pose.
constexpr std::size_t refinement_points = 50;

Point draw_point(const Points& points, Rng& rng) {
  return points[rng.below(static_cast<std::uint32_t>(points.size()))];
}

float distance_between(const Point& a, const Point& b) {
  return std::sqrt((a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y));
}

}  // namespace

void describe(ParamVisitor& v, Ransac::Params& p) {
  v.field("iterations", p.iterations,
          {.doc = "Samples drawn in a step: two points of each map.",
           .min = 1,
           .max = 1e9,
           .audience = Audience::tuner});
  describe_contact_epsilon(v, p.contact_epsilon);
}

Ransac::Ransac(const Params& params, const StageSetup& setup)
    : params_(params),
      setup_(setup),
      contact_(contact_index(*setup.map, "bitset", setup.epsilon(params.contact_epsilon))),
      field_(distance_field(*setup.map, setup.threads)) {}

MatchResult Ransac::match(const MatchRequest& request, Rng& rng) {
  const LocalMap& local = request.local;
  if (local.points.empty()) return {};
  const QualityTest quality(local.points, contact_, ExtrapolationRule{}, request.omega_max, rng);
  const Rng draws(rng.next());
  const auto iterations = static_cast<std::size_t>(params_.iterations);
  std::vector<MatchResult> chunks((iterations + iterations_per_chunk - 1) / iterations_per_chunk);
  parallel_for(setup_.threads, chunks.size(), [&](std::size_t i) {
    const std::size_t begin = i * iterations_per_chunk;
    chunks[i] = draw(local, quality, std::min(iterations_per_chunk, iterations - begin), draws.stream({i}));
  });
  MatchResult result = joined(chunks, local.local_from_robot, most_hypotheses);
  refine_all(local, request.omega_max, result, rng);
  return result;
}

MatchResult Ransac::draw(const LocalMap& local, const QualityTest& quality, std::size_t iterations,
                         Rng rng) const {
  const Points& map = setup_.map->points();
  MatchResult found;
  MotionBatch motions;
  ContactIndex::BatchColumn starts{};
  std::size_t size = 0;
  const auto test = [&] {
    const QualityTest::Outcome outcome = quality.test(motions, size, starts);
    found.proposals += size;
    found.points_tested += outcome.points_tested;
    for (const auto& [i, omega] : outcome.passed)
      found.hypotheses.push_back(Hypothesis::by_contact(motions[i].pose(), omega));
    size = 0;
  };
  for (std::size_t i = 0; i < iterations; ++i) {
    const PointPair pair{draw_point(local.points, rng), draw_point(local.points, rng)};
    const float length = distance_between(pair[0], pair[1]);
    if (length < min_distance) continue;
    const Point first = draw_point(map, rng);
    const Point second = draw_point(map, rng);
    if (std::abs(distance_between(first, second) - length) > tolerance) continue;
    starts[size] = static_cast<std::uint32_t>(rng.next());
    lay(pair, {first, second}, motions, size++);
    if (size == MotionBatch::capacity) test();
  }
  test();
  return found;
}

void Ransac::refine_all(const LocalMap& local, double omega_max, MatchResult& result, Rng& rng) const {
  const Points anchors = sample_of(local.points, refinement_points, rng);
  parallel_for(setup_.threads, result.hypotheses.size(), [&](std::size_t i) {
    Hypothesis& h = result.hypotheses[i];
    const Pose2 refined = refined_pose(*field_, anchors, seen_from_above(h.map_from_local), {});
    h.map_from_local = refined;
    h.quality = contact_->share(local.points, Transform(refined));
    h.score = h.quality;
  });
  result.points_tested += result.hypotheses.size() * local.points.size();
  std::erase_if(result.hypotheses, [&](const Hypothesis& h) { return h.score < omega_max; });
  std::ranges::stable_sort(result.hypotheses, std::greater<>(), &Hypothesis::score);
}

}  // namespace glocal::ransac
