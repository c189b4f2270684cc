#include "matchers/indexed_ransam/exact_search.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "test_world.hpp"

namespace glocal::indexed_ransam::exact_search_test {
namespace {

ExactSearch search_after(int steps) {
  return {{.after_steps = steps, .margin = 0.1}, *test::small_world(), 0.1, 1};
}

std::vector<Hypothesis> best_two(double first, double second) {
  return {Hypothesis::by_contact({}, first), Hypothesis::by_contact(Pose2{5.0, 0.0, 0.0}, second)};
}

/// In which of so many steps without a clear best pose a search is due.
std::vector<int> due(ExactSearch& search, int steps) {
  std::vector<int> due;
  for (int step = 1; step <= steps; ++step) {
    if (search.is_due(best_two(0.8, 0.75))) due.push_back(step);
  }
  return due;
}

TEST(ExactSearch, IsDueAfterSoManyStepsWithoutAClearBestPoseAndThenAfterTwiceAsMany) {
  ExactSearch search = search_after(3);
  EXPECT_EQ(due(search, 50), (std::vector{3, 9, 21, 45}));
  search.reset();
  EXPECT_EQ(due(search, 12), (std::vector{3, 9}));
}

TEST(ExactSearch, NoPoseAtAllIsNoneThatIsClear) {
  ExactSearch search = search_after(2);
  EXPECT_FALSE(search.is_due({}));
  EXPECT_TRUE(search.is_due({}));
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

const Pose2 truth{5.5, 2.5, 0.7};

/// What each round of a search brings, if the best pose so far always has this score.
struct Rounds {
  std::vector<std::vector<Pose2>> poses = {};
  std::size_t looks = 0;
  int steps = 0;
};

Rounds rounds(const ExactSearchRule& rule, double score, std::size_t looks_per_step = BoxSearch::to_the_end) {
  ExactSearch search(rule, *test::small_world(), 0.1, 1);
  search.begin(test::seen_from(test::small_world_points(), truth, 3.0), {}, {});
  Rounds rounds;
  std::vector<Hypothesis> best;
  for (std::size_t looks = 1; looks > 0; ++rounds.steps) {
    looks = search.advance(best, looks_per_step, [&](const std::vector<Pose2>& poses) {
      rounds.poses.push_back(poses);
      return best = {Hypothesis::by_contact(poses.front(), score)};
    });
    rounds.looks += looks;
  }
  return rounds;
}

bool is_near_truth(const Pose2& pose) {
  return distance(pose, truth) < 0.1 && rotation_between(pose, truth) < radians(3.0);
}

TEST(ExactSearch, FindsThePoseInTheWholeMap) {
  const auto found = rounds({}, 1.0).poses;
  ASSERT_EQ(found.size(), 1U);
  EXPECT_TRUE(std::any_of(found[0].begin(), found[0].end(), is_near_truth));
}

TEST(ExactSearch, AsksForLessAsLongAsALowerPoseCouldBeTheBest) {
  // From 0.95 on in steps of 0.1: a pose with a score of 0.8 ends the search after the round of 0.85.
  const auto looks = [](double min_contact, double score) {
    return rounds({.min_contact = min_contact}, score).looks;
  };
  EXPECT_LT(looks(0.5, 0.9), looks(0.5, 0.8));
  EXPECT_LT(looks(0.5, 0.8), looks(0.5, 0.7));
  EXPECT_EQ(looks(0.85, 0.7), looks(0.5, 0.8));
}

TEST(ExactSearch, LaterRoundsAreAboutOtherPlacesThanTheBestOne) {
  const auto found = rounds({.min_contact = 0.5, .max_poses = 100}, 0.0).poses;
  ASSERT_GT(found.size(), 1U);
  ASSERT_TRUE(is_near_truth(found[0].front()));
  EXPECT_TRUE(std::none_of(found[1].begin(), found[1].end(), is_near_truth));
}

TEST(ExactSearch, InManyStepsFindsTheSame) {
  const Rounds whole = rounds({.min_contact = 0.5, .max_poses = 100}, 0.0);
  EXPECT_EQ(whole.steps, 2) << "and in the second there is nothing to be done";
  int steps_before = std::numeric_limits<int>::max();
  for (const std::size_t looks : {1U, 10000U, 1'000'000'000U}) {
    const Rounds found = rounds({.min_contact = 0.5, .max_poses = 100}, 0.0, looks);
    EXPECT_EQ(found.poses, whole.poses);
    EXPECT_LT(found.steps, steps_before);
    steps_before = found.steps;
  }
  EXPECT_EQ(steps_before, 2);
}

TEST(ExactSearch, NoneIsDueWhileOneGoesOnAndAClearBestPoseEndsIt) {
  ExactSearch search({.after_steps = 1, .margin = 0.1}, *test::small_world(), 0.1, 1);
  const auto advance = [&] {
    return search.advance({}, 1, [](const std::vector<Pose2>&) { return std::vector<Hypothesis>{}; });
  };
  EXPECT_EQ(advance(), 0U);
  ASSERT_TRUE(search.is_due(best_two(0.8, 0.75)));
  search.begin(test::seen_from(test::small_world_points(), truth, 3.0), {}, {});
  EXPECT_GT(advance(), 0U);
  for (int i = 0; i < 5; ++i) EXPECT_FALSE(search.is_due(best_two(0.8, 0.75)));
  EXPECT_GT(advance(), 0U);
  EXPECT_FALSE(search.is_due(best_two(0.8, 0.6)));
  EXPECT_EQ(advance(), 0U);
}

TEST(ExactSearch, EndsAfterTooManyLooks) {
  EXPECT_LT(rounds({.min_contact = 0.5, .max_looks = 100}, 0.0).looks,
            rounds({.min_contact = 0.5}, 0.0).looks);
}

}  // namespace
}  // namespace glocal::indexed_ransam::exact_search_test
