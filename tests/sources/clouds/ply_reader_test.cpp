#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"
#include "sources/clouds/cloud_files.hpp"
#include "sources/clouds/cloud_formats.hpp"

namespace glocal::clouds::ply_reader_test {
namespace {

using test::bytes;
using test::swapped_bytes;

Cloud read(const std::string& content) {
  return read_ply_cloud(content, "a.ply", {});
}

std::string fault(const std::string& content) {
  return test::config_error("", [&] { static_cast<void>(read(content)); });
}

std::string ply(const std::string& format, const std::string& elements) {
  return "ply\nformat " + format + " 1.0\ncomment made by hand\n" + elements + "end_header\n";
}

const std::string vertex = "element vertex 2\nproperty double x\nproperty float y\nproperty short z\n";
const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";

void expect_two(const Cloud& cloud) {
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0], (Point{1.5F, 2.5F, 3.0F}));
  EXPECT_EQ(cloud.points[1], (Point{-4.5F, 5.5F, -6.0F}));
}

TEST(PlyReader, ReadsText) {
  expect_two(read(ply("ascii", vertex + faces) + "1.5 2.5 3\n-4.5 5.5 -6\n3 0 1 0\n"));
  expect_two(read(ply("ascii", faces + vertex) + "3 0 1 0\n1.5 2.5 3\r\n\n-4.5 5.5 -6"));
}

TEST(PlyReader, ReadsBothByteOrders) {
  const std::string native = bytes(1.5, 2.5F, std::int16_t{3}, -4.5, 5.5F, std::int16_t{-6});
  const std::string other = swapped_bytes(1.5, 2.5F, std::int16_t{3}, -4.5, 5.5F, std::int16_t{-6});
  expect_two(read(ply("binary_little_endian", vertex) + native));
  expect_two(read(ply("binary_big_endian", vertex) + other));
}

TEST(PlyReader, PassesOverListsAndOtherElements) {
  const std::string listed =
      "element vertex 2\nproperty double x\nproperty list uint8 uint16 rings\nproperty float y\nproperty "
      "int16 z\n";
  const std::string face = bytes(std::uint8_t{2}, 1, 2);
  const std::uint8_t two = 2, none = 0;
  const std::uint16_t ring = 5;
  expect_two(read(ply("binary_little_endian", "element empty 7\n" + faces + listed) + face +
                  bytes(1.5, two, ring, ring, 2.5F, std::int16_t{3}, -4.5, none, 5.5F, std::int16_t{-6})));
}

TEST(PlyReader, ReadsNormalsAndTimes) {
  const Cloud cloud =
      read(ply("ascii",
               "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
               "property float nx\nproperty float ny\nproperty float nz\nproperty double time\n") +
           "0 0 0 0 0 2 10.25\n1 0 0 0 1 0 10\n");
  EXPECT_EQ(cloud.normals[0], (Point{0.0F, 0.0F, 1.0F}));
  EXPECT_THAT(cloud.times, testing::ElementsAre(0.25, 0.0));
}

TEST(PlyReader, RefusesHeadersThatAreNone) {
  EXPECT_EQ(fault("ply\nformat ascii 1.0\n" + vertex),
            "a.ply:6: error: the header ends without an end_header line; get a fresh copy");
  EXPECT_EQ(fault("ply\n" + vertex + "end_header\n"),
            "a.ply:6: error: the header has no format line; format ascii 1.0 is one");
  EXPECT_EQ(
      fault(ply("text", vertex)),
      "a.ply:2: error: 'text' is no format; there are ascii, binary_little_endian and binary_big_endian");
  EXPECT_EQ(fault(ply("ascii", faces)), "a.ply:6: error: there is no element vertex; a cloud is needed");
  EXPECT_EQ(fault(ply("ascii", "element vertex -1\n")),
            "a.ply:4: error: an element has a name and a number of items: element vertex 100");
  EXPECT_EQ(fault(ply("ascii", "property float x\n")),
            "a.ply:4: error: a property needs an element before it: element vertex 100");
  EXPECT_EQ(fault(ply("ascii", "element vertex 1\nproperty x\n")),
            "a.ply:5: error: a property has a type and a name (property float x), or is a list of two types "
            "and a name");
  EXPECT_THAT(fault(ply("ascii", "element vertex 1\nproperty half x\n")),
              testing::HasSubstr("a.ply:5: error: 'half' is no type; there are char, "));
  EXPECT_EQ(fault(ply("ascii", "element vertex 1\nproperty list float int x\n")),
            "a.ply:5: error: a list needs a whole number for its length: uchar, int …");
  EXPECT_EQ(fault(ply("ascii", "vertices 1\n")),
            "a.ply:4: error: 'vertices' is no line of a PLY header; delete it or get a fresh copy");
  EXPECT_EQ(fault(ply("ascii", "element vertex 1\nproperty float x\nproperty list uchar float y\n")),
            "a.ply:4: error: points have no y; x, y and z are needed, there is: x ");
}

TEST(PlyReader, RefusesDataThatIsCutOffOrTooLong) {
  EXPECT_EQ(fault(ply("ascii", vertex) + "1 2 3\n"),
            "a.ply:9: error: the header announces 2 items of 'vertex', but 1 follow; get a fresh copy");
  EXPECT_EQ(fault(ply("ascii", vertex) + "1 2 3\n4 5\n"),
            "a.ply:10: error: ends after 2 values; put it right or get a fresh copy");
  EXPECT_EQ(fault(ply("ascii", vertex) + "1 2 3 4\n"),
            "a.ply:9: error: has 4 values where 3 are needed; put it right or get a fresh copy");
  EXPECT_EQ(fault(ply("ascii", vertex) + "1 2 z\n"), "a.ply:9: error: 'z' is not a number");
  EXPECT_EQ(fault(ply("binary_little_endian", vertex) + bytes(1.5, 2.5F)),
            "a.ply: error: ends 12 bytes behind the header, within an item; get a fresh copy");
  EXPECT_EQ(fault(ply("binary_little_endian", vertex) + bytes(1.5, 2.5F, std::int16_t{3})),
            "a.ply: error: the header announces 2 items of 'vertex', but 1 follow; get a fresh copy");
  EXPECT_EQ(fault(ply("ascii", vertex) + "1 2 3\n4 5 6\n7 8 9\n"),
            "a.ply:11: error: the header announces 2 points, but more follow; get a fresh copy");
  const std::string points = bytes(1.5, 2.5F, std::int16_t{3}, -4.5, 5.5F, std::int16_t{-6});
  EXPECT_EQ(fault(ply("binary_little_endian", vertex) + points + points),
            "a.ply: error: the header announces 2 points, but more follow; get a fresh copy");
  expect_two(read(ply("binary_little_endian", vertex) + points + "\n"));
}

TEST(PlyReader, RefusesListsAndNumbersThatCannotBe) {
  const std::string list = "element face 1\nproperty list int double of\n" + vertex;
  EXPECT_EQ(fault(ply("binary_little_endian", list) + bytes(-3)),
            "a.ply: error: a list 'of' of -3 entries; get a fresh copy");
  EXPECT_EQ(fault(ply("binary_little_endian", list) + bytes(2'000'000'000)),
            "a.ply: error: ends 4 bytes behind the header, within an item; get a fresh copy");
  EXPECT_EQ(
      fault(ply("ascii",
                "element vertex 99999999999999\nproperty float x\nproperty float y\nproperty float z\n")),
      "a.ply:8: error: the header announces 99999999999999 items of 'vertex', but 0 follow; get a fresh "
      "copy");
  EXPECT_EQ(fault(ply("ascii", "element vertex 0\nproperty float x\nproperty float y\nproperty float z\n")),
            "a.ply: error: has no points; give another file");
}

}  // namespace
}  // namespace glocal::clouds::ply_reader_test
