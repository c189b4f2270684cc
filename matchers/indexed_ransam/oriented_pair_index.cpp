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

namespace glocal::indexed_ransam {
namespace {

/// Calls visit(oriented point pair) for an even share of the ordered pairs of different points at an allowed
/// distance whose first point is in a square, the same in every run. Looks at no more than that share.
template <class Visit>
void for_some_pairs(const OrientedPoints& s, const OrientedPairRule& rule, const Squares& squares,
                    std::size_t square, double share, Visit visit) {
  const double shortest = rule.min_length * rule.min_length;
  const double longest = rule.max_length * rule.max_length;
  const double log_left_out = std::log1p(-share);  // -inf where all are taken
  const std::vector<std::uint32_t> around = squares.around(square);
  for (const std::uint32_t i : squares.members(square)) {
    Rng rng = Rng(1).stream({i});
    // How many are left out before the next one, if each is taken with this probability.
    const auto next_gap = [&] { return std::floor(std::log1p(-rng.uniform()) / log_left_out); };
    for (double at = next_gap(); at < static_cast<double>(around.size()); at += 1.0 + next_gap()) {
      const std::uint32_t k = around[static_cast<std::size_t>(at)];
      const double dx = s.x[k] - s.x[i];
      const double dy = s.y[k] - s.y[i];
      const double squared = dx * dx + dy * dy;
      if (squared >= shortest && squared < longest) visit(OrientedPairIndex::OrientedPair{i, k});
    }
  }
}

/// How many such pairs there are; an estimate if they are many.
double number_of_pairs(const OrientedPoints& s, const OrientedPairRule& rule, const Squares& squares,
                       int threads) {
  double near = 0.0;
  for (std::size_t i = 0; i < squares.size(); ++i)
    near += static_cast<double>(squares.members(i).size()) * static_cast<double>(squares.size_around(i));
  constexpr double looked_at = 4e6;
  const double share = std::min(1.0, looked_at / std::max(near, 1.0));
  std::vector<std::size_t> counts(squares.size(), 0);
  parallel_for(threads, squares.size(), [&](std::size_t square) {
    for_some_pairs(s, rule, squares, square, share,
                   [&](const OrientedPairIndex::OrientedPair& /*pair*/) { ++counts[square]; });
  });
  return static_cast<double>(std::accumulate(counts.begin(), counts.end(), std::size_t{0})) / share;
}

}  // namespace

OrientedPairIndex::OrientedPairIndex(OrientedPoints oriented_points, const OrientedPairRule& rule,
                                     int threads)
    : oriented_points_(std::move(oriented_points)), rule_(rule) {
  const Squares squares(oriented_points_.x, oriented_points_.y, rule_.max_length);
  const double all = number_of_pairs(oriented_points_, rule_, squares, threads);
  const double share = std::min(1.0, static_cast<double>(rule_.max_entries) / std::max(all, 1.0));
  std::vector<std::vector<std::pair<std::uint32_t, OrientedPair>>> taken(squares.size());
  parallel_for(threads, squares.size(), [&](std::size_t square) {
    for_some_pairs(oriented_points_, rule_, squares, square, share, [&](const OrientedPair& pair) {
      if (const auto b = bin(oriented_points_, pair)) taken[square].emplace_back(*b, pair);
    });
    taken[square].shrink_to_fit();  // all are there at once, beside the index that is made of them
  });
  begins_.assign(bins() + 1, 0);
  for (const auto& chunk : taken) {
    for (const auto& [b, pair] : chunk) ++begins_[b + 1];
  }
  std::partial_sum(begins_.begin(), begins_.end(), begins_.begin());
  std::vector<std::uint32_t> next(begins_.begin(), begins_.end() - 1);
  pairs_.resize(begins_.back());
  for (const auto& chunk : taken) {
    for (const auto& [b, pair] : chunk) pairs_[next[b]++] = pair;
  }
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
  return std::span(pairs_).subspan(begins_[*b], begins_[*b + 1] - begins_[*b]);
}

std::optional<std::uint32_t> OrientedPairIndex::bin(const OrientedPoints& s, const OrientedPair& pair) const {
  const float dx = s.x[pair.second] - s.x[pair.first];
  const float dy = s.y[pair.second] - s.y[pair.first];
  const auto length = static_cast<float>(std::sqrt(double{dx} * dx + double{dy} * dy));
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

}  // namespace glocal::indexed_ransam
