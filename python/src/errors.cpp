#include "python/src/errors.hpp"

#include <string_view>

#include "glocal/error.hpp"

namespace glocal::python {
namespace {

/// How a caller in Python knows what the program's user gave with an option.
std::string place_of(const std::string& file) {
  constexpr std::string_view dashes = "--";
  return file.starts_with(dashes) ? file.substr(dashes.size()) : file;
}

py::object as_python(const ConfigError& error) {
  const py::module_ errors = py::module_::import("glocal.errors");
  py::list faults;
  for (const Fault& fault : error.faults())
    faults.append(errors.attr("Fault")(place_of(fault.file), fault.line, fault.column, fault.message));
  return errors.attr("ConfigError")(faults);
}

void raise(const py::object& error) {
  PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(error.ptr())), error.ptr());
}

void raise_named(const char* name, const char* what) {
  raise(py::module_::import("glocal.errors").attr(name)(what));
}

/// A state that Python keeps of this thread.
class KnownThread {
 public:
  KnownThread() : lock_(PyGILState_Ensure()), state_(PyEval_SaveThread()) {}
  ~KnownThread() {
    if (Py_IsInitialized() == 0) return;
    PyEval_RestoreThread(state_);
    PyGILState_Release(lock_);
  }
  KnownThread(const KnownThread&) = delete;
  KnownThread& operator=(const KnownThread&) = delete;

 private:
  PyGILState_STATE lock_;
  PyThreadState* state_;
};

}  // namespace

void stay_known() {
  if (PyGILState_GetThisThreadState() != nullptr) return;
  thread_local const KnownThread thread;
}

void translate_errors() {
  // NOLINTNEXTLINE(performance-unnecessary-value-param): the signature is pybind11's
  py::register_exception_translator([](std::exception_ptr thrown) {
    // What Ctrl-C has ended is not at fault.
    if (PyErr_CheckSignals() != 0) return;
    try {
      if (thrown) std::rethrow_exception(thrown);
    } catch (const ConfigError& error) {
      raise(as_python(error));
    } catch (const StrategyError& error) {
      raise_named("StrategyError", error.what());
    } catch (const RunError& error) {
      raise_named("RunError", error.what());
    }
  });
}

std::string told(const py::error_already_set& error) {
  const py::module_ traceback = py::module_::import("traceback");
  const auto joined = [](const py::object& lines) {
    return py::str("").attr("join")(lines).cast<std::string>();
  };
  const std::string last = joined(traceback.attr("format_exception_only")(error.type(), error.value()));
  const std::string all = joined(traceback.attr("format_exception")(
      error.type(), error.value(), error.trace() ? error.trace() : py::object(py::none())));
  // Once more, after the last Python code that could take it.
  if (error.matches(PyExc_KeyboardInterrupt)) PyErr_SetInterrupt();
  return last + all.substr(0, all.find_last_not_of('\n') + 1);
}

}  // namespace glocal::python
