#include "glocal/beams.hpp"

#include <gmock/gmock.h>

namespace glocal::beams_test {
namespace {

/// Hits at x = 0, 1, …; then beams that met nothing, at x = 100, 101, ….
Scan scan_of(int hits, int free_ends) {
  Scan scan;
  for (int i = 0; i < hits; ++i) scan.hits.push_back({static_cast<float>(i), 0.0F, 0.0F});
  for (int i = 0; i < free_ends; ++i) scan.free_ends.push_back({static_cast<float>(100 + i), 0.0F, 0.0F});
  return scan;
}

std::vector<float> ends_of(const std::vector<Beam>& beams) {
  std::vector<float> x;
  for (const Beam& beam : beams) x.push_back(beam.end.x);
  return x;
}

TEST(SomeBeams, AreAllWhereThereAreFew) {
  const std::vector<Beam> beams = some_beams(scan_of(2, 1), 10);
  EXPECT_THAT(ends_of(beams), testing::ElementsAre(0, 1, 100));
  EXPECT_TRUE(beams[0].is_hit);
  EXPECT_TRUE(beams[1].is_hit);
  EXPECT_FALSE(beams[2].is_hit);
}

TEST(SomeBeams, AreSpreadEvenlyOverHitsAndFreeEnds) {
  EXPECT_THAT(ends_of(some_beams(scan_of(8, 4), 4)), testing::ElementsAre(0, 3, 6, 101));
  EXPECT_THAT(ends_of(some_beams(scan_of(5, 0), 2)), testing::ElementsAre(0, 2));
}

TEST(SomeBeams, OfNothingAreNone) {
  EXPECT_TRUE(some_beams({}, 10).empty());
  EXPECT_TRUE(some_beams(scan_of(3, 3), 0).empty());
}

}  // namespace
}  // namespace glocal::beams_test
