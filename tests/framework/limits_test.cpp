#include "glocal/limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace glocal::test::limits_test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(Limits, OfResolutions) {
  for (const double good : {0.001, 0.05, 100.0}) EXPECT_THAT(fault_of_resolution(good), IsEmpty()) << good;
  for (const double bad : {0.0009, 1e-30, 0.0, -1.0, 101.0, 1e30, infinity, nan})
    EXPECT_THAT(fault_of_resolution(bad), HasSubstr("must be 0.001 to 100 m")) << bad;
}

TEST(Limits, OfStamps) {
  for (const double good : {0.0, -1.0, 4294967295.0}) EXPECT_THAT(fault_of_stamp(good), IsEmpty()) << good;
  for (const double bad : {4.7e9, -4.7e9, 1e30, infinity, nan})
    EXPECT_THAT(fault_of_stamp(bad), HasSubstr("at most 4.6e+09 s before or after 1970")) << bad;
  using Ns = std::numeric_limits<std::int64_t>;
  for (const std::int64_t good : {latest_stamp_ns, -latest_stamp_ns})
    EXPECT_THAT(fault_of_stamp_ns(good), IsEmpty());
  for (const std::int64_t bad : {Ns::max(), Ns::min(), latest_stamp_ns + 1, -latest_stamp_ns - 1})
    EXPECT_THAT(fault_of_stamp_ns(bad), Not(IsEmpty()));
  // What the bounds are for.
  EXPECT_LT(latest_stamp_ns, Ns::max() - latest_stamp_ns);
}

TEST(Limits, OfTimesWithinAScan) {
  EXPECT_THAT(fault_of_scan_times(0.0, 0.1), IsEmpty());
  EXPECT_THAT(fault_of_scan_times(1.7e9, 1.7e9 + 0.1), IsEmpty());
  EXPECT_THAT(fault_of_scan_times(0.0, 1001.0), HasSubstr("at most 1000 s apart"));
  EXPECT_THAT(fault_of_scan_times(nan, 0.1), Not(IsEmpty()));
  EXPECT_THAT(fault_of_scan_times(0.0, infinity), Not(IsEmpty()));
}

MapData map_at(float x, double resolution) {
  MapData map;
  map.points.push_back({x, 1.0F, 0.0F});
  map.resolution = resolution;
  return map;
}

TEST(Limits, OfMapsFarFromTheirOrigin) {
  // Single precision has 24 bits: 2^-8 m = 3.9 mm from 2^15 m = 33 km on, and 7.8 mm from 66 km on.
  EXPECT_THAT(fault_of_map(map_at(65'000.0F, 0.05)), IsEmpty());
  EXPECT_THAT(fault_of_map(map_at(66'000.0F, 0.05)),
              HasSubstr("places 66000 m from the origin, where single precision is good to 0.0078 m"));
  EXPECT_THAT(fault_of_map(map_at(-66'000.0F, 0.05)), Not(IsEmpty()));
  EXPECT_THAT(fault_of_map(map_at(500'000.0F, 0.25)), IsEmpty()) << "a coarse map may be far away";
  EXPECT_THAT(fault_of_map(map_at(500'000.0F, 0.0)), IsEmpty()) << "nobody knows how fine it is";
}

TEST(Limits, OfMapsCells) {
  MapData map = map_at(0.0F, 0.0);
  map.grid.resolution = 0.05;
  EXPECT_THAT(fault_of_map(map), IsEmpty());
  map.grid.width = map.grid.height = 31'623;
  EXPECT_THAT(fault_of_map(map), HasSubstr("31623 x 31623 cells are more than 1e+09"));
  map.grid.width = map.grid.height = 1;
  map.grid.resolution = 1e-6;
  EXPECT_THAT(fault_of_map(map), HasSubstr("a resolution of 1e-06 m is out of range"));
}

TEST(Limits, OfMapsWithAnOriginOfTheirOwn) {
  // 4,649,776 m away there are 0.5 m between neighbouring numbers, and 8 mm 66 km away.
  MapData map = map_at(10.0F, 0.05);
  map.origin = {500'000.0, 4'649'776.0, 0.0};
  EXPECT_THAT(fault_of_map(map), IsEmpty());
  map.points.x[0] = 66'000.0F;
  EXPECT_THAT(fault_of_map(map), HasSubstr("places 66000 m from its own origin, where single precision is "
                                           "good to 0.0078 m, are too far for a map of 0.05 m resolution; "
                                           "cut the map"));
  // Along y it is the point at 1 m that counts.
  map = map_at(10.0F, 0.05);
  map.origin = {9'999'990.0, 0.0, 0.0};
  EXPECT_THAT(fault_of_map(map), IsEmpty());
  map.origin.x() += 1.0;
  EXPECT_THAT(fault_of_map(map), HasSubstr("at most 1e+07 m are allowed"));
}

}  // namespace
}  // namespace glocal::test::limits_test
