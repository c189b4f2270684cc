#include "sources/disturbed/disturbed_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "glocal/error.hpp"
#include "sources/disturbed/map_disturbances.hpp"

namespace glocal::disturbed {
namespace {

[[noreturn]] void fail(std::string message) {
  throw ConfigError({{"", 0, 0, std::move(message), "map.disturbed.by"}});
}

void check_fit(const MapDisturbanceKind& kind, const MapData& map) {
  if (kind.changes == Changes::cells && map.grid.cells.empty())
    fail(fmt::format("'{}' changes cells, and this map has none; choose another kind", kind.name));
  if (kind.changes == Changes::cells && has_heights(map))
    fail(fmt::format("'{}' changes cells, and this map has points in space; choose another kind", kind.name));
  if (kind.changes == Changes::places && !map.parts.empty())
    fail(fmt::format("'{}' changes a whole map, and these are several; disturb each of the maps of 'several'",
                     kind.name));
}

}  // namespace

void describe(ParamVisitor& v, ChosenMapDisturbance& p) {
  describe_chosen(v, p, said_of(map_disturbance_kinds()));
}

void describe(ParamVisitor& v, DisturbedMap::Params& p) {
  v.strategy("source", p.source, *p.sources, {.doc = "What is disturbed.", .required = true});
  v.field("by", p.by,
          {.doc = "What has changed, one thing after the other in this order.",
           .min_items = 1,
           .required = true});
}

DisturbedMap::DisturbedMap(const Params& params, const SourceSetup& setup)
    : by_(params.by), source_(params.sources->make(params.source, setup)), rng_(setup.seed) {
  // What is disturbed twice is not so by the same numbers.
  if (const auto* inner = dynamic_cast<const DisturbedMap*>(source_.get())) rng_ = inner->rng_.stream({0, 0});
}

MapData DisturbedMap::load() {
  MapData map = source_->load();
  for (std::size_t i = 0; i < by_.size(); ++i) {
    const MapDisturbanceKind& kind = kind_named(by_[i].kind, map_disturbance_kinds());
    check_fit(kind, map);
    if (kind.changes == Changes::places) map.free_voxels = {};
    Rng rng = rng_.stream({i});
    kind.change(map, by_[i].amount_of(kind), rng);
    if (map.points.empty())
      fail(fmt::format("'{}' leaves nothing of the map; choose a lower level or amount", kind.name));
  }
  return map;
}

}  // namespace glocal::disturbed
