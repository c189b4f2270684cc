// A map with what has changed in the world since it was made.
#pragma once

#include <memory>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/disturbed/chosen.hpp"

namespace glocal::disturbed {

struct ChosenMapDisturbance : Chosen {};
void describe(ParamVisitor& v, ChosenMapDisturbance& p);

/// The map of another source, disturbed by one thing after the other.
class DisturbedMap final : public MapSource {
 public:
  struct Params {
    /// Of the source; outlives all that is made of it.
    const Registry<MapSource, SourceSetup>* sources = nullptr;
    StrategyChoice source = {};
    std::vector<ChosenMapDisturbance> by = {};
  };

  DisturbedMap(const Params& params, const SourceSetup& setup);
  /// Throws ConfigError also where a disturbance needs cells and there are none, or leaves no point.
  [[nodiscard]] MapData load() override;

 private:
  std::vector<ChosenMapDisturbance> by_;
  std::unique_ptr<MapSource> source_;
  Rng rng_;
};
void describe(ParamVisitor& v, DisturbedMap::Params& p);

}  // namespace glocal::disturbed
