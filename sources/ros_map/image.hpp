// Grey-scale images, as map servers keep maps.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace glocal::ros_map {

/// One row of an image; row 0 is the top row.
struct ImageRow {
  int width = 0;  ///< Of the image, as is the height.
  int height = 0;
  int row = 0;
  std::vector<float> grey = {};     ///< 0 black to 1 white; the mean of the colours of a coloured image.
  std::vector<float> opacity = {};  ///< 0 transparent to 1 opaque; empty for an image without alpha channel.
};
using TakeRow = std::function<void(const ImageRow&)>;

/// Reads PGM (P2 and P5, up to 16 bit) and PNG (grey, coloured, with palette, with or without alpha, up to 16
/// bit), known by what the file begins with, and hands on its rows from the top on: no more than one is held,
/// but for those of an interlaced PNG. Throws ConfigError for a missing, damaged, truncated or empty image,
/// one of another kind, one of more than max_grid_cells pixels (64 million, if it is interlaced), or a file
/// of more than 2 GB.
void read_image(const std::filesystem::path& file, const TakeRow& take);

/// An image of bytes, row 0 at the top; grey has width * height bytes.
struct ByteImage {
  int width = 0;
  int height = 0;
  std::string grey;
};

/// The image as a binary PGM file.
[[nodiscard]] std::string pgm(const ByteImage& image);

/// The image as a grey PNG file.
[[nodiscard]] std::string png(const ByteImage& image);

}  // namespace glocal::ros_map
