// Point sets, stored one axis after the other so that inner loops run over contiguous floats.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "glocal/pose3.hpp"

namespace glocal {

/// A point in metres.
struct Point {
  float x = 0.0F;
  float y = 0.0F;
  float z = 0.0F;

  friend bool operator==(const Point&, const Point&) = default;
};

[[nodiscard]] inline Point operator+(const Point& a, const Point& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
[[nodiscard]] inline Point operator-(const Point& a, const Point& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
[[nodiscard]] inline Point operator*(float factor, const Point& p) {
  return {factor * p.x, factor * p.y, factor * p.z};
}
[[nodiscard]] inline float dot(const Point& a, const Point& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
[[nodiscard]] inline Point cross(const Point& a, const Point& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
[[nodiscard]] inline float length(const Point& p) {
  return std::sqrt(dot(p, p));
}

/// N points in metres; x, y and z always have the same length. A planar laser has z = 0.
struct Points {
  std::vector<float> x;
  std::vector<float> y;
  std::vector<float> z;

  [[nodiscard]] std::size_t size() const { return x.size(); }
  [[nodiscard]] bool empty() const { return x.empty(); }
  [[nodiscard]] Point operator[](std::size_t i) const { return {x[i], y[i], z[i]}; }

  void reserve(std::size_t n) {
    x.reserve(n);
    y.reserve(n);
    z.reserve(n);
  }
  void push_back(const Point& p) {
    x.push_back(p.x);
    y.push_back(p.y);
    z.push_back(p.z);
  }
  void set(std::size_t i, const Point& p) {
    x[i] = p.x;
    y[i] = p.y;
    z[i] = p.z;
  }
  void clear() {
    x.clear();
    y.clear();
    z.clear();
  }

  friend bool operator==(const Points&, const Points&) = default;
};

/// The points as they are in the target's frame.
[[nodiscard]] Points moved(const Points& points, const Pose3& target_from_source);

/// Their mean; there is at least one.
[[nodiscard]] Vector3 centroid(const Points& points);

[[nodiscard]] inline Vector3 as_vector(const Point& p) {
  return {p.x, p.y, p.z};
}
/// In single precision.
[[nodiscard]] inline Point as_point(const Vector3& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// A pose in the plane with its sine and cosine at hand, for moving many points. Heights stay as they are.
class Transform {
 public:
  explicit Transform(const Pose2& target_from_source)
      : c_(static_cast<float>(std::cos(target_from_source.theta))),
        s_(static_cast<float>(std::sin(target_from_source.theta))),
        tx_(static_cast<float>(target_from_source.x)),
        ty_(static_cast<float>(target_from_source.y)) {}
  /// From the cosine and sine of the rotation, and the translation in metres.
  Transform(float cosine, float sine, float x, float y) : c_(cosine), s_(sine), tx_(x), ty_(y) {}

  [[nodiscard]] Point operator()(const Point& p) const {
    return {c_ * p.x - s_ * p.y + tx_, s_ * p.x + c_ * p.y + ty_, p.z};
  }
  [[nodiscard]] float cosine() const { return c_; }
  [[nodiscard]] float sine() const { return s_; }
  [[nodiscard]] float x() const { return tx_; }
  [[nodiscard]] float y() const { return ty_; }
  [[nodiscard]] Pose2 pose() const { return {tx_, ty_, wrap_angle(std::atan2(s_, c_))}; }

 private:
  float c_, s_, tx_, ty_;
};

/// Motions in the plane, as Transform has them. A few hundred: few enough to stay in the fastest memory from
/// stage to stage, a multiple of every vector's length.
struct MotionBatch {
  static constexpr std::size_t capacity = 256;

  alignas(64) std::array<float, capacity> cosine{};
  alignas(64) std::array<float, capacity> sine{};
  alignas(64) std::array<float, capacity> x{};
  alignas(64) std::array<float, capacity> y{};

  [[nodiscard]] Transform operator[](std::size_t i) const { return {cosine[i], sine[i], x[i], y[i]}; }
};

}  // namespace glocal
