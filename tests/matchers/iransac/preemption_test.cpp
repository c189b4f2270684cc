#include "matchers/iransac/preemption.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "test_world.hpp"

namespace glocal::iransac::preemption_test {
namespace {

TEST(Preemption, KeepsHalfAfterEachBlock) {
  for (const std::size_t m : {1U, 7U, 500U, 1000U}) {
    for (const std::size_t block : {1U, 16U, 100U}) {
      for (std::size_t i = 0; i < 2000; i += 13) {
        const std::size_t blocks = i / block;
        const double expected =
            std::floor(static_cast<double>(m) * std::pow(2.0, -static_cast<double>(blocks)));
        EXPECT_EQ(static_cast<double>(left_after(m, i, block)), expected);
      }
    }
  }
}

class PreemptionInSmallWorld : public ::testing::Test {
 protected:
  PreemptionInSmallWorld() {
    Rng rng(1);
    for (int i = 0; i < 300; ++i)
      poses_.push_back({{rng.uniform(0.0, 8.0), rng.uniform(0.0, 9.0), rng.uniform(-3.0, 3.0)}});
    poses_[250].map_from_local = truth_;
    for (const Point p : {Point{1.0F, 0.0F, 0.0F}, Point{0.0F, 1.0F, 0.0F}})
      far_.push_back({p.x + 99.0F, p.y, 0.0F});
  }
  const Pose2 truth_{2.0, 2.0, 0.4};
  Points all_ = test::local_map_at(truth_, 3.0).points;
  Points far_;  ///< In contact with nothing.
  std::vector<ScoredPose> poses_;
  std::shared_ptr<const ContactIndex> contact_ = contact_index(*test::small_world(), "bitset", 0.1);
};

TEST_F(PreemptionInSmallWorld, LooksAtAsManyAsTheScheduleLeaves) {
  ASSERT_GT(all_.size(), 64U);
  const std::size_t points_tested = preempt(poses_, *contact_, all_, {}, {.block = 16, .fewest = 20}, 1);
  // 300, 150, 75, 37 hypotheses look at a block each; then 20 are left, as 18 would be fewer.
  EXPECT_EQ(points_tested, 16U * (300 + 150 + 75 + 37));
  ASSERT_EQ(poses_.size(), 20U);
  EXPECT_EQ(poses_.front().map_from_local, truth_);
  EXPECT_EQ(poses_.front().in_contact, 64U);
  for (std::size_t i = 0; i < poses_.size(); ++i) {
    EXPECT_EQ(poses_[i].looked_at, 64U);
    EXPECT_EQ(poses_[i].in_contact, contact_->count(all_, 0, 64, Transform(poses_[i].map_from_local)));
    if (i > 0) {
      EXPECT_LE(poses_[i].score(), poses_[i - 1].score());
    }
  }
}

TEST_F(PreemptionInSmallWorld, CarriedOnesAreScoredByWhatIsNewOnTopOfWhatTheyHave) {
  poses_.resize(2);
  poses_[0].in_contact = 90;
  poses_[0].looked_at = 100;
  preempt(poses_, *contact_, all_, far_, {.block = 16, .fewest = 1}, 1);
  ASSERT_EQ(poses_.size(), 1U);
  EXPECT_EQ(poses_[0].in_contact, 90U);
  EXPECT_EQ(poses_[0].looked_at, 102U);
}

TEST_F(PreemptionInSmallWorld, IsTheSameForAnyNumberOfThreads) {
  std::vector<ScoredPose> two = poses_;
  preempt(poses_, *contact_, all_, far_, {}, 1);
  preempt(two, *contact_, all_, far_, {}, 2);
  ASSERT_EQ(poses_.size(), two.size());
  for (std::size_t i = 0; i < two.size(); ++i) EXPECT_EQ(poses_[i].map_from_local, two[i].map_from_local);
}

}  // namespace
}  // namespace glocal::iransac::preemption_test
