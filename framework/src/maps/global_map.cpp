#include "glocal/global_map.hpp"

namespace glocal {

std::shared_ptr<const void> GlobalMap::shared_index(
    std::type_index type, const std::string& key,
    const std::function<std::shared_ptr<const void>()>& build) const {
  const std::lock_guard lock(mutex_);
  std::shared_ptr<const void>& slot = indexes_[{type, key}];
  if (!slot) slot = build();
  return slot;
}

}  // namespace glocal
