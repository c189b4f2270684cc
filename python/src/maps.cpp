// Points and the known map.
#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <optional>

#include "pipeline/stage_contracts.hpp"
#include "python/src/conversions.hpp"
#include "python/src/values.hpp"

namespace glocal::python {
namespace {

void bind_points(py::module_& module) {
  using Bound = Seen<Points>;
  py::class_<Bound>(
      module, "Points",
      "N points in metres, one axis after the other. `x`, `y` and `z` are views of the core's memory; "
      "numpy.asarray() makes an N x 3 array, which is a copy.")
      .def(py::init([](const py::object& array) { return Bound(points_of(array)); }), py::arg("array"),
           "From N x 2 or N x 3 numbers, m.")
      .def_property_readonly(
          "x", [](const Bound& p) { return numbers(p->x, p.owner()); }, "N floats, m.")
      .def_property_readonly(
          "y", [](const Bound& p) { return numbers(p->y, p.owner()); }, "N floats, m.")
      .def_property_readonly(
          "z", [](const Bound& p) { return numbers(p->z, p.owner()); }, "N floats, m.")
      .def("__len__", [](const Bound& p) { return p->size(); })
      .def(
          "__array__",
          [](const Bound& p, const py::object& type, std::optional<bool> copy) {
            if (copy && !*copy) throw py::value_error("points are an array only as a copy");
            py::array array = array_of(*p);
            return type.is_none() ? py::object(array) : array.attr("astype")(type);
          },
          py::arg("dtype") = py::none(), py::arg("copy") = py::none())
      .def("__repr__", [](const Bound& p) { return fmt::format("<Points: {}>", p->size()); });
}

OccupancyGrid grid_of(const py::object& cells, double resolution, const py::object& map_from_grid) {
  // Whatever type they have, no number becomes another one that is a cell.
  const auto array = py::array_t<float, py::array::c_style | py::array::forcecast>::ensure(cells);
  if (!array || array.ndim() != 2) {
    PyErr_Clear();
    throw py::value_error(
        "the cells of a grid are wanted as an array of rows x columns, row 0 at the lowest y");
  }
  if (!(resolution > 0.0)) throw py::value_error("the resolution of a grid must be greater than 0 m");
  OccupancyGrid grid;
  if (!map_from_grid.is_none()) grid.map_from_grid = seen_from_above(pose_of(map_from_grid));
  grid.resolution = resolution;
  grid.height = static_cast<int>(array.shape(0));
  grid.width = static_cast<int>(array.shape(1));
  grid.cells = PackedCells(static_cast<std::size_t>(array.size()));
  for (py::ssize_t i = 0; i < array.size(); ++i) {
    const float cell = array.data()[i];
    if (cell != 0.0F && cell != 1.0F && cell != 2.0F)
      throw py::value_error(
          fmt::format("a cell of a grid is 0 (unknown), 1 (free) or 2 (occupied), not {}", cell));
    grid.cells[static_cast<std::size_t>(i)] = static_cast<Cell>(static_cast<std::uint8_t>(cell));
  }
  return grid;
}

void bind_grid(py::module_& module) {
  using Bound = Seen<OccupancyGrid>;
  py::class_<Bound>(module, "OccupancyGrid",
                    "Square cells over a rectangle: 0 is unknown, 1 free, 2 occupied.")
      .def(py::init([](const py::object& cells, double resolution, const py::object& map_from_grid) {
             return Bound(grid_of(cells, resolution, map_from_grid));
           }),
           py::arg("cells"), py::arg("resolution"), py::arg("map_from_grid") = py::none(),
           "From rows x columns cells, row 0 at the lowest y; the side of a cell (m); and the pose of the "
           "outer corner of cell (0, 0) in the map.")
      .def_property_readonly(
          "cells",
          [](const Bound& g) -> py::array {
            py::array_t<std::uint8_t> array({g->height, g->width});
            std::transform(g->cells.begin(), g->cells.end(), array.mutable_data(),
                           [](Cell cell) { return static_cast<std::uint8_t>(cell); });
            array.attr("setflags")(py::arg("write") = false);
            return array;
          },
          "Rows x columns, row 0 at the lowest y; 0 unknown, 1 free, 2 occupied. A copy.")
      .def_property_readonly(
          "resolution", [](const Bound& g) { return g->resolution; }, "Side of a cell, m.")
      .def_property_readonly(
          "map_from_grid", [](const Bound& g) { return Pose3(g->map_from_grid); },
          "Outer corner of cell (0, 0) in the map, and the direction of the columns.");
}

using Map = std::shared_ptr<GlobalMap>;

Map make_map(const py::object& points, const py::object& grid, const py::object& normals,
             const py::object& path, double resolution, const py::object& origin) {
  MapData data;
  if (!origin.is_none()) data.origin = vector_of(origin, "x, y and z (m) of the map's origin");
  if (!grid.is_none()) data.grid = *seen<OccupancyGrid>(grid, "the grid of a map is an OccupancyGrid");
  data.points = points.is_none() ? occupied_centres(data.grid) : points_of(points);
  if (data.points.empty())
    throw py::value_error("a map without any point is none; give points, or a grid with occupied cells");
  if (!normals.is_none()) data.normals = points_of(normals);
  if (!data.normals.empty() && data.normals.size() != data.points.size())
    throw py::value_error(fmt::format("a map has a normal for each point, or none: {} normals for {} points",
                                      data.normals.size(), data.points.size()));
  if (!path.is_none()) data.path = poses_of(path);
  data.resolution = resolution;
  // All that work with the map rely on it. Its motion is not known yet.
  try {
    check_map(data, Motion::free);
  } catch (const BrokenContract& broken) {
    throw py::value_error(fmt::format("this cannot be a map: {}", broken.what()));
  }
  return std::make_shared<GlobalMap>(std::move(data));
}

}  // namespace

void bind_maps(py::module_& module) {
  bind_points(module);
  bind_grid(module);
  const auto part = [](const Map& map, const auto& of_map) { return Seen(of_map, map, nullptr); };
  py::class_<GlobalMap, Map>(
      module, "GlobalMap",
      "The known map. Nothing changes it; all who work with it share it, and what they build of it.")
      .def(py::init(&make_map), py::arg("points") = py::none(), py::arg("grid") = py::none(),
           py::arg("normals") = py::none(), py::arg("path") = py::none(), py::arg("resolution") = 0.0,
           py::arg("origin") = py::none(),
           "From points (N x 2 or N x 3, m) or, without any, from the centres of a grid's occupied cells. "
           "normals: a unit vector for each point. path: poses of the robot that made the map. resolution: "
           "distance of neighbouring points (m) of a map without a grid; 0 if not known. origin: (x, y, z), "
           "m, what is to be added to places of points, grid and path: that of a map far away, whose single "
           "precision would be coarse.")
      .def_property_readonly(
          "points", [part](const Map& map) { return part(map, map->points()); },
          "Occupied places, m, relative to the origin.")
      .def_property_readonly(
          "origin",
          [](const Map& map) {
            const Vector3& p = map->origin();
            return py::make_tuple(p.x(), p.y(), p.z());
          },
          "(x, y, z), m: what is to be added to places of points, grid and path for the map's frame; 0 of "
          "maps up to 1 km away. Stages see poses relative to it, too; results of steps are in the map's "
          "frame.")
      .def_property_readonly(
          "normals", [part](const Map& map) { return part(map, map->normals()); },
          "Unit normals of the points, or none at all.")
      .def_property_readonly(
          "grid", [part](const Map& map) { return part(map, map->grid()); },
          "Free, occupied and unknown cells; 0 x 0 of a map of points alone.")
      .def_property_readonly(
          "path", [](const Map& map) { return array_of_poses(map->path(), std::identity()); },
          "Poses of the robot that made the map, P x 7 (x, y, z, qw, qx, qy, qz).")
      .def_property_readonly(
          "resolution", [](const Map& map) { return map->resolution(); },
          "Side of the grid's cells, or distance of points, m; 0 if not known.")
      .def(
          "place_of",
          [](const Map& map, const py::object& map_from_robot) {
            const MapPlace place = map->place_of(pose_of(map_from_robot));
            return py::make_tuple(place.map, place.map_from_robot);
          },
          py::arg("map_from_robot"),
          "Of several maps side by side (source `several`): the name of the one that the pose lies on, and "
          "the pose in that map's own frame. Of one map: '' and the pose.")
      .def("__repr__", [](const Map& map) {
        return fmt::format("<GlobalMap: {} points, {} x {} cells>", map->points().size(), map->grid().width,
                           map->grid().height);
      });
}

}  // namespace glocal::python
