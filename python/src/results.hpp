// What runs left: tables of trials and steps, comparisons, sweeps.
#pragma once

#include <pybind11/pybind11.h>

namespace glocal::python {

void bind_results(pybind11::module_& module);

}  // namespace glocal::python
