#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"
#include "sources/clouds/cloud_files.hpp"
#include "sources/clouds/cloud_formats.hpp"

namespace glocal::clouds::pcd_reader_test {
namespace {

using test::bytes;
using testing::ElementsAre;

Cloud read(const std::string& content, const CloudOptions& options = {}) {
  return read_pcd_cloud(content, "a.pcd", options);
}

std::string fault(const std::string& content, const CloudOptions& options = {}) {
  return test::config_error("", [&] { static_cast<void>(read(content, options)); });
}

/// A header; `fields` has the lines FIELDS, SIZE, TYPE and COUNT.
std::string header(const std::string& fields, int points, const std::string& data) {
  const std::string n = std::to_string(points);
  return "# .PCD v0.7 - Point Cloud Data file format\nVERSION 0.7\n" + fields + "WIDTH " + n +
         "\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\nPOINTS " + n + "\nDATA " + data + "\n";
}

const std::string xyz = "FIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n";
/// Other fields before, between and behind, one of them with three values.
const std::string mixed = "FIELDS rgb x _ y z t\nSIZE 4 8 1 4 2 4\nTYPE U F U F I U\nCOUNT 1 1 3 1 1 1\n";

std::string mixed_point(double x, float y, std::int16_t z, std::uint32_t t) {
  const std::uint8_t pad = 7;
  return bytes(std::uint32_t{9}, x, pad, pad, pad, y, z, t);
}

void expect_two_mixed(const Cloud& cloud) {
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0], (Point{1.5F, 2.5F, 3.0F}));
  EXPECT_EQ(cloud.points[1], (Point{-4.5F, 5.5F, -6.0F}));
  EXPECT_THAT(cloud.times, ElementsAre(0.0, testing::DoubleNear(0.05, 1e-12)));
  EXPECT_TRUE(cloud.normals.empty());
}

TEST(PcdReader, ReadsText) {
  const Cloud cloud = read(header(xyz, 2, "ascii") + "1 2.5 -3e-1\n\n+4 5 6\r\n");
  ASSERT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.points[0], (Point{1.0F, 2.5F, -0.3F}));
  EXPECT_EQ(cloud.points[1], (Point{4.0F, 5.0F, 6.0F}));
  expect_two_mixed(read(header(mixed, 2, "ascii") + "9 1.5 7 7 7 2.5 3 100\n9 -4.5 7 7 7 5.5 -6 50000100\n"));
}

TEST(PcdReader, ReadsFieldsOfAnyType) {
  expect_two_mixed(read(header(mixed, 2, "binary") + mixed_point(1.5, 2.5F, 3, 100) +
                        mixed_point(-4.5, 5.5F, -6, 50'000'100)));
}

TEST(PcdReader, ReadsCompressedFieldsOneAfterTheOther) {
  const std::uint8_t pad = 7;
  const std::string fields =
      bytes(std::uint32_t{9}, std::uint32_t{9}, 1.5, -4.5, pad, pad, pad, pad, pad, pad, 2.5F, 5.5F,
            std::int16_t{3}, std::int16_t{-6}, std::uint32_t{100}, std::uint32_t{50'000'100});
  const std::string packed = test::stored_as_lzf(fields);
  const std::string sizes =
      bytes(static_cast<std::uint32_t>(packed.size()), static_cast<std::uint32_t>(fields.size()));
  expect_two_mixed(read(header(mixed, 2, "binary_compressed") + sizes + packed));
}

TEST(PcdReader, RepeatsWhatWasJustDecompressed) {
  // A number, then 260 bytes from 4 bytes back.
  const std::string packed = "\x03" + bytes(1.5F) + "\xe0\xfb\x03";
  const std::string sizes = bytes(static_cast<std::uint32_t>(packed.size()), std::uint32_t{264});
  const Cloud cloud = read(header(xyz, 22, "binary_compressed") + sizes + packed);
  ASSERT_EQ(cloud.points.size(), 22U);
  for (std::size_t i = 0; i < 22; ++i) EXPECT_EQ(cloud.points[i], (Point{1.5F, 1.5F, 1.5F}));
}

TEST(PcdReader, ReadsTheFirstVersions) {
  const Cloud cloud = read("# a cloud\nCOLUMNS x y z\nPOINTS 1\nDATA ascii\n1 2 3\n");
  EXPECT_EQ(cloud.points[0], (Point{1.0F, 2.0F, 3.0F}));
}

TEST(PcdReader, ReadsOrganisedClouds) {
  EXPECT_EQ(read("VERSION .7\n" + xyz + "WIDTH 2\nHEIGHT 2\nDATA ascii\n1 0 0\n2 0 0\n3 0 0\n4 0 0\n")
                .points.size(),
            4U);
}

TEST(PcdReader, LeavesOutWhatIsNotFinite) {
  const Cloud cloud = read(header(xyz, 4, "ascii") + "1 2 3\nnan 0 0\n0 -inf 0\n4 5 6\n");
  EXPECT_EQ(cloud.points.size(), 2U);
  EXPECT_EQ(cloud.not_finite, 2U);
}

TEST(PcdReader, TakesNormalsIfAllPointsHaveOne) {
  const std::string fields =
      "FIELDS x y z normal_x normal_y normal_z curvature\nSIZE 4 4 4 4 4 4 4\nTYPE F F F F F F F\n";
  const Cloud cloud = read(header(fields, 2, "ascii") + "0 0 0 0 3 4 0\n1 0 0 0 0 1 0\n");
  ASSERT_EQ(cloud.normals.size(), 2U);
  EXPECT_FLOAT_EQ(cloud.normals[0].y, 0.6F);
  EXPECT_FLOAT_EQ(cloud.normals[0].z, 0.8F);
  EXPECT_TRUE(read(header(fields, 2, "ascii") + "0 0 0 0 0 1 0\n1 0 0 nan nan nan 0\n").normals.empty());
  EXPECT_TRUE(read(header(fields, 2, "ascii") + "0 0 0 0 0 0 0\n1 0 0 0 0 1 0\n").normals.empty());
}

TEST(PcdReader, KeepsTheViewpoint) {
  const Pose3 viewpoint =
      read("VERSION 0.7\n" + xyz +
           "WIDTH 1\nHEIGHT 1\nVIEWPOINT 1 2 3 0.6 0 0 0.8\nPOINTS 1\nDATA ascii\n1 2 3\n")
          .viewpoint;
  EXPECT_EQ(viewpoint, Pose3({1.0, 2.0, 3.0}, {0.6, 0.0, 0.0, 0.8}));
}

TEST(PcdReader, TakesOtherUnits) {
  EXPECT_EQ(read(header(xyz, 1, "ascii") + "1000 2000 -500\n", {.unit = 0.001}).points[0],
            (Point{1.0F, 2.0F, -0.5F}));
}

TEST(PcdReader, RefusesHeadersThatSayNothing) {
  EXPECT_EQ(fault("VERSION 0.7\n" + xyz + "WIDTH 1\n"),
            "a.pcd:6: error: the header ends without a DATA line; get a fresh copy");
  EXPECT_EQ(fault("WIDTH 1\nDATA ascii\n"),
            "a.pcd:2: error: the header has no FIELDS line; FIELDS x y z is the least");
  EXPECT_EQ(fault(xyz + "DATA ascii\n"),
            "a.pcd:5: error: the header has neither POINTS nor WIDTH; add POINTS");
  EXPECT_EQ(fault(xyz + "WIDTHS 1\n"),
            "a.pcd:5: error: 'WIDTHS' is no line of a PCD header; DATA and all it needs must come before the "
            "points");
  EXPECT_EQ(fault(xyz + xyz), "a.pcd:5: error: has FIELDS a second time; delete one of the lines");
  EXPECT_EQ(fault(header(xyz, 1, "text")),
            "a.pcd:11: error: 'text' is no kind of data; there are ascii, binary and binary_compressed");
}

TEST(PcdReader, RefusesFieldsThatAreNone) {
  EXPECT_EQ(fault(header("FIELDS x y i\nSIZE 4 4 4\nTYPE F F F\n", 1, "ascii")),
            "a.pcd:3: error: points have no z; x, y and z are needed, there is: x y i");
  EXPECT_EQ(fault(header("FIELDS x y z x\nSIZE 4 4 4 4\nTYPE F F F F\n", 1, "ascii")),
            "a.pcd:3: error: 'x' and 'x' are the same thing twice; leave out one of them");
  EXPECT_EQ(fault(header("FIELDS x y z\nSIZE 4 4\nTYPE F F F\n", 1, "ascii")),
            "a.pcd:4: error: SIZE has 2 values for 3 fields; give one for each");
  EXPECT_EQ(fault(header("FIELDS x y z\nSIZE 4 4 3\nTYPE F F F\n", 1, "ascii")),
            "a.pcd:5: error: field 'z' is of TYPE F and SIZE 3; there are I and U of 1, 2, 4 and 8 bytes, "
            "and F of 4 and 8");
  EXPECT_EQ(fault(header("FIELDS x y z\nCOUNT 1 1 0\n", 1, "ascii")),
            "a.pcd:4: error: '0' is no number of values from 1 to 1000000");
  EXPECT_EQ(fault(header("FIELDS x y z\nCOUNT 1 1 900000\n", 1, "ascii")),
            "a.pcd:3: error: a point has over 1000000 bytes; is this a cloud?");
}

TEST(PcdReader, RefusesNumbersThatContradictEachOther) {
  const std::string start = "VERSION 0.7\n" + xyz;
  EXPECT_EQ(
      fault(start + "WIDTH 3\nHEIGHT 2\nPOINTS 5\nDATA ascii\n"),
      "a.pcd:8: error: POINTS 5 is not WIDTH 3 times HEIGHT 2; put the header right, or get a fresh copy");
  EXPECT_THAT(fault(start + "WIDTH 9999999999999\nHEIGHT 9999999999999\nDATA binary\n"),
              testing::HasSubstr("is not WIDTH 9999999999999 times HEIGHT 9999999999999"));
  EXPECT_EQ(fault(start + "WIDTH -1\nDATA ascii\n"),
            "a.pcd:6: error: WIDTH must be one whole number, 0 or more");
  EXPECT_EQ(fault(start + "WIDTH 1\nVIEWPOINT 0 0 0 2 0 0 0\nDATA ascii\n1 2 3\n"),
            "a.pcd:7: error: VIEWPOINT must be a place and a unit quaternion: tx ty tz qw qx qy qz; 0 0 0 1 "
            "0 0 0 is none");
}

TEST(PcdReader, RefusesOtherNumbersOfPointsThanAnnounced) {
  EXPECT_EQ(fault(header(xyz, 3, "ascii") + "1 2 3\n4 5 6\n"),
            "a.pcd:11: error: the header announces 3 points, but 2 lines follow; get a fresh copy");
  for (const std::string& data : {bytes(1.0F, 2.0F), bytes(1.0F, 2.0F, 3.0F, 4.0F)})
    EXPECT_EQ(fault(header(xyz, 1, "binary") + data),
              "a.pcd:11: error: the header announces 1 points, but " + std::to_string(data.size()) +
                  " bytes follow, and a point has 12; get a fresh copy");
  EXPECT_EQ(
      fault("VERSION 0.7\n" + xyz + "WIDTH 1000000000000000000\nHEIGHT 1\nDATA binary\n" + bytes(1.0F)),
      "a.pcd:8: error: the header announces 1000000000000000000 points, but 4 bytes follow, and a point "
      "has 12; get a fresh copy");
}

TEST(PcdReader, RefusesDamagedCompressedData) {
  const std::string head = header(xyz, 1, "binary_compressed");
  const std::string packed = test::stored_as_lzf(bytes(1.0F, 2.0F, 3.0F));
  const auto with = [&](std::uint32_t packed_size, std::uint32_t size, const std::string& data) {
    return fault(head + bytes(packed_size, size) + data);
  };
  EXPECT_EQ(with(13, 12, packed), "");
  EXPECT_EQ(fault(head + "abc"),
            "a.pcd:11: error: the header announces 1 points, but nothing follows; get a fresh copy");
  EXPECT_EQ(with(13, 24, packed),
            "a.pcd:11: error: the header announces 1 points, but the data is said to unpack to 24 bytes, and "
            "a point has 12; get a fresh copy");
  EXPECT_EQ(with(14, 12, packed),
            "a.pcd:11: error: the header announces 1 points, but 13 bytes follow where compressed data of 14 "
            "bytes is announced; get a fresh copy");
  const std::string one = "\x03" + bytes(1.0F);
  const std::vector<std::string> damaged = {packed.substr(0, 12),  // ends within its bytes
                                            one + "\xc0",          // ends within a reference
                                            one + "\xc0\x04",      // refers to what is before the beginning
                                            one + std::string("\xe0\x00\x03", 3),  // more than announced
                                            one + "\xa0\x03",                      // less than announced
                                            ""};
  for (const std::string& data : damaged) {
    EXPECT_EQ(with(static_cast<std::uint32_t>(data.size()), 12, data),
              "a.pcd: error: the compressed data is damaged; get a fresh copy");
  }
  EXPECT_EQ(fault(head + bytes(std::uint32_t{13}, std::uint32_t{12}) + packed, {.max_size_gb = 1e-9}),
            "a.pcd: error: its points have more than 1e-09 GB when decompressed; if it is the right file, "
            "thin it out");
}

TEST(PcdReader, RefusesPointsThatAreNone) {
  EXPECT_EQ(fault(header(xyz, 0, "binary")), "a.pcd: error: has no points; give another file");
  EXPECT_EQ(fault(header(xyz, 1, "ascii") + "nan nan nan\n"),
            "a.pcd: error: none of its 1 points has finite coordinates; give another file");
  EXPECT_EQ(fault(header(xyz, 1, "ascii") + "1 2 three\n"), "a.pcd:12: error: 'three' is not a number");
  EXPECT_EQ(fault(header(xyz, 1, "ascii") + "1 2\n"),
            "a.pcd:12: error: has 2 values where a point has 3; delete the line and put POINTS and WIDTH "
            "right, or get a fresh copy");
  EXPECT_EQ(fault(header(xyz, 2, "binary") + bytes(1.0F, 2.0F, 3.0F, 4.0F, -2e7F, 5.0F)),
            "a.pcd: error: point 1 (from 0) has a coordinate of 2e+07 m, at most 1e+07 are allowed; if the "
            "file is not in metres, give its unit, else get a fresh copy");
}

}  // namespace
}  // namespace glocal::clouds::pcd_reader_test
