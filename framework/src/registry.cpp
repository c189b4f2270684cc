#include "glocal/registry.hpp"

namespace glocal {

Standing stable_since(std::string version) {
  return {true, std::move(version)};
}

Standing experimental_since(std::string version) {
  return {false, std::move(version)};
}

std::string to_string(const Standing& standing) {
  const std::string status = standing.is_stable ? "stable" : "experimental";
  return standing.since.empty() ? status : status + " since " + standing.since;
}

std::vector<const StrategyInfo*> RegistryBase::all() const {
  std::vector<const StrategyInfo*> result;
  result.reserve(infos_.size());
  for (const auto& [name, info] : infos_) result.push_back(&info);
  return result;
}

const StrategyInfo* RegistryBase::find(std::string_view name) const {
  const auto it = infos_.find(name);
  return it == infos_.end() ? nullptr : &it->second;
}

const std::string* RegistryBase::renamed(std::string_view formerly) const {
  const auto it = renamed_.find(formerly);
  return it == renamed_.end() ? nullptr : &it->second;
}

void RegistryBase::note_counterparts(const std::string& in_plane, const std::string& in_space) {
  counterparts_.emplace(in_plane, in_space);
  counterparts_.emplace(in_space, in_plane);
}

const StrategyInfo* RegistryBase::counterpart(std::string_view name) const {
  const auto it = counterparts_.find(name);
  return it == counterparts_.end() ? nullptr : find(it->second);
}

StrategyChoice RegistryBase::choose(std::string_view name) const {
  const StrategyInfo* info = find(name);
  if (info == nullptr) throw std::out_of_range("no " + kind_ + " '" + std::string(name) + "'");
  return {info->name, info->default_params()};
}

void RegistryBase::insert(std::string name, std::string doc, Standing standing, Motions motions,
                          std::function<std::unique_ptr<AnyParams>()> default_params) {
  if (const StrategyInfo* taken = find(name)) {
    throw std::invalid_argument(kind_ + " '" + name + "' of " + origin_ + " is already registered by " +
                                taken->origin);
  }
  StrategyInfo info{name, std::move(doc), origin_, std::move(standing), motions, std::move(default_params)};
  infos_.emplace(std::move(name), std::move(info));
}

}  // namespace glocal
