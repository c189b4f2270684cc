#include "matchers/indexed_ransam/oriented_pair_index.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>
#include <vector>

#include "glocal/parallel.hpp"
#include "glocal/rng.hpp"
#include "matchers/common/squares.hpp"

namespace glocal {
namespace {

/// Points whose oriented point pairs one thread finds at a time. Fixed, so that their order does not depend
/// on the threads.
constexpr std::size_t points_per_chunk = 64;

/// Calls visit(oriented point pair) for each ordered pair of different points at an allowed distance whose
/// first point is in the chunk.
template <class Visit>
void for_each_pair(const OrientedPoints& s, const OrientedPairRule& rule, const Squares& squares,
                   std::size_t chunk, Visit visit) {
  const double shortest = rule.min_length * rule.min_length;
  const double longest = rule.max_length * rule.max_length;
  const auto end = static_cast<std::uint32_t>(std::min((chunk + 1) * points_per_chunk, s.size()));
  for (auto i = static_cast<std::uint32_t>(chunk * points_per_chunk); i < end; ++i) {
    squares.near(s.x[i], s.y[i], [&](std::uint32_t k) {
      const double dx = s.x[k] - s.x[i];
      const double dy = s.y[k] - s.y[i];
      const double squared = dx * dx + dy * dy;
      if (squared >= shortest && squared < longest) visit(OrientedPairIndex::OrientedPair{i, k});
    });
  }
}

/// Whether an oriented point pair is among an even share of all, the same in every run.
bool is_taken(const OrientedPairIndex::OrientedPair& pair, double share) {
  const std::uint64_t hash = mix64(std::uint64_t{pair.first} << 32U | pair.second);
  return static_cast<double>(hash >> 11U) * 0x1.0p-53 < share;
}

}  // namespace

OrientedPairIndex::OrientedPairIndex(OrientedPoints oriented_points, const OrientedPairRule& rule,
                                     int threads)
    : oriented_points_(std::move(oriented_points)), rule_(rule) {
  const Squares squares(oriented_points_.x, oriented_points_.y, rule_.max_length);
  const std::size_t chunks = (oriented_points_.size() + points_per_chunk - 1) / points_per_chunk;
  std::vector<std::size_t> counts(chunks, 0);
  parallel_for(threads, chunks, [&](std::size_t c) {
    std::size_t count = 0;
    for_each_pair(oriented_points_, rule_, squares, c, [&](const OrientedPair& /*pair*/) { ++count; });
    counts[c] = count;
  });
  const std::size_t all = std::accumulate(counts.begin(), counts.end(), std::size_t{0});
  const double share =
      static_cast<double>(rule_.max_entries) / static_cast<double>(std::max<std::size_t>(all, 1));

  std::vector<std::vector<std::pair<std::uint32_t, OrientedPair>>> taken(chunks);
  parallel_for(threads, chunks, [&](std::size_t c) {
    for_each_pair(oriented_points_, rule_, squares, c, [&](const OrientedPair& pair) {
      if (share < 1.0 && !is_taken(pair, share)) return;
      if (const auto b = bin(oriented_points_, pair)) taken[c].emplace_back(*b, pair);
    });
  });
  std::vector<std::uint32_t> begins(bins() + 1, 0);
  for (const auto& chunk : taken) {
    for (const auto& [b, pair] : chunk) ++begins[b + 1];
  }
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
  std::vector<std::uint32_t> next(begins.begin(), begins.end() - 1);
  std::vector<OrientedPair> pairs(begins.back());
  for (const auto& chunk : taken) {
    for (const auto& [b, pair] : chunk) pairs[next[b]++] = pair;
  }
  begins_ = SharedArray(std::move(begins));
  pairs_ = SharedArray(std::move(pairs));
}

OrientedPairIndex::OrientedPairIndex(const SavedIndex& saved, const OrientedPairRule& rule) : rule_(rule) {
  saved.expect(kind);
  oriented_points_ = {saved.section<float>(0).copy(), saved.section<float>(1).copy(),
                      saved.section<float>(2).copy()};
  begins_ = saved.section<std::uint32_t>(3);
  pairs_ = saved.section<OrientedPair>(4);

  const std::size_t points = oriented_points_.size();
  saved.expect_fit(oriented_points_.y.size() == points && oriented_points_.angle.size() == points &&
                   begins_.size() == bins() + 1);
  for (const auto* values : {&oriented_points_.x, &oriented_points_.y, &oriented_points_.angle})
    saved.expect_finite(*values);
  saved.expect_bins(begins_.span(), pairs_.size());
  saved.expect_below(points, pairs_.span());
}

std::string OrientedPairIndex::saved(const IndexOrigin& origin) const {
  return saved_index(
      kind, origin,
      {std::as_bytes(std::span(oriented_points_.x)), std::as_bytes(std::span(oriented_points_.y)),
       std::as_bytes(std::span(oriented_points_.angle)), std::as_bytes(begins_.span()),
       std::as_bytes(pairs_.span())});
}

std::size_t OrientedPairIndex::bins() const {
  const auto lengths =
      static_cast<std::size_t>(std::ceil((rule_.max_length - rule_.min_length) / rule_.length_cell));
  const auto angles = static_cast<std::size_t>(rule_.angle_cells);
  return lengths * angles * angles;
}

std::size_t OrientedPairIndex::memory_bytes() const {
  return pairs_.size() * sizeof(OrientedPair) + begins_.size() * sizeof(std::uint32_t) +
         oriented_points_.size() * 3 * sizeof(float);
}

std::span<const OrientedPairIndex::OrientedPair> OrientedPairIndex::find(
    const OrientedPoints& oriented_points, const OrientedPair& pair) const {
  const auto b = bin(oriented_points, pair);
  if (!b) return {};
  return pairs_.span().subspan(begins_[*b], begins_[*b + 1] - begins_[*b]);
}

std::optional<std::uint32_t> OrientedPairIndex::bin(const OrientedPoints& s, const OrientedPair& pair) const {
  const float dx = s.x[pair.second] - s.x[pair.first];
  const float dy = s.y[pair.second] - s.y[pair.first];
  const float length = std::hypot(dx, dy);
  if (!(length >= rule_.min_length && length < rule_.max_length)) return std::nullopt;
  const auto length_cell = static_cast<std::uint32_t>((length - rule_.min_length) / rule_.length_cell);
  const float direction = std::atan2(dy, dx);
  const auto angle_cells = static_cast<std::uint32_t>(rule_.angle_cells);
  const auto angle_cell = [&](std::uint32_t i) {
    const double turn = (s.angle[i] - direction) / (2.0 * std::numbers::pi);
    const auto cell = static_cast<std::uint32_t>((turn - std::floor(turn)) * rule_.angle_cells);
    return std::min(cell, angle_cells - 1);
  };
  return (length_cell * angle_cells + angle_cell(pair.first)) * angle_cells + angle_cell(pair.second);
}

}  // namespace glocal
