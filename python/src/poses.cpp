// Pose and Rng.
#include <fmt/format.h>
#include <pybind11/operators.h>

#include "glocal/rng.hpp"
#include "python/src/conversions.hpp"
#include "python/src/values.hpp"

namespace glocal::python {
namespace {

py::array matrix(const Pose3& pose) {
  py::array_t<double> array({4, 4});
  Eigen::Map<Eigen::Matrix<double, 4, 4, Eigen::RowMajor>> m(array.mutable_data());
  m << pose.rotation.toRotationMatrix(), pose.translation(), Eigen::RowVector4d::UnitW();
  return array;
}

std::string text_of(const Pose3& pose) {
  if (pose.is_planar()) return fmt::format("Pose({:.6g}, {:.6g}, {:.6g})", pose.x, pose.y, pose.heading());
  const Quaternion& q = pose.rotation;
  return fmt::format("Pose([{:.6g}, {:.6g}, {:.6g}, {:.6g}, {:.6g}, {:.6g}, {:.6g}])", pose.x, pose.y, pose.z,
                     q.w(), q.x(), q.y(), q.z());
}

/// As pose_of() takes them.
py::tuple numbers_of_pose(const Pose3& pose) {
  const Quaternion& q = pose.rotation;
  return py::make_tuple(pose.x, pose.y, pose.z, q.w(), q.x(), q.y(), q.z());
}

/// One number, or an array of that many.
template <class Draw>
py::object drawn(const std::optional<std::size_t>& size, Draw draw) {
  if (!size) return py::cast(draw());
  py::array_t<decltype(draw())> array(*size);
  for (auto* value = array.mutable_data(); value != array.data() + *size; ++value) *value = draw();
  return array;
}

void bind_rng(py::module_& module) {
  using Size = std::optional<std::size_t>;
  py::class_<Rng>(
      module, "Rng",
      "Random numbers that are the same on every machine. Each step hands its stages a stream of their own.")
      .def(py::init<std::uint64_t>(), py::arg("seed"))
      .def(
          "uniform",
          [](Rng& rng, double low, double high, const Size& size) {
            return drawn(size, [&] { return rng.uniform(low, high); });
          },
          py::arg("low") = 0.0, py::arg("high") = 1.0, py::arg("size") = Size{}, "Uniform in [low, high).")
      .def(
          "normal",
          [](Rng& rng, double standard_deviation, const Size& size) {
            return drawn(size, [&] { return rng.normal(standard_deviation); });
          },
          py::arg("standard_deviation") = 1.0, py::arg("size") = Size{}, "Normal with mean 0.")
      .def(
          "below",
          [](Rng& rng, std::uint32_t n, const Size& size) {
            if (n == 0) throw py::value_error("there is no number below 0; n must be 1 or more");
            return drawn(size, [&] { return static_cast<std::int64_t>(rng.below(n)); });
          },
          py::arg("n"), py::arg("size") = Size{}, "Integers, uniform in [0, n).")
      .def("next", &Rng::next, "An integer of 64 bits; good as a seed.")
      .def(
          "stream", [](const Rng& rng, std::uint64_t name) { return rng.stream({name}); }, py::arg("name"),
          "An independent generator with a number as its name. Does not advance this one.");
}

}  // namespace

void bind_poses(py::module_& module) {
  py::class_<Pose3>(
      module, "Pose",
      "A rigid motion, an element of SE(3). A pose named `target_from_source` maps source coordinates to "
      "target coordinates. In the plane z is 0 and it turns about z only.")
      .def(py::init([](double x, double y, double heading) {
             return Pose3(Pose2{x, y, wrap_angle(heading)});
           }),
           py::arg("x") = 0.0, py::arg("y") = 0.0, py::arg("heading") = 0.0,
           "A pose in the plane: m, m, rad.")
      .def(py::init([](const py::object& numbers) { return pose_of(numbers); }), py::arg("numbers"),
           "From (x, y, heading), from (x, y, z, qw, qx, qy, qz), or from a 4 x 4 matrix.")
      .def_readonly("x", &Pose3::x, "m")
      .def_readonly("y", &Pose3::y, "m")
      .def_readonly("z", &Pose3::z, "m")
      .def_property_readonly("heading", &Pose3::heading,
                             "Direction of the x axis seen from above, rad, in (-pi, pi].")
      .def_property_readonly(
          "quaternion",
          [](const Pose3& p) {
            return py::make_tuple(p.rotation.w(), p.rotation.x(), p.rotation.y(), p.rotation.z());
          },
          "The rotation as (w, x, y, z).")
      .def_property_readonly("is_planar", &Pose3::is_planar, "Whether z is 0 and nothing tilts.")
      .def("matrix", &matrix, "4 x 4, homogeneous.")
      .def(
          "inverse", [](const Pose3& p) { return inverse(p); }, "`source_from_target`.")
      .def(
          "__mul__", [](const Pose3& a, const Pose3& b) { return a * b; }, py::is_operator(),
          py::arg("other"), "`a_from_c = a_from_b * b_from_c`.")
      .def(
          "transform",
          [](const Pose3& pose, const py::object& points) {
            return array_of(moved(points_of(points), pose));
          },
          py::arg("points"),
          "Points (N x 2 or N x 3, m, in the source's frame) in the target's frame: N x 3 floats.")
      .def(
          "distance_to", [](const Pose3& a, const Pose3& b) { return distance(a, b); }, py::arg("other"),
          "Between the origins, m.")
      .def(
          "rotation_to", [](const Pose3& a, const Pose3& b) { return rotation_between(a, b); },
          py::arg("other"), "Smallest rotation between the two, rad, in [0, pi].")
      .def(
          "__eq__",
          [](const Pose3& a, const py::object& b) {
            return py::isinstance<Pose3>(b) && a == b.cast<Pose3>();
          },
          py::arg("other"))
      .def("__hash__", [](const Pose3& p) { return py::hash(numbers_of_pose(p)); })
      .def("__repr__", &text_of)
      .def(py::pickle(&numbers_of_pose, [](const py::tuple& state) { return pose_of(state); }));
  bind_rng(module);
}

}  // namespace glocal::python
