// Poses, points and texts between Python and the core. All throw py::value_error that tells what is wanted.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <functional>
#include <string>
#include <vector>

#include "glocal/experiment.hpp"
#include "glocal/points.hpp"
#include "glocal/pose3.hpp"

namespace glocal::python {

namespace py = pybind11;

/// Numbers that make up a pose: x, y, z, qw, qx, qy, qz.
inline constexpr py::ssize_t pose_numbers = 7;

/// Of a Pose, of (x, y, heading), of the seven numbers, or of a 4 x 4 matrix.
[[nodiscard]] Pose3 pose_of(const py::handle& value);
/// Of a list of these, or of an array with a row for each.
[[nodiscard]] std::vector<Pose3> poses_of(const py::handle& value);

/// N x 7 numbers of the poses that rows have, a copy; `pose_of` is a member or a function.
template <class Row, class PoseOf>
[[nodiscard]] py::array array_of_poses(const std::vector<Row>& rows, PoseOf pose_of) {
  py::array_t<double> array({static_cast<py::ssize_t>(rows.size()), pose_numbers});
  double* number = array.mutable_data();
  for (const Row& row : rows) {
    const Pose3& p = std::invoke(pose_of, row);
    const Quaternion& q = p.rotation;
    for (const double value : {p.x, p.y, p.z, q.w(), q.x(), q.y(), q.z()}) *number++ = value;
  }
  return array;
}

/// Of an array of N x 2 or N x 3 numbers (m).
[[nodiscard]] Points points_of(const py::handle& value);

/// N x 3 floats.
[[nodiscard]] py::array array_of(const Points& points);

/// N numbers; `what` is said of others.
[[nodiscard]] std::vector<double> doubles_of(const py::handle& value, const char* what);

/// Three numbers; `what` is said of others.
[[nodiscard]] Vector3 vector_of(const py::handle& value, const char* what);

/// Pairs of paths and values, both texts.
[[nodiscard]] std::vector<Override> overrides_of(const py::list& pairs);

}  // namespace glocal::python
