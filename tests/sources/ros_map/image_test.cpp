#include "sources/ros_map/image.hpp"

#include <gtest/gtest.h>

#include "files.hpp"
#include "sources/png_files.hpp"

namespace glocal::ros_map::image_test {
namespace {

using test::bytes;
using test::make_png;

/// All rows of an image, one behind the other.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<float> grey, opacity;
};

Image read(const std::string& bytes) {
  const test::TemporaryFolder folder;
  Image image;
  int rows = 0;
  read_image(folder.write("a.image", bytes), [&](const ImageRow& row) {
    EXPECT_EQ(row.row, rows++);
    image.width = row.width;
    image.height = row.height;
    image.grey.insert(image.grey.end(), row.grey.begin(), row.grey.end());
    image.opacity.insert(image.opacity.end(), row.opacity.begin(), row.opacity.end());
  });
  EXPECT_EQ(rows, image.height);
  return image;
}

std::string fault_of(const std::string& bytes) {
  const test::TemporaryFolder folder;
  const auto file = folder.write("a.image", bytes);
  return test::config_error(file.parent_path(), [&] { read_image(file, [](const ImageRow& /*row*/) {}); });
}

void expect_grey(const Image& image, int width, int height, const std::vector<double>& expected) {
  EXPECT_EQ(image.width, width);
  EXPECT_EQ(image.height, height);
  ASSERT_EQ(image.grey.size(), expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(image.grey[i], expected[i], 1e-4) << i;
}

TEST(Pgm, ReadsText) {
  expect_grey(read("P2 # a comment\n# and another: 7 7\n3 2\n10\n0 5 10\n1 2 # here too\n3"), 3, 2,
              {0, 0.5, 1, 0.1, 0.2, 0.3});
}

TEST(Pgm, ReadsBytes) {
  // The first pixel's value is that of a blank, the second's that of '#'.
  expect_grey(read("P5\n# map\n2 2 255\n" + bytes({32, 35, 0, 255})), 2, 2, {32 / 255.0, 35 / 255.0, 0, 1});
}

TEST(Pgm, ReadsSixteenBits) {
  expect_grey(read("P5 2 1 65535\n" + bytes({0x80, 0x00, 0xff, 0xff})), 2, 1, {32768 / 65535.0, 1});
  expect_grey(read("P5 1 1 1000\n" + bytes({0x01, 0xf4})), 1, 1, {0.5});
}

TEST(Pgm, RefusesWhatIsNoWholeImage) {
  const std::string again = ": the image is truncated; get a fresh copy";
  EXPECT_EQ(fault_of("P5\n2 2\n255\n" + bytes({1, 2, 3})),
            "a.image: error: ends before the end of its pixels" + again);
  EXPECT_EQ(fault_of("P5\n2 1\n65535\n" + bytes({1, 2, 3})),
            "a.image: error: ends before the end of its pixels" + again);
  EXPECT_EQ(fault_of("P5 2 2 255"), "a.image: error: ends before the end of its pixels" + again);
  EXPECT_EQ(fault_of("P2 2 2 255 1 2 3"), "a.image: error: ends before the end of its pixels" + again);
  EXPECT_EQ(fault_of("P5 8000 8000 65535\n" + std::string(1000, 'x')),
            "a.image: error: ends before the end of its pixels" + again);
  EXPECT_EQ(fault_of("P2 8000 8000 255\n" + std::string(1000, '1')),
            "a.image: error: ends before the end of its pixels" + again);
  EXPECT_EQ(fault_of("P5 2"), "a.image: error: ends before the end of its height" + again);
  EXPECT_EQ(fault_of("P5 x 2 255\n"), "a.image: error: has no number where its width should be");
  EXPECT_EQ(fault_of("P5 0 2 255\n"), "a.image: error: is an empty image (0 x 2 pixels)");
  EXPECT_EQ(fault_of("P5 2 2 0\n"), "a.image: error: maximum grey must be 1 to 65535, not 0");
  EXPECT_EQ(fault_of("P5 2 2 65536\n"), "a.image: error: maximum grey must be 1 to 65535, not 65536");
  EXPECT_EQ(fault_of("P5 100000 100000 255\n"),
            "a.image: error: is too large to hold (100000 x 100000 pixels, at most 1000 million); crop it or "
            "lower its resolution");
  EXPECT_EQ(fault_of("P5 99999999999999 1 255\n").substr(0, 40), "a.image: error: is too large to hold (21");
  for (const std::string& image : {std::string("P2 2 1 100 100 150"), "P5 2 1 100 " + bytes({100, 150})})
    EXPECT_EQ(fault_of(image),
              "a.image: error: has a pixel of 150, and says that none is above 100; get a fresh copy");
  const std::string other =
      "a.image: error: is neither a PGM (P2, P5) nor a PNG image; convert it to one of these";
  EXPECT_EQ(fault_of("P6 1 1 255\nabc"), other);
  EXPECT_EQ(fault_of(""), other);
}

TEST(Png, PassesOverWhatIsNoPicture) {
  const std::string plain = make_png(2, 1, 8, PNG_COLOR_TYPE_GRAY, bytes({0, 255}));
  constexpr std::size_t behind_header = 8 + 25;  // signature, IHDR
  std::string with_text = plain;
  with_text.insert(behind_header, bytes({0, 0, 0, 1}) + "tEXtx" + bytes({0x11, 0x98, 0x23, 0xE9}));
  expect_grey(read(with_text), 2, 1, {0, 1});
  std::string with_long_text = plain;
  with_long_text.insert(behind_header, bytes({0x7F, 0xFF, 0xFF, 0xFF}) + "tEXtx");
  EXPECT_EQ(fault_of(with_long_text).substr(0, 54), "a.image: error: is a damaged or truncated PNG image (t");
}

TEST(Png, ReadsGrey) {
  expect_grey(read(make_png(2, 2, 8, PNG_COLOR_TYPE_GRAY, bytes({0, 51, 102, 255}))), 2, 2, {0, 0.2, 0.4, 1});
  expect_grey(read(make_png(1, 1, 16, PNG_COLOR_TYPE_GRAY, bytes({0x40, 0x00}))), 1, 1, {16384 / 65535.0});
  expect_grey(read(make_png(8, 1, 1, PNG_COLOR_TYPE_GRAY, bytes({0b01100001}))), 8, 1,
              {0, 1, 1, 0, 0, 0, 0, 1});
}

TEST(Png, AveragesColours) {
  const Image image = read(make_png(2, 1, 8, PNG_COLOR_TYPE_RGB, bytes({255, 0, 0, 51, 102, 153})));
  expect_grey(image, 2, 1, {1 / 3.0, 0.4});
  EXPECT_TRUE(image.opacity.empty());
}

TEST(Png, KeepsAlphaApart) {
  const Image grey = read(make_png(2, 1, 8, PNG_COLOR_TYPE_GRAY_ALPHA, bytes({51, 255, 102, 0})));
  expect_grey(grey, 2, 1, {0.2, 0.4});
  EXPECT_EQ(grey.opacity, (std::vector<float>{1, 0}));
  const Image colour =
      read(make_png(1, 1, 16, PNG_COLOR_TYPE_RGB_ALPHA, bytes({255, 255, 0, 0, 0, 0, 0x80, 0})));
  expect_grey(colour, 1, 1, {1 / 3.0});
  EXPECT_NEAR(colour.opacity[0], 0.5, 1e-4);
}

TEST(Png, ReadsPalettes) {
  const std::vector<png_color> palette{{0, 0, 0}, {255, 255, 255}, {51, 51, 51}};
  expect_grey(read(make_png(3, 1, 8, PNG_COLOR_TYPE_PALETTE, bytes({2, 1, 0}), palette)), 3, 1, {0.2, 1, 0});
}

TEST(Png, ReadsInterlacedImages) {
  std::string data;
  std::vector<double> expected;
  for (int i = 0; i < 81; ++i) {
    data += static_cast<char>(3 * i);
    expected.push_back(3 * i / 255.0);
  }
  expect_grey(read(make_png(9, 9, 8, PNG_COLOR_TYPE_GRAY, data, {}, PNG_INTERLACE_ADAM7)), 9, 9, expected);
}

TEST(Png, RefusesDamagedImagesAnywhere) {
  std::string data(10000, '\0');
  for (std::size_t i = 0; i < data.size(); ++i) data[i] = static_cast<char>(i * i % 251);
  const std::string whole = make_png(100, 100, 8, PNG_COLOR_TYPE_GRAY, data);
  for (const std::size_t kept :
       {std::size_t{5}, std::size_t{20}, std::size_t{60}, whole.size() / 2, whole.size() - 20}) {
    const std::string fault = fault_of(whole.substr(0, kept));
    EXPECT_TRUE(fault.starts_with("a.image: error: is a damaged or truncated PNG image ("))
        << kept << " " << fault;
  }
  std::string flipped = whole;
  flipped[flipped.size() / 2] ^= 0x55;
  EXPECT_NE(fault_of(flipped), "");
}

TEST(Writers, AreReadBack) {
  const ByteImage image{3, 2, bytes({0, 254, 205, 35, 32, 10})};
  const std::vector<double> expected{0, 254 / 255.0, 205 / 255.0, 35 / 255.0, 32 / 255.0, 10 / 255.0};
  expect_grey(read(pgm(image)), 3, 2, expected);
  expect_grey(read(png(image)), 3, 2, expected);
}

}  // namespace
}  // namespace glocal::ros_map::image_test
