#include "python/host/python_host.hpp"

#include <Python.h>

#include <string>

namespace glocal {
namespace {

/// A reference to an object of Python, or null.
class Reference {
 public:
  explicit Reference(PyObject* object) : object_(object) {}
  ~Reference() { Py_XDECREF(object_); }
  Reference(const Reference&) = delete;
  Reference& operator=(const Reference&) = delete;
  [[nodiscard]] PyObject* get() const { return object_; }
  explicit operator bool() const { return object_ != nullptr; }

 private:
  PyObject* object_;
};

std::string text_of(PyObject* object) {
  const Reference text(object == nullptr ? nullptr : PyObject_Str(object));
  const char* utf8 = text ? PyUnicode_AsUTF8(text.get()) : nullptr;
  PyErr_Clear();
  return utf8 == nullptr ? "" : utf8;
}

/// What was raised last, and forgets it.
std::string last_error() {
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  const Reference held_type(type), held_value(value), held_trace(trace);
  const std::string text = text_of(value);
  return text.empty() ? "an unknown error" : text;
}

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

bool add_site(const char* site) {
  PyObject* path = PySys_GetObject("path");
  const Reference folder(PyUnicode_DecodeFSDefault(site));
  return path != nullptr && folder && PyList_Append(path, folder.get()) == 0;
}

/// The loader of the package's module; null, with an error, if there is none that fits.
LoadPythonPlugin find_loader(const char* build_tag, std::string& error) {
  const Reference module(PyImport_ImportModule("glocal._core"));
  // The package itself is imported with it, and with it the place where strategies are registered.
  const Reference tag(module ? PyObject_GetAttrString(module.get(), "_build_tag") : nullptr);
  const Reference loader(tag ? PyObject_GetAttrString(module.get(), "_loader") : nullptr);
  if (!loader) {
    error = last_error();
    return nullptr;
  }
  if (text_of(tag.get()) != build_tag) {
    error = "it was built otherwise than this program; build and install both anew";
    return nullptr;
  }
  void* function = PyLong_AsVoidPtr(loader.get());
  if (function == nullptr) error = last_error();
  return reinterpret_cast<LoadPythonPlugin>(function);
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
  if (glocal::add_site(site)) {
    loader = glocal::find_loader(build_tag, error);
  } else {
    error = glocal::last_error();
  }
  if (loader == nullptr) tell(error.c_str(), to);
  // Strategies are called from threads that ask for the lock themselves.
  PyEval_SaveThread();
  return loader;
}
