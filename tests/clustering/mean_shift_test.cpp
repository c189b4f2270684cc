#include "clustering/mean_shift.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "clustering/poses.hpp"

namespace glocal::clustering::mean_shift_test {
namespace {

using test::at;
using test::Groups;
using ::testing::ElementsAre;

constexpr auto cluster = test::clustered<MeanShift>;

TEST(MeanShift, FlatKernelByHand) {
  // From 0.0 the mean within 1 m is 0.4, from there again; all of the first three end there. From 3.0 and 3.8
  // it is 3.4.
  const std::vector<Hypothesis> row = {at(0.0, 0, 0), at(0.4, 0, 0), at(0.8, 0, 0), at(3.0, 0, 0),
                                       at(3.8, 0, 0)};
  EXPECT_THAT(cluster(row, {.kernel = "flat", .bandwidth = 1.0}),
              ElementsAre(ElementsAre(0U, 1U, 2U), ElementsAre(3U, 4U)));
}

TEST(MeanShift, TwoMaximaWithABridgeStayTwo) {
  // A heavy pose at each end and light ones between, 0.2 m apart, as no clusterer by links would part them.
  std::vector<Hypothesis> bridge = {at(0.0, 0, 0, 50), at(1.0, 0, 0, 50)};
  for (const double x : {0.2, 0.4, 0.6, 0.8}) bridge.push_back(at(x, 0, 0));
  EXPECT_THAT(cluster(bridge, {.bandwidth = 0.25}),
              ElementsAre(ElementsAre(0U, 2U, 3U), ElementsAre(1U, 4U, 5U)));
  // Half a metre wide, the density has one maximum only: two normal distributions 2 sigma apart.
  EXPECT_EQ(cluster(bridge, {.bandwidth = 0.6}).size(), 1U);
}

TEST(MeanShift, SupportDecidesWhereTheMiddleGoes) {
  std::vector<Hypothesis> three = {at(0.0, 0, 0, 5), at(1.0, 0, 0, 1), at(0.5, 0, 0)};
  EXPECT_THAT(cluster(three, {.bandwidth = 0.2}), ElementsAre(ElementsAre(0U, 2U), ElementsAre(1U)));
  std::swap(three[0].support, three[1].support);
  EXPECT_THAT(cluster(three, {.bandwidth = 0.2}), ElementsAre(ElementsAre(0U), ElementsAre(1U, 2U)));
}

TEST(MeanShift, HeadingsAcrossTheSeamClimbToIt) {
  const std::vector<Hypothesis> seam = {at(0, 0, 173.7), at(0, 0, -173.7), at(0, 0, 178.5), at(0, 0, 0),
                                        at(0, 0, 90)};
  for (const char* kernel : {"flat", "gaussian"}) {
    EXPECT_THAT(cluster(seam, {.kernel = kernel}),
                ElementsAre(ElementsAre(0U, 1U, 2U), ElementsAre(3U), ElementsAre(4U)))
        << kernel;
  }
}

/// Where a pose climbs to among all others, each on its own, in units of the bandwidths.
Pose2 mode_of(Pose2 pose, const std::vector<Hypothesis>& hypotheses, double bandwidth, double bandwidth_rad) {
  for (int i = 0; i < 200; ++i) {
    double x = 0.0, y = 0.0, theta = 0.0, weights = 0.0;
    for (const Hypothesis& h : hypotheses) {
      const double dx = (h.map_from_robot.x - pose.x) / bandwidth;
      const double dy = (h.map_from_robot.y - pose.y) / bandwidth;
      const double dt =
          std::remainder(h.map_from_robot.heading() - pose.theta, 2.0 * std::numbers::pi) / bandwidth_rad;
      const double squared = dx * dx + dy * dy + dt * dt;
      if (squared > 9.0) continue;
      const double weight = static_cast<double>(h.support) * std::exp(-0.5 * squared);
      x += weight * dx;
      y += weight * dy;
      theta += weight * dt;
      weights += weight;
    }
    pose.x += bandwidth * x / weights;
    pose.y += bandwidth * y / weights;
    pose.theta += bandwidth_rad * theta / weights;
  }
  return pose;
}

TEST(MeanShift, TogetherIsWhatClimbsToTheSameModeOneByOne) {
  Rng rng(2);
  std::vector<Hypothesis> hypotheses;
  for (int i = 0; i < 300; ++i) {
    // Five places that touch each other, some on both sides of the seam.
    const int place = i % 5;
    const double x = 0.55 * place + rng.normal(0.08);
    const double y = rng.normal(0.08);
    hypotheses.push_back(at(x, y, 170.0 + 8.0 * place + rng.normal(4.0)));
  }
  const MeanShift::Params params{.bandwidth = 0.15};
  const Groups groups = cluster(hypotheses, params);
  ASSERT_EQ(groups.size(), 5U);
  int elsewhere = 0;
  for (const std::vector<std::size_t>& group : groups) {
    const Pose2 first =
        mode_of(seen_from_above(hypotheses[group.front()].map_from_robot), hypotheses, 0.15, radians(8.0));
    for (const std::size_t i : group) {
      const Pose2 mode =
          mode_of(seen_from_above(hypotheses[i].map_from_robot), hypotheses, 0.15, radians(8.0));
      elsewhere += distance(mode, first) > 0.1 ? 1 : 0;
    }
  }
  // Those that climb together from a watershed may part if each goes on its own.
  EXPECT_LE(elsewhere, 3);
}

TEST(MeanShift, InSpaceByHand) {
  // Two heights and two ways to lean, around each of which three poses lie.
  std::vector<Hypothesis> poses;
  for (const double z : {0.0, 1.0}) {
    for (const double roll : {0.0, 0.6}) {
      for (const double off : {-0.02, 0.0, 0.02})
        poses.push_back({.map_from_local = {},
                         .map_from_robot = Pose3({off, 0.0, z + off}, exponential({roll + off, off, 0.0})),
                         .score = 0.7});
    }
  }
  for (const char* kernel : {"flat", "gaussian"}) {
    EXPECT_THAT(cluster(poses, {.kernel = kernel, .bandwidth = 0.15}),
                ElementsAre(ElementsAre(0U, 1U, 2U), ElementsAre(3U, 4U, 5U), ElementsAre(6U, 7U, 8U),
                            ElementsAre(9U, 10U, 11U)))
        << kernel;
  }
}

TEST(MeanShift, InSpaceAndInThePlaneAreTheSameWhereAllIsPlanarButALittle) {
  Rng rng(4);
  const std::vector<Hypothesis> planar = test::crowded(300, rng);
  std::vector<Hypothesis> spatial = planar;
  for (Hypothesis& h : spatial) h.map_from_robot.z = 1e-9;
  const auto count = [](const std::vector<Hypothesis>& hypotheses) {
    return static_cast<double>(cluster(hypotheses, {}).size());
  };
  // What climbs together differs: cells there, groups here.
  EXPECT_NEAR(count(spatial), count(planar), 0.1 * count(planar));
}

TEST(MeanShift, ManyAtOnePlaceAreOneCluster) {
  Rng rng(9);
  std::vector<Hypothesis> crowd;
  for (int i = 0; i < 100'000; ++i) crowd.push_back(at(rng.normal(0.05), rng.normal(0.05), rng.normal(2.0)));
  EXPECT_LE(cluster(crowd, {}).size(), 3U);
}

}  // namespace
}  // namespace glocal::clustering::mean_shift_test
