// Giving hypotheses up early (eq. 5): what it saves and what it loses, against Wald's test and against
// looking at every point.
#include <benchmark/benchmark.h>

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "bench/plain.hpp"
#include "bench/scenes.hpp"
#include "glocal/contact.hpp"
#include "matchers/common/quality.hpp"

namespace glocal::bench {
namespace {

constexpr double epsilon = 0.05;  // As in paper_simulation.yaml.

using Batches = std::vector<MotionBatch>;

/// Poses that a match of the simulation's local map proposes.
struct Proposals {
  LocalMap local;
  Batches wrong;   ///< Of pairs of equal triples; nearly all of them wrong.
  Batches nearly;  ///< Around the true pose, up to 0.2 m and 2 degrees off: of all qualities.
  std::shared_ptr<const ContactIndex> contact;
};

/// As many poses as `pose()` is called for.
template <class Pose>
Batches batches_of(Pose pose) {
  Batches batches(16);
  for (MotionBatch& batch : batches) {
    for (std::size_t i = 0; i < MotionBatch::capacity; ++i) {
      const Transform t = pose();
      batch.cosine[i] = t.cosine();
      batch.sine[i] = t.sine();
      batch.x[i] = t.x();
      batch.y[i] = t.y();
    }
  }
  return batches;
}

Proposals proposals_at(std::size_t step) {
  constexpr std::uint32_t draws = 200'000;
  constexpr TriangleRule rule{.cell = 0.15, .min_side = 1.5, .min_height = 1.0, .max_side = 50.0};
  Proposals result{local_map_at(simulation(), 0, step), {}, {}, {}};
  const Points& map = simulation().map();
  const Points& local = result.local.points;
  result.contact = contact_index(*simulation().loaded.map, "bitset", epsilon);

  Rng rng(1);
  std::unordered_map<Relation, Triple> table;
  for (std::uint32_t i = 0; i < draws; ++i) {
    const auto triangle = plain::canonical_triangle(map, plain::draw(map, rng), rule);
    if (triangle) table[triangle->relation] = triangle->triple;
  }
  result.wrong = batches_of([&] {
    while (true) {
      const auto triangle = plain::canonical_triangle(local, plain::draw(local, rng), rule);
      const auto partner = triangle ? table.find(triangle->relation) : table.end();
      if (partner == table.end()) continue;
      return plain::least_squares_motion(local, triangle->triple, map, partner->second);
    }
  });

  const Pose2 truth = true_map_from_local(simulation(), 0, step, result.local);
  const Pose2 robot = seen_from_above(result.local.local_from_robot);
  result.nearly = batches_of([&] {
    const Pose2 error{rng.uniform(-0.2, 0.2), rng.uniform(-0.2, 0.2), radians(rng.uniform(-2.0, 2.0))};
    return Transform(truth * robot * error * inverse(robot));
  });
  return result;
}

const Proposals& proposals(std::size_t step) {
  static std::unordered_map<std::size_t, Proposals> known;
  const auto there = known.find(step);
  return there != known.end() ? there->second : known.emplace(step, proposals_at(step)).first->second;
}

double quality(const Proposals& p, const Transform& pose) {
  const std::size_t n = p.local.points.size();
  return static_cast<double>(p.contact->count(p.local.points, 0, n, pose)) / static_cast<double>(n);
}

/// Time and points looked at for a proposal of a match; share of those over the threshold that are lost.
void give_up(benchmark::State& state, const ExtrapolationRule& rule, double threshold, std::size_t step) {
  const Proposals& p = proposals(step);
  Rng rng(1);
  const QualityTest test(p.local.points, p.contact, rule, threshold, rng);
  ContactIndex::BatchColumn starts;
  for (std::uint32_t& start : starts) start = static_cast<std::uint32_t>(rng.next());
  std::size_t points_tested = 0;
  std::size_t tested = 0;
  for ([[maybe_unused]] auto _ : state) {
    const auto outcome = test.test(p.wrong[tested++ % p.wrong.size()], MotionBatch::capacity, starts);
    points_tested += outcome.points_tested;
  }

  std::size_t good = 0;
  std::size_t kept = 0;
  for (const MotionBatch& batch : p.nearly) {
    for (std::size_t i = 0; i < MotionBatch::capacity; ++i) good += quality(p, batch[i]) >= threshold ? 1 : 0;
    kept += test.test(batch, MotionBatch::capacity, starts).passed.size();
  }
  state.counters["per_pose"] = time_per_item(MotionBatch::capacity);
  state.counters["points_tested"] =
      static_cast<double>(points_tested) / static_cast<double>(tested * MotionBatch::capacity);
  state.counters["good"] = static_cast<double>(good);
  state.counters["lost"] = good == 0 ? 0.0 : static_cast<double>(good - kept) / static_cast<double>(good);
  state.counters["local_points"] = static_cast<double>(p.local.points.size());
}

}  // namespace

void register_all() {
  for (const std::size_t step : {0U, 20U, 110U}) {
    for (const double threshold : {0.4, 0.6, 0.8}) {
      const auto add = [&](const std::string& name, const ExtrapolationRule& rule) {
        benchmark::RegisterBenchmark(
            (name + "/step:" + std::to_string(step) + "/threshold:" + std::to_string(threshold).substr(0, 3))
                .c_str(),
            [=](auto& state) { give_up(state, rule, threshold, step); })
            ->MinTime(0.1);
      };
      for (const int batch : {4, 8, 16, 32}) {
        add("interval/batch:" + std::to_string(batch), {.batch = batch});
        add("wald/batch:" + std::to_string(batch), {.kind = ExtrapolationRule::Kind::wald, .batch = batch});
      }
      // An interval as wide as this gives nothing up before it cannot be good any more.
      add("certain/batch:32", {.batch = 32, .confidence_z = 1e9});
    }
  }
}

}  // namespace glocal::bench
