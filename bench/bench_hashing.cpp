// Relations and the table they meet in: how fast, how many entries are lost, and which kind of relation finds
// the most right partners.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include "bench/plain.hpp"
#include "bench/scenes.hpp"
#include "matchers/common/triangle.hpp"
#include "matchers/common/triple_sampler.hpp"
#include "matchers/ransam/ransam.hpp"
#include "matchers/ransam/relation_table.hpp"

namespace glocal::bench {
namespace {

constexpr std::size_t late_step = 110;
constexpr std::uint32_t draws = 200'000;
/// As in paper_simulation.yaml.
constexpr TriangleRule rule{.cell = 0.15, .min_side = 1.5, .min_height = 1.0, .max_side = 50.0};

// --- Relations of triples ------------------------------------------------------------------------------

/// Some batches of triples, more than a level 1 cache holds.
std::vector<TripleBatch> batches_of(const Points& points) {
  const TripleSampler sampler(points, 0.0);
  std::vector<TripleBatch> batches(64);
  std::uint32_t number = 0;
  for (TripleBatch& batch : batches) {
    while (!batch.full()) batch.add_number(number++);
    sampler.draw(1, batch);
  }
  return batches;
}

void plain_relations(benchmark::State& state) {
  const Points& map = simulation().map();
  const std::vector<TripleBatch> batches = batches_of(map);
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    const TripleBatch& batch = batches[i++ % batches.size()];
    for (std::size_t k = 0; k < batch.size; ++k) {
      auto triangle = plain::canonical_triangle(map, {batch.first[k], batch.second[k], batch.third[k]}, rule);
      benchmark::DoNotOptimize(triangle);
    }
  }
  state.counters["per_triple"] = time_per_item(TripleBatch::capacity);
}

void batch_relations(benchmark::State& state, bool neighbours) {
  const Points& map = simulation().map();
  const std::vector<TripleBatch> batches = batches_of(map);
  RelationBatch relations;
  std::size_t i = 0;
  for ([[maybe_unused]] auto _ : state) {
    relations.size = 0;
    find_relations(map, batches[i++ % batches.size()], rule, neighbours, relations);
    benchmark::DoNotOptimize(relations);
  }
  state.counters["per_triple"] = time_per_item(TripleBatch::capacity);
}

// --- The table -----------------------------------------------------------------------------------------

/// Relations of 200,000 draws, without those the rule excludes.
std::vector<Relation> relations_of(const Points& points, std::uint64_t seed) {
  const TripleSampler sampler(points, 0.0);
  std::vector<Relation> result;
  RelationBatch relations;
  for (std::uint32_t number = 0; number < draws;) {
    TripleBatch batch;
    while (!batch.full() && number < draws) batch.add_number(number++);
    sampler.draw(seed, batch);
    relations.size = 0;
    find_relations(points, batch, rule, false, relations);
    result.insert(result.end(), relations.relations.begin(),
                  relations.relations.begin() + static_cast<std::ptrdiff_t>(relations.size));
  }
  return result;
}

/// The table glocal uses.
class Narrow {
 public:
  explicit Narrow(unsigned bits) : table_(bits) {}
  void begin() { table_.begin_fill(draws); }
  void fill(std::span<const Relation> relations, std::span<const std::uint32_t> numbers) {
    batch_.size = relations.size();
    std::ranges::copy(relations, batch_.relations.begin());
    std::ranges::copy(numbers, batch_.numbers.begin());
    table_.fill(batch_);
  }
  [[nodiscard]] std::size_t find(std::span<const Relation> relations) {
    batch_.size = relations.size();
    std::ranges::copy(relations, batch_.relations.begin());
    table_.find(batch_, found_);
    return found_.size;
  }
  [[nodiscard]] std::size_t memory_bytes() const { return table_.memory_bytes(); }

 private:
  ransam::RelationTable table_;
  RelationBatch batch_{};
  ransam::PartnerBatch found_;
};

/// Entries of 8 or 16 bytes, the latter for the triple itself; cleared for each fill. With or without asking
/// for slots ahead.
template <class Entry, bool ahead>
class Plain {
 public:
  explicit Plain(unsigned bits) : shift_(64 - bits), slots_(std::size_t{1} << bits) {}
  void begin() { slots_.assign(slots_.size(), {}); }
  void fill(std::span<const Relation> relations, std::span<const std::uint32_t> numbers) {
    ask_for(relations);
    for (std::size_t i = 0; i < relations.size(); ++i) {
      slots_[slot(relations[i])] = {relations[i] + 1, {numbers[i]}};
    }
  }
  [[nodiscard]] std::size_t find(std::span<const Relation> relations) const {
    ask_for(relations);
    std::size_t found = 0;
    for (const Relation relation : relations) found += slots_[slot(relation)].relation_plus_1 == relation + 1;
    return found;
  }
  [[nodiscard]] std::size_t memory_bytes() const { return slots_.size() * sizeof(Entry); }

 private:
  [[nodiscard]] std::size_t slot(Relation relation) const {
    return static_cast<std::size_t>(relation * std::uint64_t{0x9e3779b97f4a7c15} >> shift_);
  }
  void ask_for(std::span<const Relation> relations) const {
    if constexpr (ahead) {
      for (const Relation relation : relations) __builtin_prefetch(&slots_[slot(relation)]);
    }
  }
  unsigned shift_;
  std::vector<Entry> slots_;
};
template <std::size_t n>
struct Entry {
  Relation relation_plus_1 = 0;
  std::array<std::uint32_t, n> numbers{};
};

/// What the standard library offers; loses nothing.
class Standard {
 public:
  explicit Standard(unsigned bits) { map_.reserve(std::size_t{1} << bits); }
  void begin() { map_.clear(); }
  void fill(std::span<const Relation> relations, std::span<const std::uint32_t> numbers) {
    for (std::size_t i = 0; i < relations.size(); ++i) map_[relations[i]] = numbers[i];
  }
  [[nodiscard]] std::size_t find(std::span<const Relation> relations) const {
    std::size_t found = 0;
    for (const Relation relation : relations) found += map_.contains(relation) ? 1 : 0;
    return found;
  }
  [[nodiscard]] std::size_t memory_bytes() const {
    struct Node {
      void* next;
      std::pair<const Relation, std::uint32_t> value;
    };
    return map_.bucket_count() * sizeof(void*) + map_.size() * sizeof(Node);
  }

 private:
  std::unordered_map<Relation, std::uint32_t> map_;
};

/// Calls `use` with a batch of relations after the other.
template <class Use>
void in_batches(const std::vector<Relation>& relations, Use use) {
  for (std::size_t begin = 0; begin < relations.size(); begin += TripleBatch::capacity) {
    use(begin, std::min(TripleBatch::capacity, relations.size() - begin));
  }
}

/// Fills the table with the map's relations and looks the local map's up. Argument: 2^this slots.
template <class Table>
void fill_and_find(benchmark::State& state) {
  const std::vector<Relation> map = relations_of(simulation().map(), 1);
  const std::vector<Relation> local = relations_of(local_map_at(simulation(), 0, late_step).points, 2);
  std::vector<std::uint32_t> numbers(map.size());
  std::iota(numbers.begin(), numbers.end(), 0U);
  Table table(static_cast<unsigned>(state.range(0)));
  const auto find_all = [&](const std::vector<Relation>& relations) {
    std::size_t found = 0;
    in_batches(relations, [&](std::size_t begin, std::size_t n) {
      found += table.find(std::span(relations).subspan(begin, n));
    });
    return found;
  };
  std::size_t hits = 0;
  for ([[maybe_unused]] auto _ : state) {
    table.begin();
    in_batches(map, [&](std::size_t begin, std::size_t n) {
      table.fill(std::span(map).subspan(begin, n), std::span(numbers).subspan(begin, n));
    });
    hits = find_all(local);
  }
  const std::size_t found_again = find_all(map);
  state.counters["per_access"] = time_per_item(static_cast<double>(map.size() + local.size()));
  state.counters["load"] = static_cast<double>(map.size()) / std::exp2(static_cast<double>(state.range(0)));
  state.counters["lost"] = 1.0 - static_cast<double>(found_again) / static_cast<double>(map.size());
  state.counters["hits"] = static_cast<double>(hits);
  state.counters["memory_MB"] = static_cast<double>(table.memory_bytes()) / 1e6;
}

// --- Kinds of relations --------------------------------------------------------------------------------

using SideLengths = std::array<float, 3>;

SideLengths sides_in_order(const Points& points, const Triple& t) {
  return {std::sqrt(plain::squared_distance(points, t[0], t[1])),
          std::sqrt(plain::squared_distance(points, t[1], t[2])),
          std::sqrt(plain::squared_distance(points, t[2], t[0]))};
}

/// Side lengths in the order the points were drawn in.
std::optional<plain::CanonicalTriangle> as_drawn(const Points& points, const Triple& triple,
                                                 const TriangleRule& rule_now) {
  if (!plain::canonical_triangle(points, triple, rule_now)) return std::nullopt;
  Relation relation = 0;
  for (const float side : sides_in_order(points, triple)) {
    relation = relation << relation_side_bits |
               static_cast<Relation>(side * static_cast<float>(1.0 / rule_now.cell));
  }
  return plain::CanonicalTriangle{triple, relation};
}

/// Whether a motion is within 0.3 m and 3 degrees of the truth.
bool is_right(const Pose2& map_from_local, const Pose2& local_from_robot, const Pose2& truth) {
  const Pose2 robot = map_from_local * local_from_robot;
  const Pose2 true_robot = truth * local_from_robot;
  return distance(robot, true_robot) < 0.3 && rotation_between(robot, true_robot) < radians(3.0);
}

/// How many pairs of triples 200,000 draws of each side give, and how many of them are right. Argument:
/// relation cell in cm.
template <auto relation_of>
void kind(benchmark::State& state) {
  const Points& map = simulation().map();
  const LocalMap local = local_map_at(simulation(), 0, late_step);
  const Pose2 truth = true_map_from_local(simulation(), 0, late_step, local);
  const Pose2 robot = seen_from_above(local.local_from_robot);
  TriangleRule rule_now = rule;
  rule_now.cell = static_cast<double>(state.range(0)) / 100.0;
  rule_now.max_side = std::min(rule.max_side, largest_side(rule_now.cell));
  std::size_t proposals = 0;
  std::size_t right = 0;
  Rng rng(1);
  for ([[maybe_unused]] auto _ : state) {
    std::unordered_map<Relation, Triple> table;
    for (std::uint32_t i = 0; i < draws; ++i) {
      const auto triangle = relation_of(map, plain::draw(map, rng), rule_now);
      if (triangle) table[triangle->relation] = triangle->triple;
    }
    for (std::uint32_t i = 0; i < draws; ++i) {
      const auto triangle = relation_of(local.points, plain::draw(local.points, rng), rule_now);
      if (!triangle) continue;
      const auto partner = table.find(triangle->relation);
      if (partner == table.end()) continue;
      ++proposals;
      const Transform motion =
          plain::least_squares_motion(local.points, triangle->triple, map, partner->second);
      if (is_right(motion.pose(), robot, truth)) ++right;
    }
  }
  state.counters["proposals"] = per_iteration(proposals);
  state.counters["right"] = per_iteration(right);
}

/// Whole matches. Arguments: relation cell in cm, and whether neighbouring cells are looked up too.
void match(benchmark::State& state) {
  constexpr double omega_max = 0.75;
  const LocalMap local = local_map_at(simulation(), 0, late_step);
  const Pose2 truth = true_map_from_local(simulation(), 0, late_step, local);
  const Pose2 robot = seen_from_above(local.local_from_robot);
  ransam::Ransam ransam({.triples = {.contact_epsilon = 0.05,
                                     .relation_cell = static_cast<double>(state.range(0)) / 100.0,
                                     .min_side = rule.min_side,
                                     .min_height = rule.min_height,
                                     .neighbour_cells = state.range(1) != 0}},
                        {simulation().loaded.map, 1});
  Rng rng(1);
  std::size_t proposals = 0;
  std::size_t right = 0;
  for ([[maybe_unused]] auto _ : state) {
    const MatchResult result = ransam.match({local, {}, omega_max}, rng);
    proposals += result.proposals;
    for (const Hypothesis& h : result.hypotheses) {
      if (is_right(seen_from_above(h.map_from_local), robot, truth)) ++right;
    }
  }
  state.counters["proposals"] = per_iteration(proposals);
  state.counters["right"] = per_iteration(right);
}

/// Of 2^16 to 2^22 entries.
void tables(benchmark::internal::Benchmark* timed) {
  timed->DenseRange(16, 22)->Unit(benchmark::kMillisecond);
}
/// Of 5 to 30 cm.
void cells(benchmark::internal::Benchmark* timed) {
  timed->ArgsProduct({{5, 10, 15, 20, 30}})->Unit(benchmark::kMillisecond);
}
BENCHMARK(reference_loop)->Unit(benchmark::kMillisecond);
BENCHMARK(plain_relations);
BENCHMARK_CAPTURE(batch_relations, own_cell, false);
BENCHMARK_CAPTURE(batch_relations, neighbour_cells, true);
BENCHMARK(fill_and_find<Narrow>)->Name("relation_table")->Apply(tables);
BENCHMARK(fill_and_find<Plain<Entry<1>, true>>)->Name("entries_of_8_bytes")->Apply(tables);
BENCHMARK(fill_and_find<Plain<Entry<3>, true>>)->Name("entries_of_16_bytes")->Apply(tables);
BENCHMARK(fill_and_find<Plain<Entry<1>, false>>)->Name("without_prefetch")->Apply(tables);
BENCHMARK(fill_and_find<Standard>)->Name("unordered_map")->Arg(18)->Unit(benchmark::kMillisecond);
BENCHMARK(kind<plain::canonical_triangle>)->Name("canonical_relations")->Apply(cells);
BENCHMARK(kind<as_drawn>)->Name("relations_as_drawn")->Apply(cells);
BENCHMARK(match)
    ->ArgsProduct({{5, 10, 15, 20}, {0, 1}})
    ->ArgNames({"cell_cm", "neighbours"})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace glocal::bench

BENCHMARK_MAIN();
