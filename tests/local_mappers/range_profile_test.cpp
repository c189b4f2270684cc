#include "local_mappers/range_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "local_mappers/rooms.hpp"
#include "points.hpp"

namespace glocal::local_mappers::range_profile_test {
namespace {

using test::circle_around;

TEST(RangeProfile, TellsWhatWasMetFromWhatWasSeenThroughAndWhatWasHidden) {
  const RangeProfile profile(circle_around({1.0F, 0.0F, 0.0F}, 5.0F));
  Points hits;
  hits.push_back({4.0F, 0.0F, 0.0F});   // 3 m from the sensor: the beam went on
  hits.push_back({1.0F, -4.6F, 0.0F});  // 4.6 m: that too
  hits.push_back({-3.8F, 0.0F, 0.0F});  // 4.8 m: met, within the margin
  hits.push_back({1.0F, 5.2F, 0.0F});   // 5.2 m: met as well
  hits.push_back({7.0F, 0.0F, 0.0F});   // 6 m: behind what was met
  const RangeProfile::Seen seen = profile.look_at(hits, {});
  EXPECT_EQ(seen.violation, 2U);
  EXPECT_EQ(seen.met, 2U);
}

TEST(RangeProfile, LooksAtHitsWhereTheirRobotWas) {
  const RangeProfile profile(circle_around({}, 5.0F));
  const Points hits = test::points_of({{1.0F, 0.0F, 0.0F}});
  // The other robot stood at (0, 4) and looked along y: its hit is at (0, 5).
  EXPECT_EQ(profile.look_at(hits, {0.0, 4.0, radians(90)}).met, 1U);
  EXPECT_EQ(profile.look_at(hits, {0.0, 2.0, radians(90)}).violation, 1U);
}

TEST(RangeProfile, SaysNothingOfDirectionsItDidNotLookIn) {
  Scan ahead;
  for (int i = -5; i <= 5; ++i) {
    ahead.free_ends.push_back({20.0F * std::cos(0.01F * static_cast<float>(i)),
                               20.0F * std::sin(0.01F * static_cast<float>(i)), 0.0F});
  }
  Points hits;
  hits.push_back({3.0F, 0.0F, 0.0F});   // on the way of free beams
  hits.push_back({0.0F, 3.0F, 0.0F});   // beside
  hits.push_back({-3.0F, 0.0F, 0.0F});  // behind
  const RangeProfile::Seen seen = RangeProfile(ahead).look_at(hits, {});
  EXPECT_EQ(seen.violation, 1U);
  EXPECT_EQ(seen.met, 0U);
}

}  // namespace
}  // namespace glocal::local_mappers::range_profile_test
