#include "evaluation/results/pcd.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <cstring>
#include <limits>

#include "files.hpp"
#include "glocal/error.hpp"
#include "points.hpp"

namespace glocal::test::pcd_test {
namespace {

using testing::HasSubstr;

Points two_points() {
  return points_of({{1.0F, -2.0F, 0.5F}, {0.0F, 4.0F, -0.0F}});
}

const std::string header_of_two =
    "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\n"
    "COUNT 1 1 1\nWIDTH 2\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS 2\nDATA binary\n";

class ReadPcd : public testing::Test {
 protected:
  /// What is said of a file with this content.
  std::string fault(const std::string& content) {
    try {
      static_cast<void>(read_pcd(folder_.write("a.pcd", content)));
    } catch (const ConfigError& error) {
      EXPECT_EQ(error.faults().front().file, folder_ / "a.pcd");
      EXPECT_THAT(error.what(), HasSubstr("; run the experiment again"));
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST(Pcd, IsAHeaderAndLittleEndianFloats) {
  const std::string bytes(
      "\x00\x00\x80\x3f"
      "\x00\x00\x00\xc0"
      "\x00\x00\x00\x3f"
      "\x00\x00\x00\x00"
      "\x00\x00\x80\x40"
      "\x00\x00\x00\x80",
      24);
  EXPECT_EQ(pcd(two_points()), header_of_two + bytes);
}

TEST(Pcd, OfNoPointsIsAHeader) {
  EXPECT_THAT(pcd({}), ::testing::EndsWith("POINTS 0\nDATA binary\n"));
}

TEST_F(ReadPcd, GivesThePointsThatWereWritten) {
  EXPECT_EQ(read_pcd(folder_.write("two.pcd", pcd(two_points()))), two_points());
  EXPECT_EQ(read_pcd(folder_.write("none.pcd", pcd({}))), Points{});
}

TEST_F(ReadPcd, RefusesWhatIsNotWhole) {
  const std::string whole = pcd(two_points());
  for (const std::size_t length : {whole.size() - 1, whole.size() - 12, header_of_two.size()}) {
    EXPECT_THAT(fault(whole.substr(0, length)), HasSubstr("where its header announces 2 points of 12 bytes"));
  }
  EXPECT_THAT(fault(whole + "x"), HasSubstr("has 25 bytes of points"));
  for (const std::size_t length : {header_of_two.size() - 1, std::size_t{130}, std::size_t{0}}) {
    EXPECT_THAT(fault(whole.substr(0, length)), HasSubstr("is no PCD file as glocal run leaves it"));
  }
}

TEST_F(ReadPcd, RefusesOtherFiles) {
  std::string ascii = header_of_two;
  ascii.replace(ascii.find("binary"), 6, "ascii");
  std::string many = header_of_two;
  many.replace(many.find("WIDTH 2"), 7, "WIDTH 99999999999999999999999");
  for (const std::string& foreign :
       {ascii + "1 2 3\n4 5 6\n", many, std::string("P5\n2 2\n255\n"), std::string("WIDTH ")})
    EXPECT_THAT(fault(foreign), HasSubstr("is no PCD file as glocal run leaves it")) << foreign;
  std::string most = header_of_two;
  for (const char* key : {"WIDTH ", "POINTS "})
    most.replace(most.find(key + std::string("2")), std::string(key).size() + 1,
                 key + std::string("6148914691236517206"));
  EXPECT_THAT(fault(most + std::string(8, 'x')), HasSubstr("has 8 bytes of points"));
}

TEST_F(ReadPcd, RefusesWhatIsNoFile) {
  for (const char* name : {"", "missing.pcd"})
    EXPECT_THAT(error_of([&] { return read_pcd(folder_ / name); }),
                HasSubstr("cannot be read; run the experiment again"))
        << name;
}

TEST_F(ReadPcd, RefusesCoordinatesThatAreNoLengths) {
  for (const float bad :
       {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), -2.0e6F}) {
    Points points = two_points();
    points.y[1] = bad;
    EXPECT_THAT(fault(pcd(points)), HasSubstr("no length within 2000 km, in point 1"));
  }
}

TEST(Pcd, WithAnOriginHasDoublePrecision) {
  const std::string text = pcd(two_points(), {500'000.0, 4'649'776.0, 0.0});
  std::string header = header_of_two;
  header.replace(header.find("4 4 4"), 5, "8 8 8");
  ASSERT_EQ(text.substr(0, header.size()), header);
  ASSERT_EQ(text.size(), header.size() + 6 * sizeof(double));
  std::array<double, 6> numbers{};
  std::memcpy(numbers.data(), text.data() + header.size(), sizeof numbers);
  EXPECT_THAT(numbers, testing::ElementsAre(500'001.0, 4'649'774.0, 0.5, 500'000.0, 4'649'780.0, 0.0));
}

TEST_F(ReadPcd, TakesDoublePrecisionRelativeToAnOrigin) {
  const Vector3 origin{500'000.0, 4'649'776.0, 0.0};
  const MapPoints map = read_map_pcd(folder_.write("far.pcd", pcd(two_points(), origin)));
  EXPECT_EQ(map.origin, Vector3(500'001, 4'649'774, 0));
  EXPECT_EQ(map.points[0], (Point{0.0F, 0.0F, 0.5F}));
  EXPECT_EQ(map.points[1], (Point{-1.0F, 6.0F, 0.0F}));
  const std::string whole = pcd(two_points(), origin);
  EXPECT_THAT(fault(whole.substr(0, whole.size() - 1)), HasSubstr("announces 2 points of 24 bytes"));
  Points points = two_points();
  points.x[1] = 1.0e7F;
  EXPECT_THAT(fault(pcd(points, origin)), HasSubstr("no length within 2000 km, in point 1"));
  EXPECT_EQ(read_map_pcd(folder_.write("near.pcd", pcd(two_points()))).origin, Vector3(0, 0, 0));
}

}  // namespace
}  // namespace glocal::test::pcd_test
