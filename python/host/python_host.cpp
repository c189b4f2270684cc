#include "python/host/python_host.hpp"

#include <pybind11/pybind11.h>

#include <cstdint>
#include <stdexcept>
#include <string>

namespace glocal {
namespace {

namespace py = pybind11;

/// Like the interpreter `executable`, which may be that of a virtual environment. Signals stay the program's.
std::string start(const char* executable) {
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  config.install_signal_handlers = 0;
  config.buffered_stdio = 0;
  config.parse_argv = 0;
  PyStatus status = PyConfig_SetBytesString(&config, &config.program_name, executable);
  if (PyStatus_Exception(status) == 0) status = Py_InitializeFromConfig(&config);
  PyConfig_Clear(&config);
  if (PyStatus_Exception(status) == 0) return "";
  return status.err_msg == nullptr ? "it does not start" : status.err_msg;
}

/// The loader of the package's module. Throws what Python raises, and std::runtime_error for a package of
/// another build.
LoadPythonPlugin find_loader(const char* site, const std::string& build_tag) {
  py::module_::import("sys").attr("path").attr("append")(
      py::reinterpret_steal<py::object>(PyUnicode_DecodeFSDefault(site)));
  // The package itself is imported with it, and with it the place where strategies are registered.
  const py::module_ module = py::module_::import("glocal._core");
  if (module.attr("_build_tag").cast<std::string>() != build_tag)
    throw std::runtime_error("it was built otherwise than this program; build and install both anew");
  return reinterpret_cast<LoadPythonPlugin>(module.attr("_loader").cast<std::uintptr_t>());
}

}  // namespace
}  // namespace glocal

extern "C" __attribute__((visibility("default"))) glocal::LoadPythonPlugin glocal_start_python(
    const char* executable, const char* site, const char* build_tag, void (*tell)(const char* why, void* to),
    void* to) {
  std::string error = glocal::start(executable);
  if (!error.empty()) {
    tell(error.c_str(), to);
    return nullptr;
  }
  glocal::LoadPythonPlugin loader = nullptr;
  try {
    loader = glocal::find_loader(site, build_tag);
  } catch (const pybind11::error_already_set& raised) {
    error = pybind11::str(raised.value()).cast<std::string>();  // what() has the traceback, too
  } catch (const std::runtime_error& refused) {
    error = refused.what();
  }
  if (loader == nullptr) tell(error.empty() ? "an unknown error" : error.c_str(), to);
  // Strategies are called from threads that ask for the lock themselves.
  PyEval_SaveThread();
  return loader;
}
