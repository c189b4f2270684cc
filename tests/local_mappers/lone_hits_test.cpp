#include "local_mappers/lone_hits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "glocal/pose2.hpp"

namespace glocal::local_mappers::lone_hits_test {
namespace {

using ::testing::ElementsAre;

/// Hits at these ranges, so many degrees from one beam to the next, seen from a sensor at (1, 2).
Points hits_at(const std::vector<double>& ranges, double step_deg) {
  Points hits;
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double angle = radians(step_deg * static_cast<double>(i));
    hits.push_back({static_cast<float>(1.0 + ranges[i] * std::cos(angle)),
                    static_cast<float>(2.0 + ranges[i] * std::sin(angle)), 0.0F});
  }
  return hits;
}

constexpr Point sensor{1.0F, 2.0F, 0.0F};

TEST(LoneHits, AreThoseThatNoNeighbourConfirms) {
  EXPECT_THAT(lone_hits(hits_at({5, 5, 2, 5, 5}, 1.0), sensor),
              ElementsAre(false, false, true, false, false));
  // Two that confirm each other are a thing, though others stand between them.
  EXPECT_THAT(lone_hits(hits_at({5, 2, 5, 2, 5}, 1.0), sensor),
              ElementsAre(false, false, false, false, false));
  // Four beams on is too far to confirm anything.
  EXPECT_THAT(lone_hits(hits_at({2, 5, 5, 5, 2}, 1.0), sensor), ElementsAre(true, false, false, false, true));
}

TEST(LoneHits, MayBeAsFarApartAsBeamsAre) {
  // At 5 m beams 1 degree apart are 0.087 m apart: one surface seen at 20 degrees, and noise, give 0.41 m.
  EXPECT_THAT(lone_hits(hits_at({5.0, 5.4}, 1.0), sensor), ElementsAre(false, false));
  EXPECT_THAT(lone_hits(hits_at({5.0, 5.6}, 1.0), sensor), ElementsAre(true, true));
  EXPECT_THAT(lone_hits(hits_at({5.0, 7.5}, 20.0), sensor), ElementsAre(false, false));
}

TEST(LoneHits, OneHitIsAlone) {
  EXPECT_THAT(lone_hits(hits_at({5.0}, 1.0), sensor), ElementsAre(true));
  EXPECT_TRUE(lone_hits({}, sensor).empty());
}

}  // namespace
}  // namespace glocal::local_mappers::lone_hits_test
