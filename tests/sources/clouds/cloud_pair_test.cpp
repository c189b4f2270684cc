#include "sources/clouds/cloud_pair.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/results/pcd.hpp"
#include "files.hpp"

namespace glocal::clouds::cloud_pair_test {
namespace {

using testing::ElementsAre;

Points cloud(float x) {
  Points points;
  for (int i = 0; i < 3; ++i) points.push_back({x, static_cast<float>(i), 0.0F});
  return points;
}

class CloudPairTest : public testing::Test {
 protected:
  CloudPairTest() {
    for (const int i : {1, 2, 3, 4})
      folder_.write(std::to_string(i) + ".pcd", pcd(cloud(static_cast<float>(i))));
    list_ = test::file_path(folder_.write("pairs.csv",
                                          "source,target,tx,ty,tz,qx,qy,qz,qw\n"
                                          "1.pcd,2.pcd,0,0,0,0,0,0,1\n3.pcd,4.pcd,5,6,7,0,0,1,0\n"));
  }

  test::TemporaryFolder folder_;
  FilePath list_;
  std::vector<std::string> inputs_;
  SourceSetup setup_{.note_input = [&](const auto& file) { inputs_.push_back(file.filename()); }};
};

TEST_F(CloudPairTest, HasTheTargetAsMap) {
  EXPECT_EQ(CloudPairMap({list_, 2}, setup_).load().points, cloud(4.0F));
  EXPECT_THAT(inputs_, ElementsAre("pairs.csv", "4.pcd"));
}

TEST_F(CloudPairTest, HasTheSourceAsItsOnlyScan) {
  CloudPairScan scan({list_, 2}, setup_);
  const auto sample = scan.next();
  ASSERT_TRUE(sample);
  EXPECT_EQ(sample->observation.scan.hits, cloud(3.0F));
  ASSERT_TRUE(sample->map_from_robot);
  EXPECT_EQ(sample->map_from_robot->translation(), Vector3(5.0, 6.0, 7.0));
  EXPECT_NEAR(degrees(angle_of(sample->map_from_robot->rotation)), 180.0, 1e-9);
  EXPECT_FALSE(scan.next());
  EXPECT_THAT(inputs_, ElementsAre("pairs.csv", "3.pcd"));
}

TEST_F(CloudPairTest, RefusesAPairThatIsNotThere) {
  const CloudPairScan::Params third = {list_, 3};
  EXPECT_THAT(test::error_of([&] { CloudPairScan(third, setup_); }),
              testing::HasSubstr("pairs.csv: error: has 2 pairs, and no pair 3"));
}

}  // namespace
}  // namespace glocal::clouds::cloud_pair_test
