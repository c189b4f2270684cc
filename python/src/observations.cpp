// Observations, samples and local maps.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include "python/src/conversions.hpp"
#include "python/src/values.hpp"

namespace glocal::python {
namespace {

using BoundObservation = Seen<Observation>;
using BoundLocalMap = Seen<LocalMap>;

std::vector<float> times_of(const py::object& times, std::size_t hits) {
  if (times.is_none()) return {};
  const std::vector<double> read = doubles_of(times, "a time (s) for each hit");
  if (read.size() != hits)
    throw py::value_error(
        fmt::format("a time is wanted for each of {} hits, and not {} times", hits, read.size()));
  std::vector<float> result;
  for (const double time : read) result.push_back(static_cast<float>(time));
  return result;
}

BoundObservation make_observation(const py::object& hits, const py::object& odom_from_robot, double stamp,
                                  const py::object& free_ends, const py::object& origin,
                                  const py::object& times) {
  Observation observation;
  observation.stamp = stamp;
  observation.odom_from_robot = pose_of(odom_from_robot);
  observation.scan.hits = points_of(hits);
  if (!free_ends.is_none()) observation.scan.free_ends = points_of(free_ends);
  if (!origin.is_none())
    observation.scan.origin = as_point(vector_of(origin, "x, y and z (m) of the sensor"));
  observation.scan.times = times_of(times, observation.scan.hits.size());
  return BoundObservation(std::move(observation));
}

/// Ranges below `max_range` are hits; all others are free up to there. NaN is nothing at all.
BoundObservation from_ranges(const py::object& ranges, const py::object& angles, double max_range,
                             const py::object& odom_from_robot, double stamp,
                             const py::object& robot_from_laser) {
  const std::vector<double> r = doubles_of(ranges, "ranges (m) in the order of the beams");
  const std::vector<double> a = doubles_of(angles, "an angle (rad) for each beam");
  if (r.size() != a.size())
    throw py::value_error(
        fmt::format("an angle is wanted for each of {} ranges, and not {} angles", r.size(), a.size()));
  if (!(max_range > 0.0)) throw py::value_error("max_range must be greater than 0 m");
  const Pose3 mount = robot_from_laser.is_none() ? Pose3{} : pose_of(robot_from_laser);
  Observation observation;
  observation.stamp = stamp;
  observation.odom_from_robot = pose_of(odom_from_robot);
  observation.scan.origin = as_point(mount.translation());
  for (std::size_t i = 0; i < r.size(); ++i) {
    if (std::isnan(r[i]) || r[i] <= 0.0) continue;
    const double range = std::min(r[i], max_range);
    const Point end = as_point(mount * Vector3{range * std::cos(a[i]), range * std::sin(a[i]), 0.0});
    (r[i] < max_range ? observation.scan.hits : observation.scan.free_ends).push_back(end);
  }
  return BoundObservation(std::move(observation));
}

void bind_observation(py::module_& module) {
  py::class_<BoundObservation>(
      module, "Observation",
      "What the robot perceives in one step: a scan in the robot's frame, m, and odometry, of which "
      "only the increments mean something.")
      .def(py::init(&make_observation), py::arg("hits"), py::arg("odom_from_robot"), py::arg("stamp") = 0.0,
           py::arg("free_ends") = py::none(), py::arg("origin") = py::none(), py::arg("times") = py::none(),
           "hits: ends of the rays that met something, N x 2 or N x 3. free_ends: of those that met "
           "nothing. origin: the sensor. times: when each hit was measured, s after the stamp.")
      .def_property_readonly(
          "stamp", [](const BoundObservation& o) { return o->stamp; }, "s")
      .def_property_readonly(
          "odom_from_robot", [](const BoundObservation& o) { return o->odom_from_robot; },
          "Odometry, from an arbitrary start.")
      .def_property_readonly(
          "hits", [](const BoundObservation& o) { return o.part(o->scan.hits); },
          "Ends of the rays that met something, in the order of the beams.")
      .def_property_readonly(
          "free_ends", [](const BoundObservation& o) { return o.part(o->scan.free_ends); },
          "Ends of the rays that met nothing; up to there the way is free.")
      .def_property_readonly(
          "origin",
          [](const BoundObservation& o) {
            const Point& p = o->scan.origin;
            return py::make_tuple(p.x, p.y, p.z);
          },
          "The sensor, where all rays begin, as (x, y, z), m.")
      .def_property_readonly(
          "times", [](const BoundObservation& o) { return numbers(o->scan.times, o.owner()); },
          "N floats, s after the stamp; empty if all are of one moment.")
      .def("__repr__", [](const BoundObservation& o) {
        return fmt::format("<Observation: {} hits at {:.3f} s>", o->scan.hits.size(), o->stamp);
      });
  module.def("observation_from_ranges", &from_ranges, py::arg("ranges"), py::arg("angles"),
             py::arg("max_range"), py::arg("odom_from_robot"), py::arg("stamp") = 0.0,
             py::arg("robot_from_laser") = py::none(),
             "An observation of a planar laser, from ranges (m) and angles (rad) of its beams. A range of "
             "max_range or "
             "more met nothing; NaN and 0 are left out. robot_from_laser is where the laser is mounted.");
}

void bind_sample(py::module_& module) {
  using Bound = Seen<Sample>;
  py::class_<Bound>(module, "Sample", "An observation with what only the evaluation may see.")
      .def(py::init([](const BoundObservation& observation, const py::object& map_from_robot, int segment) {
             Sample sample{*observation, std::nullopt, segment};
             if (!map_from_robot.is_none()) sample.map_from_robot = pose_of(map_from_robot);
             return Bound(std::move(sample));
           }),
           py::arg("observation"), py::arg("map_from_robot") = py::none(), py::arg("segment") = 0)
      .def_property_readonly(
          "observation", [](const Bound& s) { return s.part(s->observation); }, "What the robot perceives.")
      .def_property_readonly(
          "map_from_robot", [](const Bound& s) { return s->map_from_robot; }, "Reference pose, or None.")
      .def_property_readonly(
          "map", [](const Bound& s) { return s->map; },
          "Name of the map that map_from_robot is on, in the frame of that map, where there are several.")
      .def_property_readonly(
          "segment", [](const Bound& s) { return s->segment; },
          "A number that changes where the drive is interrupted; no trial runs across.");
}

BoundLocalMap make_local_map(const py::object& points, const py::object& local_from_robot,
                             const std::vector<std::size_t>& ends, const py::object& normals, int epoch) {
  LocalMap map;
  map.points = points_of(points);
  if (!normals.is_none()) map.normals = points_of(normals);
  map.local_from_robot = pose_of(local_from_robot);
  map.ends = ends;
  map.epoch = epoch;
  return BoundLocalMap(std::move(map));
}

}  // namespace

void bind_observations(py::module_& module) {
  bind_observation(module);
  bind_sample(module);
  py::class_<BoundLocalMap>(module, "LocalMap", "Points of all observations so far, in the local frame, m.")
      .def(py::init(&make_local_map), py::arg("points"), py::arg("local_from_robot"), py::arg("ends"),
           py::arg("normals") = py::none(), py::arg("epoch") = 0,
           "ends: how many points there were after each observation. epoch: counts up when the frame is a "
           "new one.")
      .def_property_readonly(
          "points", [](const BoundLocalMap& m) { return m.part(m->points); },
          "All points, in the order in which they came.")
      .def_property_readonly(
          "normals", [](const BoundLocalMap& m) { return m.part(m->normals); },
          "Unit normals of the points, or none at all.")
      .def_property_readonly(
          "local_from_robot", [](const BoundLocalMap& m) { return m->local_from_robot; },
          "Where the robot is now.")
      .def_property_readonly(
          "ends", [](const BoundLocalMap& m) { return numbers(m->ends, m.owner()); },
          "How many points there were after each observation.")
      .def_property_readonly(
          "epoch", [](const BoundLocalMap& m) { return m->epoch; }, "Counts up when the frame is a new one.")
      .def("__repr__", [](const BoundLocalMap& m) {
        return fmt::format("<LocalMap: {} points of {} observations>", m->points.size(), m->ends.size());
      });
}

}  // namespace glocal::python
