// Hypotheses, clusters and ratings: lists of structs whose members Python sees as columns.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "python/src/conversions.hpp"
#include "python/src/values.hpp"

namespace glocal::python {
namespace {

using Clusters = Seen<std::vector<Cluster>>;
using Ratings = Seen<std::vector<Rating>>;

constexpr double most_proposals = 0x1p53;  // Doubles tell all whole numbers up to this one apart.

/// Of so many poses, one for each.
std::vector<double> of_each_pose(const py::object& values, const char* what, std::size_t poses) {
  std::vector<double> numbers = doubles_of(values, fmt::format("the {} of each pose", what).c_str());
  if (numbers.size() != poses)
    throw py::value_error(fmt::format("the {} is wanted for each of {} poses, and not {} of them", what,
                                      poses, numbers.size()));
  return numbers;
}

SeenHypotheses make_hypotheses(const py::object& map_from_local, const py::object& quality,
                               const py::object& score, const py::object& support) {
  const std::vector<Pose3> poses = poses_of(map_from_local);
  const std::vector<double> omega = of_each_pose(quality, "quality", poses.size());
  const std::vector<double> scores = score.is_none() ? omega : of_each_pose(score, "score", poses.size());
  const std::vector<double> supports =
      support.is_none() ? std::vector(poses.size(), 1.0) : of_each_pose(support, "support", poses.size());
  std::vector<Hypothesis> hypotheses;
  hypotheses.reserve(poses.size());
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!(supports[i] >= 1.0 && supports[i] <= most_proposals && supports[i] == std::floor(supports[i])))
      throw py::value_error(
          "the support of a pose is the number of proposals it stands for: a whole number, 1 or more");
    Hypothesis h = Hypothesis::by_contact(poses[i], omega[i]);
    h.score = scores[i];
    h.support = static_cast<std::size_t>(supports[i]);
    hypotheses.push_back(h);
  }
  std::ranges::stable_sort(hypotheses, std::greater<>(), &Hypothesis::score);
  return SeenHypotheses(std::move(hypotheses));
}

/// A number in each struct.
template <class Struct, class Number>
py::array column_of(const Seen<std::vector<Struct>>& rows, Number Struct::*number) {
  static const Struct none{};
  const Struct& first = rows->empty() ? none : rows->front();
  return column(*rows, &(first.*number), rows.owner());
}

void bind_list_of_hypotheses(py::module_& module) {
  using Bound = SeenHypotheses;
  py::class_<Bound>(
      module, "Hypotheses",
      "Proposed poses, best score first. Each column is an array with an entry for each; poses have seven "
      "numbers: x, y, z (m), qw, qx, qy, qz.")
      .def(py::init(&make_hypotheses), py::arg("map_from_local"), py::arg("quality"),
           py::arg("score") = py::none(), py::arg("support") = py::none(),
           "map_from_local: poses of the local map in the map, N x 3 (x, y, heading) or N x 7. quality: "
           "Omega (eq. 4), share "
           "of local points in contact. score: what they are ranked by, the quality unless given. support: "
           "how many proposals each stands for, a whole number. They are sorted by falling score.")
      .def("__len__", [](const Bound& h) { return h->size(); })
      .def_property_readonly(
          "map_from_local", [](const Bound& h) { return array_of_poses(*h, &Hypothesis::map_from_local); },
          "N x 7")
      .def_property_readonly(
          "map_from_robot", [](const Bound& h) { return array_of_poses(*h, &Hypothesis::map_from_robot); },
          "N x 7; set by the localizer.")
      .def_property_readonly(
          "heading",
          [](const Bound& h) -> py::array {
            py::array_t<double> array(static_cast<py::ssize_t>(h->size()));
            std::transform(h->begin(), h->end(), array.mutable_data(),
                           [](const Hypothesis& x) { return x.map_from_robot.heading(); });
            return array;
          },
          "Of map_from_robot, rad, in (-pi, pi]; N numbers, computed.")
      .def_property_readonly(
          "quality", [](const Bound& h) { return column_of(h, &Hypothesis::quality); },
          "Omega (eq. 4), in [0, 1].")
      .def_property_readonly(
          "score", [](const Bound& h) { return column_of(h, &Hypothesis::score); },
          "What the matcher ranks by, in [0, 1].")
      .def_property_readonly(
          "support", [](const Bound& h) { return column_of(h, &Hypothesis::support); },
          "How many proposals each stands for.")
      .def("__repr__", [](const Bound& h) { return fmt::format("<Hypotheses: {}>", h->size()); });
}

void bind_clusters(py::module_& module) {
  using One = Seen<Cluster>;
  py::class_<One>(module, "Cluster", "Hypotheses that mean the same robot pose.")
      .def_property_readonly(
          "members", [](const One& c) { return numbers(c->members, c.owner()); },
          "Indexes into the hypotheses of the step, ascending.")
      .def_property_readonly(
          "map_from_robot", [](const One& c) { return c->map_from_robot; }, "The mean pose.")
      .def_property_readonly(
          "variances",
          [](const One& c) {
            return py::make_tuple(c->variance_x, c->variance_y, c->variance_z, c->variance_about_x,
                                  c->variance_about_y, c->variance_theta);
          },
          "Along x, y, z (m^2) and about x, y, z (rad^2) of the map (eq. 6).")
      .def("__len__", [](const One& c) { return c->members.size(); });
  py::class_<Clusters>(module, "Clusters", "Clusters of a step, best rating first once they are rated.")
      .def("__len__", [](const Clusters& c) { return c->size(); })
      .def(
          "__getitem__",
          [](const Clusters& c, py::ssize_t i) {
            const auto n = static_cast<py::ssize_t>(c->size());
            if (i < -n || i >= n) throw py::index_error(fmt::format("cluster {} of {}", i, n));
            return c.part((*c)[static_cast<std::size_t>(i < 0 ? i + n : i)]);
          },
          py::arg("index"))
      .def_property_readonly(
          "map_from_robot", [](const Clusters& c) { return array_of_poses(*c, &Cluster::map_from_robot); },
          "The mean poses, N x 7 (x, y, z, qw, qx, qy, qz).")
      .def_property_readonly(
          "sizes",
          [](const Clusters& c) -> py::array {
            py::array_t<std::int64_t> array(static_cast<py::ssize_t>(c->size()));
            std::transform(c->begin(), c->end(), array.mutable_data(),
                           [](const Cluster& x) { return static_cast<std::int64_t>(x.members.size()); });
            return array;
          },
          "How many hypotheses each has, N integers, computed.");
  py::class_<Ratings>(module, "Ratings", "How much each cluster deserves trust.")
      .def("__len__", [](const Ratings& r) { return r->size(); })
      .def_property_readonly(
          "r", [](const Ratings& r) { return column_of(r, &Rating::r); }, "Of eq. 7, in [0, 1].")
      .def_property_readonly(
          "r_normalised", [](const Ratings& r) { return column_of(r, &Rating::r_normalised); },
          "Of eq. 8; they add up to 1.");
}

}  // namespace

void bind_hypotheses(py::module_& module) {
  bind_list_of_hypotheses(module);
  bind_clusters(module);
  py::class_<MatchResult>(module, "MatchResult", "What a matcher found in one step, and what it did for it.")
      .def(py::init([](const SeenHypotheses& hypotheses, std::size_t proposals, std::size_t points_tested) {
             return MatchResult{*hypotheses, proposals, points_tested};
           }),
           py::arg("hypotheses"), py::arg("proposals") = 0, py::arg("points_tested") = 0,
           "proposals: poses proposed before any of them was judged. points_tested: single points tested for "
           "contact.");
}

}  // namespace glocal::python
