// The module glocal._core: the framework as Python sees it. What users call is in the package's own files.
#include <pybind11/pybind11.h>

#include "python/src/errors.hpp"
#include "python/src/experiments.hpp"
#include "python/src/python_strategies.hpp"
#include "python/src/results.hpp"
#include "python/src/session.hpp"
#include "python/src/values.hpp"
#include "version.hpp"

PYBIND11_MODULE(_core, module) {
  using namespace glocal::python;
  module.doc() = "The C++ core of glocal.";
  module.attr("version") = glocal::version;
  translate_errors();
  bind_poses(module);
  bind_maps(module);
  bind_observations(module);
  bind_hypotheses(module);
  bind_steps(module);
  bind_contact(module);
  bind_setups(module);
  bind_session(module);
  bind_experiments(module);
  bind_results(module);
}
