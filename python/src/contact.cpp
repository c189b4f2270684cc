// Contact with the map, for matchers and raters of Python.
#include "glocal/contact.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/src/conversions.hpp"
#include "python/src/values.hpp"

namespace glocal::python {
namespace {

using Index = std::shared_ptr<ContactIndex>;

/// Points of the core are not copied, unless they are lent.
py::array shares(const ContactIndex& index, const py::object& points, const py::object& poses) {
  const Seen<Points> all = py::isinstance<Seen<Points>>(points) ? points.cast<const Seen<Points>&>().kept()
                                                                : Seen(points_of(points));
  const std::vector<Pose3> moves = poses_of(poses);
  py::array_t<double> result(static_cast<py::ssize_t>(moves.size()));
  double* out = result.mutable_data();
  const py::gil_scoped_release others_may;
  for (const Pose3& pose : moves) {
    *out++ = pose.is_planar() ? index.share(*all, Transform(seen_from_above(pose))) : index.share(*all, pose);
  }
  return result;
}

Index make_index(const std::shared_ptr<GlobalMap>& map, double epsilon, const std::string& name) {
  if (!(epsilon > 0.0)) throw py::value_error("epsilon must be greater than 0 m");
  if (name != "bitset" && name != "kd_tree")
    throw py::value_error(fmt::format("there is no contact index '{}'; there are bitset and kd_tree", name));
  const py::gil_scoped_release others_may;
  return std::const_pointer_cast<ContactIndex>(contact_index(*map, ContactChoice(name.c_str()), epsilon));
}

}  // namespace

void bind_contact(py::module_& module) {
  py::class_<ContactIndex, Index>(module, "ContactIndex",
                                  "Tells which points are within epsilon of a point of the map.")
      .def("share", &shares, py::arg("points"), py::arg("poses"),
           "Share of the points (m, local frame) in contact, Omega of eq. 4, at each pose (N x 3: x, y, "
           "heading; or N x 7): N numbers in [0, 1]. Lets other threads run meanwhile.");
  module.def("contact_index", &make_index, py::arg("map").none(false), py::arg("epsilon"),
             py::arg("name") = "bitset",
             "The contact index of a map for an epsilon (m), built once and shared. `bitset` takes constant "
             "time for a point, `kd_tree` is exact.");
}

}  // namespace glocal::python
