#include "glocal/motion.hpp"

#include <gtest/gtest.h>

#include "glocal/registry.hpp"

namespace glocal::motion_test {
namespace {

struct Silent {};
struct Able {
  static constexpr Motions motions = all_motions;
};

TEST(Motions, AClassThatSaysNothingWorksInThePlane) {
  EXPECT_EQ(motions_of<Silent>(), Motions{});
  EXPECT_TRUE(Motions{}.contain(Motion::planar));
  EXPECT_FALSE(Motions{}.contain(Motion::upright));
  EXPECT_FALSE(Motions{}.contain(Motion::free));
}

TEST(Motions, AClassSaysMoreWithAMember) {
  for (const Motion motion : every_motion) EXPECT_TRUE(motions_of<Able>().contain(motion));
}

TEST(Motions, HaveNames) {
  EXPECT_EQ(to_string(Motions{}), "planar");
  EXPECT_EQ(to_string(all_motions), "planar or upright or free");
  EXPECT_EQ(to_string(Motions{.planar = false, .upright = true}), "upright");
}

}  // namespace
}  // namespace glocal::motion_test
