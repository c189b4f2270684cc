// Grey-scale images, as map servers keep maps.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "sources/compressed_file.hpp"

namespace glocal {

/// Row 0 is the top row.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<float> grey;     ///< 0 black to 1 white; the mean of the colours of a coloured image.
  std::vector<float> opacity;  ///< 0 transparent to 1 opaque; empty for an image without alpha channel.

  [[nodiscard]] std::size_t index(int column, int row) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(width) + static_cast<std::size_t>(column);
  }
};

/// Reads PGM (P2 and P5, up to 16 bit) and PNG (grey, coloured, with palette, with or without alpha, up to 16
/// bit), known by what the file begins with. Throws ConfigError for a missing, damaged, truncated or empty
/// image, one of another kind, one of more than 64 million pixels, or a file of more than max_size_gb (10^9
/// bytes).
[[nodiscard]] Image read_image(const std::filesystem::path& file, double max_size_gb = default_max_size_gb);

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

}  // namespace glocal
