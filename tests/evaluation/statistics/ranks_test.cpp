#include "evaluation/statistics/ranks.hpp"

#include <gmock/gmock.h>

namespace glocal::test::ranks_test {
namespace {

TEST(Ranks, TiesShareTheMeanOfTheirs) {
  // 1, 2.5, 2.5, 4, doubled.
  EXPECT_THAT(ranks_of({7.0, 8.0, 8.0, 9.5}).doubled, testing::ElementsAre(2, 5, 5, 8));
  EXPECT_DOUBLE_EQ(ranks_of({7.0, 8.0, 8.0, 9.5}).tie_term, 6.0);
}

TEST(Spearman, AgreesWithNumbersByHand) {
  EXPECT_DOUBLE_EQ(spearman({1, 2, 3}, {10, 200, 3000}).value_or(0.0), 1.0);
  EXPECT_DOUBLE_EQ(spearman({1, 2, 3}, {5, 4, -100}).value_or(0.0), -1.0);
  // Differences of the ranks are 0, 1, 1, 1, 1: 1 - 6 * 4 / (5 * 24).
  EXPECT_DOUBLE_EQ(spearman({1, 2, 3, 4, 5}, {1, 3, 2, 6, 4}).value_or(0.0), 1.0 - 6.0 * 4.0 / 120.0);
  // With ties it is Pearson's correlation of the ranks 1.5, 1.5, 3 and 1, 2, 3: 1.5 / sqrt(1.5 * 2).
  EXPECT_NEAR(spearman({4, 4, 9}, {1, 2, 3}).value_or(0.0), 0.8660254037844386, 1e-15);
}

TEST(Spearman, ThereIsNoneWhereNothingVaries) {
  EXPECT_FALSE(spearman({1, 2, 3}, {5, 5, 5}).has_value());
  EXPECT_FALSE(spearman({1}, {5}).has_value());
}

}  // namespace
}  // namespace glocal::test::ranks_test
