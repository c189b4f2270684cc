// Parameters of a strategy in Python: the fields of its dataclass.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "glocal/motion.hpp"
#include "glocal/params.hpp"

namespace glocal::python {

namespace py = pybind11;

/// A field's value, of any type that a parameter can have.
using FieldValue = std::variant<bool, int, double, std::optional<double>, std::string, FilePath,
                                std::vector<double>, std::vector<std::string>, std::vector<FilePath>>;

struct Field {
  std::string name;
  std::string doc, unit;
  FieldInfo info;  ///< Points to the texts.
  FieldValue initial;
};

/// An object of Python that any thread may drop; after the end of the interpreter nobody can.
class Held {
 public:
  explicit Held(py::object object) : object_(std::move(object)) {}
  ~Held() {
    if (Py_IsInitialized() == 0) {
      object_.release();
      return;
    }
    const py::gil_scoped_acquire gil;
    object_ = py::object();
  }
  Held(const Held&) = delete;
  Held& operator=(const Held&) = delete;

  /// The GIL is held.
  [[nodiscard]] const py::object& operator*() const { return object_; }

 private:
  py::object object_;
};

/// A strategy in Python, as it was registered. Does not move: its fields point into it.
struct PythonStrategy {
  PythonStrategy(py::object makes, py::object makes_params)
      : make(std::move(makes)), make_params(std::move(makes_params)) {}

  std::string kind, name, doc;
  Motions motions;
  std::vector<std::unique_ptr<const Field>> fields;
  Held make;         ///< Called with the values of all fields by name, and with the setup.
  Held make_params;  ///< Called with the values alone; None where all values go together.
};

/// Of an object as glocal/strategies.py makes it.
[[nodiscard]] std::shared_ptr<const PythonStrategy> read_strategy(const py::object& registered);

/// The values of one use of it.
class PythonParams final : public AnyParams {
 public:
  explicit PythonParams(std::shared_ptr<const PythonStrategy> strategy);
  void visit(ParamVisitor& visitor) override;
  [[nodiscard]] std::unique_ptr<AnyParams> clone() const override {
    return std::make_unique<PythonParams>(*this);
  }

  /// By name; files as they are resolved. The GIL is held.
  [[nodiscard]] py::dict values() const;

 private:
  void check(ParamVisitor& visitor) const;

  std::shared_ptr<const PythonStrategy> strategy_;
  std::vector<FieldValue> values_;
};

}  // namespace glocal::python
