#include "app/map_index.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "evaluation/results/atomic_file.hpp"
#include "glocal/error.hpp"

namespace glocal::app {

MapIndexInfo save_index(const Experiment& experiment, const Catalog& catalog, MapData map,
                        const std::filesystem::path& file, bool replace) {
  StageSetup setup{std::make_shared<const GlobalMap>(std::move(map)), experiment.threads};
  setup.contact_epsilon = contact_epsilon_on(*setup.map, experiment.localizer);
  setup.motion = experiment.localizer.motion;
  setup.use_saved = false;  // it may be out of date: what is built now is to take its place
  const auto matcher = catalog.matchers.make(experiment.localizer.matcher, setup);
  const auto index = matcher->saved_index();
  if (!index) {
    throw ConfigError({{experiment.name, 0, 0,
                        fmt::format("the matcher {} keeps no index of the map that could be saved; "
                                    "indexed_ransam does: --set localizer.matcher=indexed_ransam",
                                    experiment.localizer.matcher.name)}});
  }
  AtomicFiles files(replace);
  files.add(file, *index);
  files.commit();
  return matcher->map_index().value();
}

}  // namespace glocal::app
