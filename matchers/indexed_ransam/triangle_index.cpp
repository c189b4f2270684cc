#include "matchers/indexed_ransam/triangle_index.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "glocal/parallel.hpp"
#include "glocal/rng.hpp"
#include "matchers/common/squares.hpp"

namespace glocal::indexed_ransam {
namespace {

/// Points whose triangles one thread finds at a time. Fixed, so that their order does not depend on the
/// threads.
constexpr std::size_t apexes_per_chunk = 16;

struct Entry {
  Relation relation;
  Triple triangle;
};

/// The points with higher numbers that can be in a triangle with this one, in rising order.
std::vector<std::uint32_t> partners_of(const Points& points, const Squares& squares, const TriangleRule& rule,
                                       std::uint32_t first) {
  // As find_relations() rounds, so that no triangle it would admit is lost.
  const auto square = [](double value) { return static_cast<float>(value) * static_cast<float>(value); };
  std::vector<std::uint32_t> partners;
  squares.near(points.x[first], points.y[first], [&](std::uint32_t i) {
    if (i <= first) return;
    const float dx = points.x[i] - points.x[first];
    const float dy = points.y[i] - points.y[first];
    const float squared = dx * dx + dy * dy;
    if (squared >= square(rule.min_side) && squared < square(rule.max_side)) partners.push_back(i);
  });
  std::ranges::sort(partners);
  return partners;
}

std::size_t pairs_of(std::size_t n) {
  return n < 2 ? 0 : n * (n - 1) / 2;
}

/// Calls visit(a, b), a < b < n, for an even share of all pairs, the same in every run. Leaps from one to the
/// next: the time is that of the pairs visited.
template <class Visit>
void for_some_pairs(std::size_t n, double share, Rng rng, Visit visit) {
  const auto leap = [&] {
    if (share >= 1.0) return 1.0;
    // Geometrically distributed: how far it is to the next success at this share.
    return 1.0 + std::floor(std::log1p(-rng.uniform()) / std::log1p(-share));
  };
  const auto all = static_cast<double>(pairs_of(n));
  std::size_t a = 0;
  double row_begin = 0.0;  // number of the pair (a, a + 1); exact, as it is below 2^53
  for (double pair = leap() - 1.0; pair < all; pair += leap()) {
    while (pair >= row_begin + static_cast<double>(n - 1 - a)) {
      row_begin += static_cast<double>(n - 1 - a);
      ++a;
    }
    visit(a, a + 1 + static_cast<std::size_t>(pair - row_begin));
  }
}

/// Adds the triangles of a batch that the rule admits.
void add_admitted(const Points& points, const TripleBatch& batch, const TriangleRule& rule,
                  RelationBatch& relations, std::vector<Entry>& entries) {
  relations.size = 0;
  find_relations(points, batch, rule, false, relations);
  for (std::size_t i = 0; i < relations.size; ++i) {
    const std::uint32_t n = relations.numbers[i];
    entries.push_back({relations.relations[i], {batch.first[n], batch.second[n], batch.third[n]}});
  }
}

}  // namespace

TriangleIndex::TriangleIndex(Points points, const TriangleRule& rule, std::size_t max_entries, int threads)
    : points_(std::move(points)) {
  const Squares squares(points_.x, points_.y, rule.max_side);
  const std::size_t chunks = (points_.size() + apexes_per_chunk - 1) / apexes_per_chunk;
  const auto for_chunk = [&](std::size_t chunk, auto visit) {
    const std::size_t end = std::min((chunk + 1) * apexes_per_chunk, points_.size());
    for (std::size_t i = chunk * apexes_per_chunk; i < end; ++i) {
      const auto first = static_cast<std::uint32_t>(i);
      visit(first, partners_of(points_, squares, rule, first));
    }
  };
  std::vector<std::size_t> counts(chunks, 0);
  parallel_for(threads, chunks, [&](std::size_t c) {
    for_chunk(c, [&](std::uint32_t /*first*/, const std::vector<std::uint32_t>& partners) {
      counts[c] += pairs_of(partners.size());
    });
  });
  const std::size_t all = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  const double share = static_cast<double>(max_entries) / static_cast<double>(std::max<std::size_t>(all, 1));

  std::vector<std::vector<Entry>> found(chunks);
  parallel_for(threads, chunks, [&](std::size_t c) {
    TripleBatch batch;
    RelationBatch relations;
    for_chunk(c, [&](std::uint32_t first, const std::vector<std::uint32_t>& partners) {
      for_some_pairs(partners.size(), share, Rng(first), [&](std::size_t a, std::size_t b) {
        batch.add({first, partners[a], partners[b]});
        if (!batch.full()) return;
        add_admitted(points_, batch, rule, relations, found[c]);
        batch.clear();
      });
    });
    add_admitted(points_, batch, rule, relations, found[c]);
  });

  std::vector<Entry> entries;
  for (const std::vector<Entry>& chunk : found) entries.insert(entries.end(), chunk.begin(), chunk.end());
  std::ranges::stable_sort(entries, {}, &Entry::relation);
  triangles_.reserve(entries.size());
  for (const Entry& entry : entries) {
    if (relations_.empty() || relations_.back() != entry.relation) {
      relations_.push_back(entry.relation);
      begins_.push_back(static_cast<std::uint32_t>(triangles_.size()));
    }
    triangles_.push_back(entry.triangle);
  }
  begins_.push_back(static_cast<std::uint32_t>(triangles_.size()));
}

std::size_t TriangleIndex::memory_bytes() const {
  return triangles_.size() * sizeof(Triple) + relations_.size() * sizeof(Relation) +
         begins_.size() * sizeof(std::uint32_t) + points_.size() * 3 * sizeof(float);
}

std::span<const Triple> TriangleIndex::find(Relation relation) const {
  const auto place = std::ranges::lower_bound(relations_, relation);
  if (place == relations_.end() || *place != relation) return {};
  const auto i = static_cast<std::size_t>(place - relations_.begin());
  return std::span(triangles_).subspan(begins_[i], begins_[i + 1] - begins_[i]);
}

}  // namespace glocal::indexed_ransam
