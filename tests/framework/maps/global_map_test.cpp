#include "glocal/global_map.hpp"

#include <gtest/gtest.h>

namespace glocal::test::global_map_test {
namespace {

TEST(OriginNear, IsInWholeMetresAlongEachAxisThatIsFar) {
  EXPECT_EQ(origin_near({1000.0, -1000.0, 0.0}), Vector3(0, 0, 0));
  EXPECT_EQ(origin_near({1000.4, -1000.6, 0.0}), Vector3(1000, -1001, 0));
  EXPECT_EQ(origin_near({500'000.25, 12.0, 0.0}), Vector3(500'000, 0, 0));
}

TEST(OriginNear, HasAHeightInSpaceOnly) {
  EXPECT_EQ(origin_near({0.0, 0.0, 2000.4}), Vector3(0, 0, 0));
  for (const Motion motion : {Motion::upright, Motion::free})
    EXPECT_EQ(origin_near({0.0, 0.0, 2000.4}, motion), Vector3(0, 0, 2000));
}

TEST(GlobalMap, TakesPosesRelativeToItsOrigin) {
  MapData data;
  data.points.push_back({});
  data.origin = {500'000.0, 4'649'776.0, 0.0};
  const GlobalMap map(std::move(data));
  EXPECT_EQ(map.relative(Pose2{500'001.5, 4'649'770.25, 0.5}), (Pose2{1.5, -5.75, 0.5}));
}

}  // namespace
}  // namespace glocal::test::global_map_test
