// Point clouds of results folders.
#include "evaluation/results/pcd.hpp"

#include "fuzz/harness.hpp"

extern "C" int fuzz_pcd(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto file = fuzz::write("points.pcd", fuzz::text_of(data, size));
  return fuzz::answer([&] {
    const Points points = read_pcd(file);
    fuzz::must_hold(pcd(points) == fuzz::text_of(data, size),
                    "the points are written otherwise than they were read");
  });
}
