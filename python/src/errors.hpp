// Exceptions on their way between Python and the core.
#pragma once

#include <pybind11/pybind11.h>

#include <string>

namespace glocal::python {

namespace py = pybind11;

/// Lets errors of the core arrive in Python as those of glocal/errors.py.
void translate_errors();

/// What happened in Python: its last line, then the traceback. Ctrl-C is told to whoever has called the core,
/// too.
[[nodiscard]] std::string told(const py::error_already_set& error);

/// Lets Python know this thread until it ends: to get to know it anew for each call takes several
/// microseconds.
void stay_known();

/// Does something with Python's objects, from any thread. What Python raises becomes a std::runtime_error
/// with the traceback.
template <class Work>
auto with_python(Work work) {
  stay_known();
  const py::gil_scoped_acquire gil;
  try {
    return work();
  } catch (const py::error_already_set& error) {
    throw std::runtime_error(told(error));
  }
}

}  // namespace glocal::python
