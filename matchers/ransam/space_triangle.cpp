#include "matchers/ransam/space_triangle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "matchers/surfels/surfel_contact.hpp"

namespace glocal::ransam {
namespace {

/// Squared sides, each against the corner of the same number, m^2.
std::array<float, 3> squared_sides(const Points& points, const Triple& triple) {
  const auto squared_distance = [&](std::size_t i, std::size_t k) {
    const float dx = points.x[triple[i]] - points.x[triple[k]];
    const float dy = points.y[triple[i]] - points.y[triple[k]];
    const float dz = points.z[triple[i]] - points.z[triple[k]];
    return dx * dx + dy * dy + dz * dz;
  };
  return {squared_distance(1, 2), squared_distance(2, 0), squared_distance(0, 1)};
}

/// Longest first.
std::array<float, 3> sorted(std::array<float, 3> squares) {
  std::sort(squares.begin(), squares.end(), std::greater<>());
  return squares;
}

bool is_admitted(const std::array<float, 3>& squares, const TriangleRule& rule) {
  const auto square = [](double value) { return static_cast<float>(value) * static_cast<float>(value); };
  const auto [a, b, c] = squares;
  if (c < std::max(square(rule.min_side), std::numeric_limits<float>::min()) || a >= square(rule.max_side))
    return false;
  // Heron: 16 times the squared area, which is 4 times the longest side times the height over it, squared.
  const float area = 4.0F * a * b - (a + b - c) * (a + b - c);
  return area >= 4.0F * square(rule.min_height) * a;
}

/// A side length in relation cells: its own one, and the neighbouring cell that is nearer.
std::array<Relation, 2> cells_of(float square, float cells_per_metre) {
  const float length = std::sqrt(square) * cells_per_metre;
  const auto own = static_cast<Relation>(length);
  const bool is_lower = length - static_cast<float>(own) < 0.5F && own > 0;
  return {own, is_lower ? own - 1 : own + 1};
}

Relation relation_of(Relation a, Relation b, Relation c) {
  return a << 2 * relation_side_bits | b << relation_side_bits | c;
}

Vector3 centroid(const Triangle& t) {
  return 1.0 / 3.0 * (t[0] + t[1] + t[2]);
}

/// Two axes in a triangle's plane, and the normal round which its corners run counter-clockwise.
struct Axes {
  explicit Axes(const Triangle& t) {
    const Vector3 side = t[1] - t[0];
    u = side.normalized();
    normal = side.cross(t[2] - t[0]).normalized();
    v = normal.cross(u);
  }
  Vector3 u, v, normal;
};

}  // namespace

void find_relations_in_space(const Points& points, const TripleBatch& batch, const TriangleRule& rule,
                             bool neighbours, RelationBatch& relations) {
  const auto cells_per_metre = static_cast<float>(1.0 / rule.cell);
  for (std::size_t i = 0; i < batch.size; ++i) {
    const std::array<float, 3> squares =
        sorted(squared_sides(points, {batch.first[i], batch.second[i], batch.third[i]}));
    if (!is_admitted(squares, rule)) continue;
    const auto a = cells_of(squares[0], cells_per_metre);
    const auto b = cells_of(squares[1], cells_per_metre);
    const auto c = cells_of(squares[2], cells_per_metre);
    // The first probe is of the sides' own cells.
    for (std::size_t probe = 0; probe < (neighbours ? RelationBatch::probes : 1); ++probe) {
      relations.relations[relations.size] = relation_of(a[probe >> 2U], b[probe >> 1U & 1U], c[probe & 1U]);
      relations.numbers[relations.size] = batch.numbers[i];
      ++relations.size;
    }
  }
}

Triple in_order_of_relation(const Points& points, const Triple& triple) {
  std::array<float, 3> squares = squared_sides(points, triple);
  Triple ordered = triple;
  const auto put_in_order = [&](std::size_t i, std::size_t k) {
    if (squares[i] >= squares[k]) return;
    std::swap(squares[i], squares[k]);
    std::swap(ordered[i], ordered[k]);
  };
  put_in_order(0, 1);
  put_in_order(1, 2);
  put_in_order(0, 1);
  return ordered;
}

Pose3 least_squares_motion(const Triangle& from, const Triangle& to) {
  const Vector3 from_middle = centroid(from);
  const Vector3 to_middle = centroid(to);
  const Axes f(from);
  const Axes t(to);
  // In the plane, the optimal rotation turns by atan2(sine, cosine) of these sums over the centred corners.
  double cosine = 0.0;
  double sine = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3 p = from[i] - from_middle;
    const Vector3 q = to[i] - to_middle;
    const double px = p.dot(f.u);
    const double py = p.dot(f.v);
    const double qx = q.dot(t.u);
    const double qy = q.dot(t.v);
    cosine += px * qx + py * qy;
    sine += px * qy - py * qx;
  }
  const double length = std::hypot(cosine, sine);
  const double c = length > 0.0 ? cosine / length : 1.0;
  const double s = length > 0.0 ? sine / length : 0.0;
  Eigen::Matrix3d from_axes, to_axes;
  from_axes << f.u, f.v, f.normal;
  to_axes << c * t.u + s * t.v, c * t.v - s * t.u, t.normal;  // where the first come to lie
  const Quaternion turn = Quaternion(to_axes * from_axes.transpose()).normalized();
  return {to_middle - turn * from_middle, turn};
}

bool surfaces_agree(const RigidMotion& motion, const Normals& from, const Normals& to) {
  for (std::size_t corner = 0; corner < 3; ++corner) {
    if (std::abs(dot(motion.turned(from[corner]), to[corner])) < surfels::least_cosine_of_normals)
      return false;
  }
  return true;
}

}  // namespace glocal::ransam
