// Strategies by name. Registries are values, filled by functions one can read.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "glocal/motion.hpp"
#include "glocal/params.hpp"

namespace glocal {

/// What of a strategy can be relied on. One that says nothing is experimental.
struct Standing {
  /// Names and answers stay, or the changelog says why not; others may change or go.
  bool is_stable = false;
  std::string since = {};  ///< The version that brought it; empty if that is not said.
};
[[nodiscard]] Standing stable_since(std::string version);
[[nodiscard]] Standing experimental_since(std::string version);
/// "stable since 0.1.0".
[[nodiscard]] std::string to_string(const Standing& standing);

/// What is known of a strategy besides how to make it.
struct StrategyInfo {
  std::string name;
  std::string doc;     ///< One sentence.
  std::string origin;  ///< "glocal", or the plugin it came from.
  Standing standing;
  Motions motions;  ///< What a stage of the localizer can work with.
  std::function<std::unique_ptr<AnyParams>()> default_params;
};

/// What a strategy's class says of the motions it can work with; one that says nothing works in the plane.
template <class T>
[[nodiscard]] constexpr Motions motions_of() {
  if constexpr (requires { T::motions; }) {
    return T::motions;
  } else {
    return {};
  }
}

/// The part of a registry that does not depend on what it makes.
class RegistryBase {
 public:
  explicit RegistryBase(std::string kind) : kind_(std::move(kind)) {}
  virtual ~RegistryBase() = default;
  RegistryBase(const RegistryBase&) = delete;
  RegistryBase& operator=(const RegistryBase&) = delete;

  /// "matcher", "local_mapper" …
  [[nodiscard]] const std::string& kind() const { return kind_; }
  /// In the order of their names.
  [[nodiscard]] std::vector<const StrategyInfo*> all() const;
  /// Null if there is none.
  [[nodiscard]] const StrategyInfo* find(std::string_view name) const;
  /// The strategy with all its defaults. Throws std::out_of_range if there is none.
  [[nodiscard]] StrategyChoice choose(std::string_view name) const;

  /// Notes that a strategy had another name before.
  void note_renamed(std::string formerly, std::string now) {
    renamed_.emplace(std::move(formerly), std::move(now));
  }
  /// What a strategy is called now that had this name before; null if there is none.
  [[nodiscard]] const std::string* renamed(std::string_view formerly) const;

  /// Notes two strategies that are the same idea, one of them in the plane and the other in space.
  void note_counterparts(const std::string& in_plane, const std::string& in_space);
  /// The other one of such a pair; null if there is none.
  [[nodiscard]] const StrategyInfo* counterpart(std::string_view name) const;

  /// Who registers from now on; named in StrategyInfo::origin and in messages.
  void set_origin(std::string origin) { origin_ = std::move(origin); }

 protected:
  /// Throws std::invalid_argument if the name is taken, naming both origins.
  void insert(std::string name, std::string doc, Standing standing, Motions motions,
              std::function<std::unique_ptr<AnyParams>()> default_params);

 private:
  std::string kind_;
  std::string origin_ = "glocal";
  std::map<std::string, StrategyInfo, std::less<>> infos_;
  std::map<std::string, std::string, std::less<>> renamed_;
  std::map<std::string, std::string, std::less<>> counterparts_;
};

/// Makes strategies of one kind. `Setup` is what they may use when they are made.
template <class Interface, class Setup>
class Registry final : public RegistryBase {
 public:
  using RegistryBase::RegistryBase;

  /// T has a described struct T::Params and is constructible from (Params) or (Params, const Setup&).
  /// `defaults` are given where they hold what only the registering function has at hand: another registry.
  template <std::derived_from<Interface> T>
  void add(std::string name, std::string doc, Standing standing = {}, typename T::Params defaults = {}) {
    using Params = typename T::Params;
    insert(name, std::move(doc), std::move(standing), motions_of<T>(), [defaults = std::move(defaults)] {
      auto params = std::make_unique<ParamsOf<Params>>();
      params->value = defaults;
      return params;
    });
    makers_[std::move(name)] = [](const AnyParams& any, const Setup& setup) -> std::unique_ptr<Interface> {
      const Params& params = dynamic_cast<const ParamsOf<Params>&>(any).value;
      if constexpr (std::is_constructible_v<T, const Params&, const Setup&>) {
        return std::make_unique<T>(params, setup);
      } else {
        return std::make_unique<T>(params);
      }
    };
  }

  /// The same for a strategy that no class stands for, such as one in another language: `make` is handed what
  /// `default_params` made, with values from a file.
  void add_made(std::string name, std::string doc, Motions motions,
                std::function<std::unique_ptr<AnyParams>()> default_params,
                std::function<std::unique_ptr<Interface>(const AnyParams&, const Setup&)> make) {
    insert(name, std::move(doc), {}, motions, std::move(default_params));
    makers_[std::move(name)] = std::move(make);
  }

  /// The choice of no strategy, where a stage need not be there: make() gives null.
  void add_none(std::string name, std::string doc, Standing standing) {
    insert(name, std::move(doc), std::move(standing), all_motions,
           [] { return std::make_unique<ParamsOf<NoParams>>(); });
    makers_[std::move(name)] = [](const AnyParams& /*params*/, const Setup& /*setup*/) { return nullptr; };
  }

  [[nodiscard]] std::unique_ptr<Interface> make(const StrategyChoice& choice, const Setup& setup) const {
    if (!choice.params) return make(choose(choice.name), setup);
    return makers_.at(choice.name)(*choice.params, setup);
  }

 private:
  std::map<std::string, std::function<std::unique_ptr<Interface>(const AnyParams&, const Setup&)>> makers_;
};

}  // namespace glocal
