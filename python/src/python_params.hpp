// Parameters of a strategy in Python: the fields of its dataclass.
#pragma once

#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
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

/// A strategy in Python, as it was registered. Does not move: its fields point into it.
struct PythonStrategy {
  std::string kind, name, doc;
  Motions motions;
  std::vector<std::unique_ptr<const Field>> fields;
  /// Called with the values of all fields by name, and with the setup. Stays in memory to the process's end,
  /// as does the next one: whoever drops a strategy need not hold the GIL.
  py::handle make;
  py::handle make_params;  ///< Called with the values alone; None where all values go together.
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
