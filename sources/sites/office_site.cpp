#include "sources/sites/office_site.hpp"

#include "sources/sites/office_plan.hpp"

namespace glocal::sites {
namespace {

/// Streams of random numbers.
enum class Part : std::uint64_t { plan, walls, furniture, tour };

}  // namespace

simulation::World office_site(double side, double drive_length, std::uint64_t seed,
                              std::optional<std::uint64_t> furniture_seed) {
  const auto stream = [&](Part part) {
    const std::uint64_t of_part = part == Part::furniture ? furniture_seed.value_or(seed) : seed;
    return Rng(of_part).stream({static_cast<std::uint64_t>(part)});
  };
  const OfficePlan plan = office_plan(side, stream(Part::plan));
  simulation::World world;
  world.size = {side, side};
  add_walls(plan, stream(Part::walls), world);
  furnish(plan, stream(Part::furniture), world);
  world.way_points = office_tour(plan, drive_length, stream(Part::tour));
  world.free_from = {world.way_points.front()};
  return world;
}

}  // namespace glocal::sites
