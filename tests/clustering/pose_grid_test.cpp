#include "clustering/pose_grid.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "clustering/poses.hpp"

namespace glocal::clustering::pose_grid_test {
namespace {

using test::at;
using ::testing::ElementsAre;

constexpr auto cluster = test::clustered<PoseGridClusterer>;

// Cells of 0.5 m; of 30 deg, the first from -15 to 15 deg.
const std::vector<Hypothesis> some = {at(0.1, 0.1, 0), at(0.4, 0.4, 14), at(-0.1, 0.1, 0),
                                      at(0.1, 0.6, 0), at(0.1, 0.1, 16), at(0.1, 0.1, -14),
                                      at(1.2, 0.1, 0), at(1.6, 0.6, 20), at(0.1, 0.1, -134)};

TEST(PoseGridClusterer, PosesInACellAreTogether) {
  EXPECT_THAT(cluster(some, {.cell = 0.5, .cell_rotation_deg = 30.0}),
              ElementsAre(ElementsAre(0U, 1U, 5U), ElementsAre(2U), ElementsAre(3U), ElementsAre(4U),
                          ElementsAre(6U), ElementsAre(7U), ElementsAre(8U)));
}

TEST(PoseGridClusterer, NeighbouringCellsAreJoined) {
  // Those from 1.0 and 1.5 m on touch at an edge; between them and the others a column is empty.
  EXPECT_THAT(cluster(some, {.cell = 0.5, .cell_rotation_deg = 30.0, .joined = true}),
              ElementsAre(ElementsAre(0U, 1U, 2U, 3U, 4U, 5U), ElementsAre(6U, 7U), ElementsAre(8U)));
}

TEST(PoseGridClusterer, HeadingsAcrossTheSeam) {
  const std::vector<Hypothesis> seam = {at(0, 0, 170), at(0, 0, -170), at(0, 0, 180), at(0, 0, 150)};
  EXPECT_THAT(cluster(seam, {.cell_rotation_deg = 30.0}),
              ElementsAre(ElementsAre(0U, 1U, 2U), ElementsAre(3U)));
  // With an odd number of parts the seam is a border: joined, it is none.
  EXPECT_THAT(cluster({at(0, 0, 179), at(0, 0, -179)}, {.cell_rotation_deg = 40.0}),
              ElementsAre(ElementsAre(0U), ElementsAre(1U)));
  EXPECT_THAT(cluster({at(0, 0, 179), at(0, 0, -179)}, {.cell_rotation_deg = 40.0, .joined = true}),
              ElementsAre(ElementsAre(0U, 1U)));
}

TEST(PoseGridClusterer, OneCellForAllHeadings) {
  EXPECT_THAT(cluster({at(0.1, 0.1, 0), at(0.1, 0.1, 170), at(0.1, 0.1, -90)}, {.cell_rotation_deg = 360.0}),
              ElementsAre(ElementsAre(0U, 1U, 2U)));
}

TEST(PoseGridClusterer, NothingGivesNothing) {
  EXPECT_TRUE(cluster({}, {.joined = true}).empty());
}

}  // namespace
}  // namespace glocal::clustering::pose_grid_test
