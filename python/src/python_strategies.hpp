// Strategies whose classes are Python's.
#pragma once

#include <memory>

#include "glocal/catalog.hpp"
#include "python/src/python_params.hpp"

namespace glocal::python {

/// Adds it to the registry of its kind. Throws std::invalid_argument if the name is taken.
void add_strategy(Catalog& catalog, const std::shared_ptr<const PythonStrategy>& strategy);

/// What strategies are handed when they are made.
void bind_setups(py::module_& module);

}  // namespace glocal::python
