#include "sources/sites/office.hpp"

#include <algorithm>

#include "sources/simulation/world_grid.hpp"
#include "sources/sites/office_site.hpp"

namespace glocal::sites {
namespace {

simulation::World office_of(const OfficeParams& p) {
  return office_site(p.side, p.length.value_or(usual_length(p.side)), p.number,
                     p.furniture == 0 ? p.number : p.furniture);
}

}  // namespace

simulation::LaserDriveParams office_drive() {
  simulation::LaserDriveParams params;
  params.step_length = 0.3;
  params.step_turn_deg = 15.0;
  params.step_seconds = 0.5;
  params.laser.max_range = 20.0;
  return params;
}

double usual_length(double side) {
  constexpr double drive_per_side = 5.0;
  constexpr double longest_drive = 3000.0;
  return std::min(drive_per_side * side, longest_drive);
}

void describe(ParamVisitor& v, OfficeParams& p) {
  v.field("side", p.side, {.doc = "Side of the office, a square.", .unit = "m", .min = 20.0, .max = 2000.0});
  v.field("length", p.length,
          {.doc = "Way driven; auto is five times the side, and at most 3000 m.",
           .unit = "m",
           .min = 10.0,
           .max = 1e5});
  v.field(
      "number", p.number,
      {.doc = "Which of the offices of this size: fixes rooms, furniture and way. Map and drive must name "
              "the same."});
  v.field(
      "furniture", p.furniture,
      {.doc = "Another furniture in the same rooms, as on another floor; 0 is that of the number. Map and "
              "drive must name the same."});
}

void describe(ParamVisitor& v, OfficeMap::Params& p) {
  describe(v, static_cast<OfficeParams&>(p));
  v.field("resolution", p.resolution,
          {.doc = "Side of a cell of the map.", .unit = "m", .min = 0.01, .max = 1.0});
}

MapData OfficeMap::load() {
  MapData map;
  map.grid = simulation::plan_of(office_of(params_), params_.resolution, "");
  map.points = occupied_centres(map.grid);
  return map;
}

OfficeDrive::OfficeDrive(const Params& params, const SourceSetup& setup)
    : simulation_(office_drive(), office_of(params), setup.seed) {}

}  // namespace glocal::sites
