// What Python sees of the core's values: where they lie, without a copy, as long as somebody keeps them.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace glocal::python {

namespace py = pybind11;

/// Keeps a value in memory; empty for what the core has only lent.
using Owner = std::shared_ptr<const void>;

/// For as long as it lives, values of the core are lent to Python: to a strategy's method while it runs.
class Loan {
 public:
  Loan() = default;
  /// Not while somebody reads: a thread that a strategy has left behind may.
  ~Loan() {
    const py::gil_scoped_acquire gil;
    *lasts_ = false;
  }
  Loan(const Loan&) = delete;
  Loan& operator=(const Loan&) = delete;

  [[nodiscard]] const std::shared_ptr<const bool>& lasts() const { return is_lasting_; }

 private:
  std::shared_ptr<bool> lasts_ = std::make_shared<bool>(true);
  std::shared_ptr<const bool> is_lasting_ = lasts_;
};

/// A value that Python owns together with whoever else does, or that was lent.
template <class T>
class Seen {
 public:
  /// Owned.
  explicit Seen(std::shared_ptr<const T> value) : value_(value.get()), owner_(std::move(value)) {}
  explicit Seen(T value) : Seen(std::make_shared<const T>(std::move(value))) {}
  /// A part of what `owner` keeps.
  Seen(const T& value, Owner owner, std::shared_ptr<const bool> lasts)
      : value_(&value), owner_(std::move(owner)), lasts_(std::move(lasts)) {}
  /// Lent.
  Seen(const T& value, const Loan& loan) : value_(&value), lasts_(loan.lasts()) {}

  /// Throws std::runtime_error where the loan is over.
  [[nodiscard]] const T& operator*() const {
    if (!owner_ && !*lasts_)
      throw std::runtime_error(
          "this was lent for a call that is over; keep arrays or numbers of it instead of the object");
    return *value_;
  }
  [[nodiscard]] const T* operator->() const { return &**this; }

  /// It, or a copy of what is lent: for whoever reads it without the interpreter's lock.
  [[nodiscard]] Seen kept() const { return owner_ ? *this : Seen(T(**this)); }

  /// A part of it.
  template <class U>
  [[nodiscard]] Seen<U> part(const U& part) const {
    return Seen<U>(part, owner_, lasts_);
  }
  /// What keeps it; empty where it is lent.
  [[nodiscard]] const Owner& owner() const { return owner_; }

 private:
  const T* value_;
  Owner owner_;
  std::shared_ptr<const bool> lasts_;
};

/// Rows of numbers of one type in memory.
struct Layout {
  std::vector<py::ssize_t> shape, strides;  ///< Strides in bytes.
};

/// They as an array that cannot be written to: a view of the memory where it has an owner, which then lives
/// as long as the array, and a copy where it is lent.
template <class T>
[[nodiscard]] py::array numbers(const T* first, const Layout& layout, const Owner& owner) {
  py::object base;
  if (owner) {
    base = py::capsule(new Owner(owner), [](void* kept) { delete static_cast<Owner*>(kept); });
  }
  py::array array(py::dtype::of<T>(), layout.shape, layout.strides, first, base);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

/// A number after the other.
template <class T>
[[nodiscard]] py::array numbers(const std::vector<T>& values, const Owner& owner) {
  return numbers(values.data(), {{static_cast<py::ssize_t>(values.size())}, {sizeof(T)}}, owner);
}

/// A member of each struct of a list.
template <class Number, class Struct>
[[nodiscard]] py::array column(const std::vector<Struct>& rows, const Number* of_first, const Owner& owner) {
  return numbers(of_first, {{static_cast<py::ssize_t>(rows.size())}, {sizeof(Struct)}}, owner);
}

}  // namespace glocal::python
