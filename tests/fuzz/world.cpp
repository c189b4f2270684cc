// Worlds of simulations, with what is made of them: a map and a drive.
#include "sources/simulation/world.hpp"

#include "fuzz/harness.hpp"
#include "sources/simulation/simulation.hpp"

extern "C" int fuzz_world(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto file = fuzz::write("world.yaml", fuzz::text_of(data, size));
  return fuzz::answer([&] {
    const simulation::World world = simulation::read_world(file);
    static_cast<void>(simulation::people_at(world, 1000.0));
    simulation::DriveParams drive;
    drive.world = {file.string(), file};
    drive.tour_legs = 10;
    static_cast<void>(simulation::route_of(simulation::WorldWays(world), drive, Rng(1)));
    static_cast<void>(simulation::SimulatedMap({{file.string(), file}, 1.0}, {}).load());
  });
}
