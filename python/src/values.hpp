// The values that stages exchange, as classes of Python.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "glocal/global_map.hpp"
#include "glocal/local_map.hpp"
#include "glocal/observation.hpp"
#include "glocal/step_result.hpp"
#include "glocal/strategies.hpp"
#include "python/src/seen.hpp"

namespace glocal::python {

using SeenHypotheses = Seen<std::vector<Hypothesis>>;

/// The value of a Python object of a class that is bound as Seen<T>. Throws py::value_error that names `what`
/// for any other object.
template <class T>
[[nodiscard]] const Seen<T>& seen(const py::handle& object, const char* what) {
  if (!py::isinstance<Seen<T>>(object))
    throw py::value_error(std::string(what) + ", and not " + std::string(py::repr(object)));
  return object.cast<const Seen<T>&>();
}

void bind_poses(py::module_& module);
void bind_maps(py::module_& module);
void bind_observations(py::module_& module);
void bind_hypotheses(py::module_& module);
void bind_steps(py::module_& module);
void bind_contact(py::module_& module);

}  // namespace glocal::python
