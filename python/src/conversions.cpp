#include "python/src/conversions.hpp"

#include <fmt/format.h>

namespace glocal::python {
namespace {

using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

std::string shape_of(const py::array& array) {
  return py::str(array.attr("shape"));
}

/// As numbers; a value_error where it is no array of any.
Doubles numbers_of(const py::handle& value, const char* what) {
  Doubles array = Doubles::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw py::value_error(fmt::format("{} is wanted, and not {}", what, std::string(py::repr(value))));
  }
  return array;
}

constexpr const char* what_pose =
    "a pose (a Pose, x, y and heading, x, y, z, qw, qx, qy and qz, or a 4 x 4 matrix)";

Pose3 planar(const double* row) {
  return Pose2{row[0], row[1], wrap_angle(row[2])};
}

Pose3 in_space(const double* row) {
  const Quaternion q{row[3], row[4], row[5], row[6]};
  const double length = q.norm();
  // So near to one that rounding explains it.
  constexpr double tolerance = 1e-6;
  if (!(std::abs(length - 1.0) < tolerance))
    throw py::value_error(
        fmt::format("a pose's quaternion (qw, qx, qy, qz) must have the length 1, not {}", length));
  return {{row[0], row[1], row[2]}, q};
}

/// Of a matrix, row by row.
Pose3 of_matrix(const double* m) {
  const Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> matrix(m);
  const Eigen::Matrix3d rotation = matrix.topLeftCorner<3, 3>();
  constexpr double tolerance = 1e-6;
  if (!rotation.isUnitary(tolerance) || !(rotation.determinant() > 0.0) ||
      !matrix.row(3).isApprox(Eigen::RowVector4d::UnitW(), tolerance))
    throw py::value_error("a pose's matrix must be a rotation, a translation and the last row 0, 0, 0, 1");
  return {matrix.topRightCorner<3, 1>(), Quaternion(rotation).normalized()};
}

constexpr py::ssize_t planar_numbers = 3;
constexpr py::ssize_t matrix_rows = 4;

}  // namespace

Pose3 pose_of(const py::handle& value) {
  if (py::isinstance<Pose3>(value)) return value.cast<Pose3>();
  const Doubles array = numbers_of(value, what_pose);
  if (array.ndim() == 2 && array.shape(0) == matrix_rows && array.shape(1) == matrix_rows)
    return of_matrix(array.data());
  if (array.ndim() == 1 && array.size() == planar_numbers) return planar(array.data());
  if (array.ndim() == 1 && array.size() == pose_numbers) return in_space(array.data());
  throw py::value_error(
      fmt::format("{} is wanted, and not an array of shape {}", what_pose, shape_of(array)));
}

std::vector<Pose3> poses_of(const py::handle& value) {
  std::vector<Pose3> poses;
  if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    for (const py::handle& item : value) poses.push_back(pose_of(item));
    return poses;
  }
  constexpr const char* what = "an array with a row of 3 or 7 numbers for each pose";
  const Doubles array = numbers_of(value, what);
  if (array.ndim() != 2 || (array.shape(1) != planar_numbers && array.shape(1) != pose_numbers))
    throw py::value_error(fmt::format("{} is wanted, and not one of shape {}", what, shape_of(array)));
  const bool is_planar = array.shape(1) == planar_numbers;
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const double* row = array.data(i, 0);
    poses.push_back(is_planar ? planar(row) : in_space(row));
  }
  return poses;
}

Points points_of(const py::handle& value) {
  constexpr const char* what = "points as an array of N x 2 or N x 3 numbers";
  const auto array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(value);
  if (!array) {
    PyErr_Clear();
    throw py::value_error(fmt::format("{} are wanted, and not {}", what, std::string(py::repr(value))));
  }
  Points points;
  if (array.size() == 0) return points;
  if (array.ndim() != 2 || (array.shape(1) != 2 && array.shape(1) != 3))
    throw py::value_error(fmt::format("{} are wanted, and not one of shape {}", what, shape_of(array)));
  points.reserve(static_cast<std::size_t>(array.shape(0)));
  for (py::ssize_t i = 0; i < array.shape(0); ++i) {
    const float* row = array.data(i, 0);
    points.push_back({row[0], row[1], array.shape(1) == 3 ? row[2] : 0.0F});
  }
  return points;
}

py::array array_of(const Points& points) {
  py::array_t<float> array({points.size(), std::size_t{3}});
  auto rows = array.mutable_unchecked<2>();
  for (std::size_t i = 0; i < points.size(); ++i) {
    const auto row = static_cast<py::ssize_t>(i);
    rows(row, 0) = points.x[i];
    rows(row, 1) = points.y[i];
    rows(row, 2) = points.z[i];
  }
  return array;
}

std::vector<double> doubles_of(const py::handle& value, const char* what) {
  const Doubles array = numbers_of(value, what);
  if (array.ndim() != 1)
    throw py::value_error(fmt::format("{} is wanted, and not an array of shape {}", what, shape_of(array)));
  return {array.data(), array.data() + array.size()};
}

Vector3 vector_of(const py::handle& value, const char* what) {
  const std::vector<double> numbers = doubles_of(value, what);
  if (numbers.size() != 3) throw py::value_error(fmt::format("{} are wanted", what));
  return {numbers[0], numbers[1], numbers[2]};
}

std::vector<Override> overrides_of(const py::list& pairs) {
  std::vector<Override> overrides;
  for (const py::handle& pair : pairs) {
    const auto both = py::reinterpret_borrow<py::tuple>(pair);
    overrides.emplace_back(both[0].cast<std::string>(), both[1].cast<std::string>());
  }
  return overrides;
}

}  // namespace glocal::python
