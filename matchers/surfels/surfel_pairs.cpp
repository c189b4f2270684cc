#include "matchers/surfels/surfel_pairs.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

namespace glocal::surfels {
namespace {

constexpr auto pi = static_cast<float>(std::numbers::pi);
constexpr float cell_of_angle = pi / 18.0F;

/// A pair with its normals turned as they are compared.
struct PairGeometry {
  Point middle;
  Point line;           ///< From the first to the second, unit length.
  Point first, second;  ///< Normals.
  float length = 0.0F;
};

PairGeometry geometry_of(const Surfels& surfels, const SurfelPair& pair, bool both_sides) {
  const Point a = surfels.points[pair.first];
  const Point b = surfels.points[pair.second];
  const Point d = b - a;
  PairGeometry g;
  g.middle = 0.5F * (a + b);
  g.first = surfels.normals[pair.first];
  g.second = surfels.normals[pair.second];
  g.length = length(d);
  g.line = (1.0F / g.length) * d;
  if (both_sides) {
    if (dot(g.first, g.line) < 0.0F) g.first = -1.0F * g.first;
    if (dot(g.second, g.line) < 0.0F) g.second = -1.0F * g.second;
  }
  return g;
}

/// v without its part along a unit vector.
Point across(const Point& v, const Point& unit) {
  return v - dot(v, unit) * unit;
}

Point unit(const Point& v) {
  return (1.0F / length(v)) * v;
}

/// Three axes that a pair fixes.
struct Frame {
  Point x, y, z;
};

Frame frame_of(const PairGeometry& g) {
  const Point a = unit(across(g.first, g.line));
  const Point b = unit(across(g.second, g.line));
  // The axis between both normals, or, where they point away from each other, the one across it.
  const Point y = unit(dot(a, b) > 0.0F ? a + b : a - b);
  return {g.line, y, cross(g.line, y)};
}

}  // namespace

std::optional<PairRelation> relation_of(const Surfels& surfels, SurfelPair& pair, const PairRule& rule) {
  constexpr float most_parallel = 0.95F;
  constexpr float least_sine = 0.3F;
  PairGeometry g = geometry_of(surfels, pair, rule.both_sides);
  if (g.length < rule.shortest || g.length > rule.longest) return std::nullopt;
  float first = dot(g.first, g.line);
  float second = dot(g.second, g.line);
  const float most_cosine = std::sqrt(1.0F - least_sine * least_sine);
  if (std::abs(first) > most_cosine || std::abs(second) > most_cosine ||
      std::abs(dot(g.first, g.second)) > most_parallel)
    return std::nullopt;
  // Of the two orders of a pair, one is compared: the sum of the angles is at most 180 degrees, or, with
  // normals of either side, the first angle is the smaller one.
  if (rule.both_sides ? first < second : first + second < 0.0F) {
    std::swap(pair.first, pair.second);
    std::swap(first, second);
    if (!rule.both_sides) {
      first = -first;
      second = -second;
    }
  }
  const Point a = across(g.first, g.line);
  const Point b = across(g.second, g.line);
  const float twist = std::atan2(dot(cross(a, b), g.line), dot(a, b));
  const auto cell = [](float v, float side) { return static_cast<std::uint64_t>(v / side); };
  return ((cell(g.length, rule.length_cell) * 18 + cell(std::acos(first), cell_of_angle)) * 18 +
          cell(std::acos(second), cell_of_angle)) *
             36 +
         std::min<std::uint64_t>(cell(twist + pi, cell_of_angle), 35);
}

PairSampler::PairSampler(const Surfels& surfels, const PairRule& rule) : surfels_(&surfels), rule_(rule) {
  constexpr float finely = 8.0F;
  // From there on single precision would lose what small weights add: counting begins anew.
  constexpr std::size_t most_counted = std::size_t{1} << 23U;
  float sum = 0.0F;
  std::size_t counted = 0;
  for (std::size_t i = 0; i < surfels.size(); ++i) {
    sum += finely * surfels.weights[i];
    for (; static_cast<float>(counted) + 0.5F < sum; ++counted)
      by_weight_.push_back(static_cast<std::uint32_t>(i));
    if (counted < most_counted) continue;
    sum -= static_cast<float>(counted);
    counted = 0;
  }
}

std::optional<std::pair<SurfelPair, PairRelation>> PairSampler::draw(Rng& rng) const {
  const auto n = static_cast<std::uint32_t>(by_weight_.size());
  SurfelPair pair{by_weight_[rng.below(n)], by_weight_[rng.below(n)]};
  const Point d = surfels_->points[pair.second] - surfels_->points[pair.first];
  const float squared = dot(d, d);
  if (squared < rule_.shortest * rule_.shortest || squared > rule_.longest * rule_.longest)
    return std::nullopt;
  const auto relation = relation_of(*surfels_, pair, rule_);
  if (!relation) return std::nullopt;
  return std::pair{pair, *relation};
}

PairTable::PairTable(const Surfels& surfels, const PairRule& rule, std::size_t pairs, Rng rng)
    : bucket_bits_(static_cast<int>(std::bit_width(pairs))) {
  const PairSampler sampler(surfels, rule);
  std::vector<std::pair<std::uint32_t, SurfelPair>> drawn;
  drawn.reserve(pairs);
  // Most draws give no pair: in a long corridor few partners are near.
  if (surfels.size() > 1) {
    for (std::size_t i = 0; i < 40 * pairs && drawn.size() < pairs; ++i) {
      if (const auto pair = sampler.draw(rng))
        drawn.emplace_back(static_cast<std::uint32_t>(bucket_of(pair->second)), pair->first);
    }
  }
  starts_.assign((std::size_t{1} << bucket_bits_) + 1, 0);
  for (const auto& [bucket, pair] : drawn) ++starts_[bucket + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  pairs_.resize(drawn.size());
  for (const auto& [bucket, pair] : drawn) pairs_[next[bucket]++] = pair;
}

std::size_t PairTable::bucket_of(PairRelation relation) const {
  return (relation ^ (relation >> 15U)) * 0x9e3779b97f4a7c15ULL >> (64 - bucket_bits_);
}

std::span<const SurfelPair> PairTable::find(PairRelation relation) const {
  const std::size_t bucket = bucket_of(relation);
  return std::span(pairs_).subspan(starts_[bucket], starts_[bucket + 1] - starts_[bucket]);
}

RigidMotion motion_between(const Surfels& source, const SurfelPair& a, const Surfels& target,
                           const SurfelPair& b, bool both_sides) {
  const PairGeometry from = geometry_of(source, a, both_sides);
  const PairGeometry to = geometry_of(target, b, both_sides);
  const Frame s = frame_of(from);
  const Frame t = frame_of(to);
  RigidMotion motion;
  // The sum of the outer products of the axes.
  motion.rotation = {
      t.x.x * s.x.x + t.y.x * s.y.x + t.z.x * s.z.x, t.x.x * s.x.y + t.y.x * s.y.y + t.z.x * s.z.y,
      t.x.x * s.x.z + t.y.x * s.y.z + t.z.x * s.z.z, t.x.y * s.x.x + t.y.y * s.y.x + t.z.y * s.z.x,
      t.x.y * s.x.y + t.y.y * s.y.y + t.z.y * s.z.y, t.x.y * s.x.z + t.y.y * s.y.z + t.z.y * s.z.z,
      t.x.z * s.x.x + t.y.z * s.y.x + t.z.z * s.z.x, t.x.z * s.x.y + t.y.z * s.y.y + t.z.z * s.z.y,
      t.x.z * s.x.z + t.y.z * s.y.z + t.z.z * s.z.z};
  motion.translation = to.middle - motion.turned(from.middle);
  return motion;
}

}  // namespace glocal::surfels
