#include "app/map_index.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "evaluation/results/atomic_file.hpp"
#include "glocal/error.hpp"
#include "matchers/indexed_ransam/indexed_ransam.hpp"

namespace glocal::app {

MapIndexInfo save_index(const Experiment& experiment, MapData map, const std::filesystem::path& file,
                        bool replace) {
  const StrategyChoice& choice = experiment.localizer.matcher;
  const auto* params = dynamic_cast<const ParamsOf<IndexedRansam::Params>*>(&*choice.params);
  if (params == nullptr) {
    throw ConfigError({{experiment.name, 0, 0,
                        fmt::format("the matcher {} keeps no index of the map; that of indexed_ransam can be "
                                    "saved: --set localizer.matcher=indexed_ransam",
                                    choice.name)}});
  }
  IndexedRansam::Params built = params->value;
  built.index_file = {};  // it may be out of date: what is built now is to take its place
  const IndexedRansam matcher(built, {std::make_shared<const GlobalMap>(std::move(map)), experiment.threads});
  AtomicFiles files(replace);
  files.add(file, matcher.saved_index());
  files.commit();
  return *matcher.map_index();
}

}  // namespace glocal::app
