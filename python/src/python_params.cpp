#include "python/src/python_params.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include <stdexcept>
#include <type_traits>

#include "python/src/errors.hpp"

namespace glocal::python {
namespace {

FilePath file_path(const py::handle& value) {
  const std::string text = py::str(value);
  return {text, text};
}

/// Of the type that glocal/strategies.py names; `value` is None where there is no default.
FieldValue value_of(const std::string& type, const py::handle& value) {
  const bool none = value.is_none();
  if (type == "bool") return !none && value.cast<bool>();
  if (type == "int") return none ? 0 : value.cast<int>();
  if (type == "float") return none ? 0.0 : value.cast<double>();
  if (type == "float or None") return none ? std::optional<double>{} : value.cast<double>();
  if (type == "str") return none ? std::string() : value.cast<std::string>();
  if (type == "path") return none ? FilePath{} : file_path(value);
  if (type == "floats") return none ? std::vector<double>{} : value.cast<std::vector<double>>();
  if (type == "strs") return none ? std::vector<std::string>{} : value.cast<std::vector<std::string>>();
  std::vector<FilePath> files;
  if (!none) {
    for (const py::handle& file : value) files.push_back(file_path(file));
  }
  return files;
}

FieldValue initial_of(const py::handle& registered) {
  const auto type = registered.attr("type").cast<std::string>();
  const py::object initial = registered.attr("default");
  try {
    return value_of(type, initial);
  } catch (const py::cast_error&) {
    throw py::type_error(fmt::format("the default of the parameter '{}', {}, is no {}",
                                     registered.attr("name").cast<std::string>(),
                                     py::repr(initial).cast<std::string>(), type));
  }
}

std::unique_ptr<const Field> read_field(const py::handle& registered) {
  const auto text = [&](const char* name) { return registered.attr(name).cast<std::string>(); };
  const auto number = [&](const char* name) { return registered.attr(name).cast<double>(); };
  auto field = std::make_unique<Field>(Field{.name = text("name"),
                                             .doc = text("doc"),
                                             .unit = text("unit"),
                                             .info = {.doc = ""},
                                             .initial = initial_of(registered)});
  FieldInfo& info = field->info;
  info.doc = Doc::at_run_time(field->doc);
  info.unit = field->unit.c_str();
  info.min = number("min");
  info.max = number("max");
  info.above = number("above");
  info.choices = registered.attr("choices").cast<std::vector<std::string>>();
  info.min_items = registered.attr("min_items").cast<std::size_t>();
  if (const py::object most = registered.attr("max_items"); !most.is_none())
    info.max_items = most.cast<std::size_t>();
  info.required = registered.attr("required").cast<bool>();
  info.is_folder = registered.attr("is_folder").cast<bool>();
  return field;
}

py::object as_python(const FieldValue& value) {
  return std::visit(
      [](const auto& v) -> py::object {
        using T = std::decay_t<decltype(v)>;
        if constexpr (std::is_same_v<T, FilePath>) {
          return py::cast(v.resolved.string());
        } else if constexpr (std::is_same_v<T, std::vector<FilePath>>) {
          py::list files;
          for (const FilePath& file : v) files.append(file.resolved.string());
          return files;
        } else {
          return py::cast(v);
        }
      },
      value);
}

}  // namespace

std::shared_ptr<const PythonStrategy> read_strategy(const py::object& registered) {
  auto strategy = std::make_shared<PythonStrategy>(registered.attr("make"), registered.attr("make_params"));
  strategy->kind = registered.attr("kind").cast<std::string>();
  strategy->name = registered.attr("name").cast<std::string>();
  strategy->doc = registered.attr("doc").cast<std::string>();
  const py::object motions = registered.attr("motions");
  strategy->motions = {.planar = motions.contains("planar"),
                       .upright = motions.contains("upright"),
                       .free = motions.contains("free")};
  for (const py::handle& field : registered.attr("fields")) strategy->fields.push_back(read_field(field));
  return strategy;
}

PythonParams::PythonParams(std::shared_ptr<const PythonStrategy> strategy) : strategy_(std::move(strategy)) {
  for (const auto& field : strategy_->fields) values_.push_back(field->initial);
}

void PythonParams::visit(ParamVisitor& visitor) {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const Field& field = *strategy_->fields[i];
    std::visit([&](auto& value) { visitor.field(field.name, value, field.info); }, values_[i]);
  }
  if (!values_.empty()) check(visitor);
}

/// The dataclass itself may have rules that span fields.
void PythonParams::check(ParamVisitor& visitor) const {
  const py::gil_scoped_acquire gil;
  if ((*strategy_->make_params).is_none()) return;
  try {
    (*strategy_->make_params)(**values());
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_Exception)) throw std::runtime_error(told(error));  // Ctrl-C
    const std::string rule =
        error.matches(PyExc_ValueError) ? py::str(error.value()).cast<std::string>() : told(error);
    visitor.require(false, strategy_->fields.front()->name, rule);
  }
}

py::dict PythonParams::values() const {
  py::dict values;
  for (std::size_t i = 0; i < values_.size(); ++i)
    values[py::str(strategy_->fields[i]->name)] = as_python(values_[i]);
  return values;
}

}  // namespace glocal::python
