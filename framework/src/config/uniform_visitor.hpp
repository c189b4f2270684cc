// For visitors that treat all types of plain fields by one rule.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "glocal/params.hpp"

namespace glocal {

/// Derived has a template `value(name, T&, info)`, which gets every field that is neither a struct, a list of
/// structs nor a strategy.
template <class Derived>
class UniformVisitor : public ParamVisitor {
 public:
  using ParamVisitor::field;
  void field(std::string_view name, bool& v, const FieldInfo& info) final { self().value(name, v, info); }
  void field(std::string_view name, int& v, const FieldInfo& info) final { self().value(name, v, info); }
  void field(std::string_view name, std::uint64_t& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }
  void field(std::string_view name, double& v, const FieldInfo& info) final { self().value(name, v, info); }
  void field(std::string_view name, std::optional<double>& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }
  void field(std::string_view name, std::string& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }
  void field(std::string_view name, FilePath& v, const FieldInfo& info) final { self().value(name, v, info); }
  void field(std::string_view name, std::vector<double>& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }
  void field(std::string_view name, std::vector<std::string>& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }
  void field(std::string_view name, std::vector<FilePath>& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }
  void field(std::string_view name, std::vector<std::array<double, 2>>& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }

  void field(std::string_view name, NamedChanges& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }
  void field(std::string_view name, ListedChanges& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }
  void field(std::string_view name, RangedChanges& v, const FieldInfo& info) final {
    self().value(name, v, info);
  }
  void field(std::string_view name, SeedList& v, const FieldInfo& info) final { self().value(name, v, info); }
  void field(std::string_view name, PartList& v, const FieldInfo& info) final { self().value(name, v, info); }

 private:
  Derived& self() { return static_cast<Derived&>(*this); }
};

}  // namespace glocal
