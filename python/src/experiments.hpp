// Experiments, and runs of them.
#pragma once

#include <pybind11/pybind11.h>

namespace glocal::python {

void bind_experiments(pybind11::module_& module);

}  // namespace glocal::python
