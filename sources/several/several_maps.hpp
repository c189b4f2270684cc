// Maps side by side: the floors of a building.
#pragma once

#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"

namespace glocal::several {

/// One of the maps, and what it is called in results and messages.
struct NamedMap {
  /// Of the source; outlives all that is made of it.
  const Registry<MapSource, SourceSetup>* sources = nullptr;
  std::string name = {};
  StrategyChoice source = {};
};
void describe(ParamVisitor& v, NamedMap& p);

/// Maps of other sources, side by side along x in a common frame: the first stays where it is (its cells'
/// columns along x), the next begins beyond it. Between two of them nothing is known.
class SeveralMaps final : public MapSource {
 public:
  struct Params {
    const Registry<MapSource, SourceSetup>* sources = nullptr;
    std::vector<NamedMap> maps = {};
  };

  SeveralMaps(const Params& params, const SourceSetup& setup);
  /// Throws ConfigError for maps that cannot be joined: cells or voxels of different sides, maps with cells
  /// and maps without.
  [[nodiscard]] MapData load() override;

 private:
  std::vector<std::string> names_;
  std::vector<std::unique_ptr<MapSource>> sources_;
};
void describe(ParamVisitor& v, SeveralMaps::Params& p);

}  // namespace glocal::several
