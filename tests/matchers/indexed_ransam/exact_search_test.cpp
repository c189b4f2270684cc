#include "matchers/indexed_ransam/exact_search.hpp"

#include <gtest/gtest.h>

#include "test_world.hpp"

namespace glocal::exact_search_test {
namespace {

ExactSearch search_after(int steps) {
  return {{.after_steps = steps, .margin = 0.1}, {}, 0.2, *test::small_world(), 0.1, 1};
}

std::vector<Hypothesis> best_two(double first, double second) {
  return {Hypothesis::by_contact({}, first), Hypothesis::by_contact(Pose2{5.0, 0.0, 0.0}, second)};
}

TEST(ExactSearch, IsDueInTheLastOfSoManyStepsWithoutAClearBestPose) {
  ExactSearch search = search_after(3);
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.75)));
  EXPECT_FALSE(search.is_due({}));  // no pose at all is none that is clear
  EXPECT_TRUE(search.is_due(best_two(0.8, 0.71)));
  // The count begins anew.
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.75)));
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.75)));
  search.reset();
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.75)));
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.75)));
  EXPECT_TRUE(search.is_due(best_two(0.8, 0.75)));
}

TEST(ExactSearch, AClearBestPoseBeginsTheCountAnew) {
  ExactSearch search = search_after(2);
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.75)));
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.6)));
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.75)));
  EXPECT_FALSE(search.is_due({Hypothesis::by_contact({}, 0.3)}));  // without another one
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.75)));
  EXPECT_TRUE(search.is_due(best_two(0.8, 0.75)));
}

TEST(ExactSearch, IsNeverDueWhereItIsOff) {
  ExactSearch search = search_after(0);
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(search.is_due(best_two(0.8, 0.8)));
}

TEST(ExactSearch, FindsThePoseInTheWholeMap) {
  const Pose2 truth{5.5, 2.5, 0.7};
  const Points points = test::seen_from(test::small_world_points(), truth, 3.0);
  const GridSearchResult found = search_after(1).search(points, {}, {});
  ASSERT_FALSE(found.poses.empty());
  EXPECT_LT(distance(found.poses.front().map_from_local, truth), 0.1);
  EXPECT_LT(rotation_between(found.poses.front().map_from_local, truth), radians(3.0));
}

}  // namespace
}  // namespace glocal::exact_search_test
