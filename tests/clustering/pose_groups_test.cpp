#include "clustering/pose_groups.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "clustering/poses.hpp"

namespace glocal::clustering::pose_groups_test {
namespace {

class Groups : public testing::Test {
 protected:
  Groups() {
    Rng rng(1);
    for (const Hypothesis& h : test::in_space(test::crowded(500, rng), rng))
      poses_.push_back(h.map_from_robot);
  }
  std::vector<Pose3> poses_;
  PoseTolerance radius_{0.2, 0.3};
};

TEST_F(Groups, EachPoseIsInOneWithOthersNearIt) {
  const PoseGroups groups(poses_, radius_);
  std::vector<int> seen(poses_.size(), 0);
  for (std::size_t g = 0; g < groups.size(); ++g) {
    const auto members = groups.members(g);
    ASSERT_FALSE(members.empty());
    EXPECT_TRUE(std::is_sorted(members.begin(), members.end()));
    EXPECT_EQ(groups.leader(g), poses_[members.front()]);
    for (const std::size_t i : members) {
      ++seen[i];
      for (const std::size_t j : members) EXPECT_TRUE(radius_.are_near(poses_[i], poses_[j]));
    }
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), 1), 500);
  EXPECT_LT(groups.size(), 400U);
}

TEST_F(Groups, NothingWithinReachIsMissed) {
  const PoseGroups groups(poses_, radius_);
  const PoseTolerance reach{1.5 * radius_.translation, 1.5 * radius_.rotation};
  for (std::size_t i = 0; i < poses_.size(); i += 7) {
    std::set<std::size_t> found;
    groups.visit_near(poses_[i], reach, [&](std::size_t g) {
      found.insert(groups.members(g).begin(), groups.members(g).end());
      return true;
    });
    for (std::size_t j = 0; j < poses_.size(); ++j) {
      if (reach.are_near(poses_[i], poses_[j])) {
        EXPECT_TRUE(found.contains(j)) << i << ", " << j;
      }
    }
  }
}

TEST_F(Groups, AVisitEndsWhereItIsToldTo) {
  const PoseGroups groups(poses_, {10.0, 4.0});
  int visits = 0;
  groups.visit_near(poses_.front(), {15.0, 4.0}, [&](std::size_t) {
    ++visits;
    return false;
  });
  EXPECT_EQ(visits, 1);
}

}  // namespace
}  // namespace glocal::clustering::pose_groups_test
