#include "matchers/common/quality.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "test_world.hpp"

namespace glocal::quality_test {
namespace {

std::shared_ptr<const ContactIndex> contact_of_world() {
  return contact_index(*test::small_world(), "bitset", 0.1);
}

/// n points of which the first `good` lie on the map and the others far away from it.
Points points_with_contact(std::size_t n, std::size_t good) {
  Points points;
  for (std::size_t i = 0; i < n; ++i) points.push_back({2.0F, i < good ? 0.0F : 2.0F, 0.0F});
  return points;
}

struct Answer {
  std::optional<double> quality;
  std::size_t points_tested;
};

/// The test of the pose that moves nothing.
Answer test_identity(const QualityTest& test, std::uint32_t start) {
  MotionBatch motions;
  motions.cosine[0] = 1.0F;
  const QualityTest::Outcome outcome = test.test(motions, 1, {start});
  return {outcome.passed.empty() ? std::nullopt : std::optional(outcome.passed.front().quality),
          outcome.points_tested};
}

TEST(QualityTest, IsTheShareOfPointsInContact) {
  Rng rng(1);
  const QualityTest test(points_with_contact(40, 30), contact_of_world(), {}, 0.7, rng);
  for (std::uint32_t start = 0; start < 100; ++start) {
    const auto outcome = test_identity(test, start << 25U);
    ASSERT_TRUE(outcome.quality);
    EXPECT_DOUBLE_EQ(*outcome.quality, 0.75);  // eq. 4
    EXPECT_EQ(outcome.points_tested, 40U);
  }
}

TEST(QualityTest, PosesInSpaceAreJudgedAsThoseInThePlane) {
  Rng rng(1);
  const QualityTest test(points_with_contact(40, 30), contact_of_world(), {}, 0.7, rng);
  Points memory;
  // Turned over about the wall that the points in contact lie along: these stay where they are.
  const RigidMotion over(Pose3(exponential({radians(180.0), 0.0, 0.0})));
  const RigidMotion away(Pose3(Vector3{-5.0, 0.0, 0.0}));
  for (std::uint32_t start = 0; start < 100; ++start) {
    const auto judged = test.test(over, start << 25U, memory);
    ASSERT_TRUE(judged.quality);
    EXPECT_DOUBLE_EQ(*judged.quality, 0.75);
    EXPECT_EQ(judged.points_tested, 40U);
    const auto given_up = test.test(away, start << 25U, memory);
    EXPECT_FALSE(given_up.quality);
    EXPECT_LT(given_up.points_tested, 40U);
  }
}

TEST(QualityTest, PosesOfABatchAreJudgedEachByItself) {
  // Moved by 5 m, no point is in contact.
  Rng rng(1);
  const QualityTest test(points_with_contact(40, 30), contact_of_world(), {}, 0.7, rng);
  MotionBatch motions;
  motions.cosine.fill(1.0F);
  for (std::size_t i = 0; i < 100; ++i) motions.x[i] = i % 3 == 0 ? 0.0F : -5.0F;
  const QualityTest::Outcome outcome = test.test(motions, 100, {});
  ASSERT_EQ(outcome.passed.size(), 34U);
  for (std::size_t i = 0; i < outcome.passed.size(); ++i) {
    EXPECT_EQ(outcome.passed[i].index, 3 * i);
    EXPECT_DOUBLE_EQ(outcome.passed[i].quality, 0.75);
  }
  EXPECT_EQ(outcome.points_tested, 34U * 40U + 66U * 8U);
}

TEST(QualityTest, TheThresholdItselfIsEnough) {
  const auto quality = [](double threshold) {
    Rng rng(1);
    return test_identity(QualityTest(points_with_contact(40, 30), contact_of_world(), {}, threshold, rng), 0);
  };
  EXPECT_TRUE(quality(0.75).quality);
  EXPECT_FALSE(quality(0.7501).quality);
}

TEST(QualityTest, GivesUpAtTheBoundOfEquation5) {
  // Nothing in contact: after k points the upper bound is 1.96 / (2 sqrt(k)). It is 0.346 for 8 and 0.245
  // for 16.
  const auto checks = [](double threshold) {
    Rng rng(1);
    const ExtrapolationRule rule{.batch = 8, .confidence_z = 1.96};
    return test_identity(QualityTest(points_with_contact(400, 0), contact_of_world(), rule, threshold, rng),
                         0)
        .points_tested;
  };
  EXPECT_EQ(checks(0.35), 8U);
  EXPECT_EQ(checks(0.34), 16U);
  EXPECT_EQ(checks(0.24), 24U);
}

TEST(QualityTest, GivesUpWhatTheOtherPointsCannotMend) {
  // 30 of 40 are needed; with 11 misses there can be at most 29, however wide the interval.
  const ExtrapolationRule never{.batch = 1, .confidence_z = 1e9};
  EXPECT_EQ(least_in_contact(never, 0.75, 40, 10), 0U);
  EXPECT_EQ(least_in_contact(never, 0.75, 40, 11), 1U);
  EXPECT_EQ(least_in_contact(never, 0.75, 40, 30), 20U);
}

TEST(QualityTest, WaldsBoundByHand) {
  // p1 = 0.8, p0 = 0.2, false rejects 1/64: a hit multiplies the likelihood ratio by 4, a miss divides it by
  // 4, so that a hypothesis is pursued while its misses exceed its hits by no more than three.
  const ExtrapolationRule rule{
      .kind = ExtrapolationRule::Kind::wald, .false_rejects = 1.0 / 64.0, .background = 0.2};
  EXPECT_EQ(least_in_contact(rule, 0.8, 100000, 2), 0U);
  EXPECT_EQ(least_in_contact(rule, 0.8, 100000, 9), 3U);
  EXPECT_EQ(least_in_contact(rule, 0.8, 100000, 21), 9U);
}

TEST(QualityTest, FewerPointsThanABatch) {
  Rng rng(1);
  const QualityTest test(points_with_contact(3, 2), contact_of_world(), {}, 0.5, rng);
  for (std::uint32_t start = 0; start < 9; ++start)
    EXPECT_NEAR(*test_identity(test, start << 28U).quality, 2.0 / 3.0, 1e-12);
}

/// How often a hypothesis of quality `quality` is given up although the threshold is just that.
double false_reject_rate(double quality, const ExtrapolationRule& rule) {
  constexpr int orders = 400;
  constexpr std::uint32_t starts = 20;
  constexpr std::size_t n = 1000;
  const auto contact = contact_of_world();
  int rejected = 0;
  for (int i = 0; i < orders; ++i) {
    Rng rng(static_cast<std::uint64_t>(i));
    const QualityTest test(points_with_contact(n, static_cast<std::size_t>(quality * n)), contact, rule,
                           quality, rng);
    for (std::uint32_t s = 0; s < starts; ++s)
      rejected += test_identity(test, s * (0xffffffffU / starts)).quality ? 0 : 1;
  }
  return static_cast<double>(rejected) / (orders * starts);
}

TEST(QualityTest, FalseRejectsAgainstTheConfidenceLevel) {
  // A single look at k points is one-sided: at the largest variance (quality 0.5) the upper bound of a 95 %
  // interval is too low in 2.5 % of cases; with higher quality the interval, which assumes that variance, is
  // wider than need be.
  const ExtrapolationRule one_look{.batch = 500, .confidence_z = 1.96};
  // Half of all points in one look without replacement: the deviation shrinks by sqrt(1 - 500 / 999).
  EXPECT_LT(false_reject_rate(0.5, one_look), 0.025);
  // Looking again after every eight points multiplies the chances to err: this is what eq. 5 costs where it
  // is worst.
  const ExtrapolationRule paper{.batch = 8, .confidence_z = 1.96};
  const double worst = false_reject_rate(0.5, paper);
  EXPECT_GT(worst, 0.025);
  EXPECT_LT(worst, 0.25);
  // Good hypotheses lie well above the threshold: 0.8 against 0.6 is hardly ever lost.
  const auto contact = contact_of_world();
  int lost = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    Rng rng(i);
    const QualityTest test(points_with_contact(1000, 800), contact, paper, 0.6, rng);
    lost += test_identity(test, 0).quality ? 0 : 1;
  }
  EXPECT_LT(lost, 40);  // 2 %
}

TEST(QualityTest, WaldKeepsItsWordHoweverOftenItLooks) {
  for (const double quality : {0.5, 0.7, 0.9}) {
    const ExtrapolationRule rule{
        .kind = ExtrapolationRule::Kind::wald, .false_rejects = 0.02, .background = 0.3};
    EXPECT_LT(false_reject_rate(quality, rule), 0.02) << quality;
  }
}

}  // namespace
}  // namespace glocal::quality_test
