#include "matchers/indexed_ransam/step_candidates.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <vector>

#include "glocal/rng.hpp"
#include "test_world.hpp"

namespace glocal::indexed_ransam::step_candidates_test {
namespace {

const Pose2 truth{5.5, 2.5, 0.7};

/// A batch in which every other pose is near the truth, and the rest all over the world.
MotionBatch poses(std::size_t size) {
  Rng rng(4);
  MotionBatch batch;
  for (std::size_t i = 0; i < size; ++i) {
    const Pose2 off{rng.normal(0.1), rng.normal(0.1), rng.normal(0.05)};
    const Pose2 anywhere{rng.uniform(0.0, 8.0), rng.uniform(0.0, 9.0), rng.uniform(-3.1, 3.1)};
    const Transform t(i % 2 == 0 ? truth * off : anywhere);
    batch.cosine[i] = t.cosine();
    batch.sine[i] = t.sine();
    batch.x[i] = t.x();
    batch.y[i] = t.y();
  }
  return batch;
}

class StepCandidatesTest : public testing::Test {
 protected:
  std::shared_ptr<const GlobalMap> map_ = test::small_world();
  std::shared_ptr<const ContactIndex> contact_ = contact_index(*map_, "bitset", 0.1);
  PoseGate open_;
  Rng rng_{1};
  Points sample_ = sample_of(test::seen_from(map_->points(), truth, 3.0), 128, rng_);
};

TEST_F(StepCandidatesTest, AreThePosesWithEnoughContact) {
  const MotionBatch batch = poses(200);
  for (const double least : {0.0, 0.2, 0.6}) {
    StepCandidates candidates(*contact_, sample_, least, 1000, open_);
    candidates.test(batch, 200);
    EXPECT_TRUE(candidates.all().empty());
    candidates.look_closer();
    // The cheap look spares the closer one where even it is below the least, and loses next to nothing.
    std::size_t expected = 0;
    for (std::size_t i = 0; i < 200; ++i) expected += contact_->share(sample_, batch[i]) >= least ? 1 : 0;
    EXPECT_LE(candidates.all().size(), expected);
    EXPECT_GE(static_cast<double>(candidates.all().size()), 0.9 * static_cast<double>(expected)) << least;
    for (const Candidate& candidate : candidates.all()) {
      EXPECT_GE(candidate.quality, least);
      EXPECT_EQ(candidate.quality, contact_->share(sample_, Transform(candidate.map_from_local)));
    }
    EXPECT_EQ(candidates.tested(), 200U);
    EXPECT_LE(candidates.points_tested(), 200U * sample_.size());
    EXPECT_GE(candidates.points_tested(), 200U * 16U);
  }
}

TEST_F(StepCandidatesTest, OfManyTheBestAreThere) {
  const MotionBatch batch = poses(200);
  StepCandidates all(*contact_, sample_, 0.1, 1000, open_);
  StepCandidates best(*contact_, sample_, 0.1, 30, open_);
  for (int i = 0; i < 3; ++i) {
    all.test(batch, 200);
    best.test(batch, 200);
  }
  all.look_closer();
  best.look_closer();
  std::vector<double> qualities;
  for (const Candidate& candidate : all.all()) qualities.push_back(candidate.quality);
  std::sort(qualities.begin(), qualities.end(), std::greater<>());
  const double bar = qualities[29];
  const auto above = [&](const StepCandidates& candidates) {
    return std::count_if(candidates.all().begin(), candidates.all().end(),
                         [&](const Candidate& candidate) { return candidate.quality > bar; });
  };
  // What looked unpromising at first may be lost.
  EXPECT_GE(static_cast<double>(above(best)), 0.9 * static_cast<double>(above(all)));
  EXPECT_LT(best.all().size(), all.all().size() / 2);
  EXPECT_LT(best.points_tested(), all.points_tested());
}

TEST_F(StepCandidatesTest, KeepWhatIsAddedWhateverItsContact) {
  StepCandidates candidates(*contact_, sample_, 0.9, 1000, open_);
  candidates.add({-50.0, 0.0, 0.0});
  ASSERT_EQ(candidates.all().size(), 1U);
  EXPECT_EQ(candidates.all().front().quality, 0.0);
  EXPECT_EQ(candidates.tested(), 0U);
}

TEST_F(StepCandidatesTest, LeaveOutWhatThePriorExcludes) {
  const MotionBatch batch = poses(200);
  Prior prior;
  prior.region = {truth.x, truth.y, 0.12};
  const PoseGate gate(prior, {});
  StepCandidates all(*contact_, sample_, 0.2, 1000, open_);
  StepCandidates allowed(*contact_, sample_, 0.2, 1000, gate);
  all.test(batch, 200);
  allowed.test(batch, 200);
  all.look_closer();
  allowed.look_closer();
  std::size_t expected = 0;
  for (const Candidate& candidate : all.all())
    expected += distance(candidate.map_from_local, truth) <= 0.12 ? 1 : 0;
  EXPECT_EQ(allowed.all().size(), expected);
  EXPECT_LT(expected, all.all().size());
}

TEST_F(StepCandidatesTest, AreDistinctAndFitBetterOnceRefined) {
  StepCandidates candidates(*contact_, sample_, 0.2, 1000, open_);
  candidates.add(truth * Pose2{0.08, -0.05, 0.03});
  candidates.add(truth * Pose2{-0.06, 0.04, -0.02});
  candidates.add({1.0, 8.0, 1.0});
  const CandidateRefiner refiner(10, {}, distance_field(*map_, 1), contact_);
  candidates.refine(refiner, {});
  ASSERT_EQ(candidates.all().size(), 2U);
  EXPECT_LT(distance(candidates.all().front().map_from_local, truth), 0.01);
  EXPECT_GT(candidates.all().front().quality, 0.99);
}

}  // namespace
}  // namespace glocal::indexed_ransam::step_candidates_test
