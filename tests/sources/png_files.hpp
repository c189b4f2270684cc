// PNG files of every kind, made by hand.
#pragma once

#include <png.h>

#include <initializer_list>
#include <string>
#include <vector>

namespace glocal::test {

inline std::string bytes(std::initializer_list<int> values) {
  std::string text;
  for (const int value : values) text += static_cast<char>(value);
  return text;
}

/// A PNG file by libpng's full interface, which the reader does not use. `data` holds the rows, big-endian
/// samples.
inline std::string make_png(int width, int height, int depth, int colour_type, std::string data,
                            const std::vector<png_color>& palette = {}, int interlace = PNG_INTERLACE_NONE) {
  std::string file;
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_set_write_fn(
      png, &file,
      [](png_structp p, png_bytep out, std::size_t n) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<const char*>(out), n);
      },
      nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(width), static_cast<png_uint_32>(height), depth,
               colour_type, interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!palette.empty()) png_set_PLTE(png, info, palette.data(), static_cast<int>(palette.size()));
  png_write_info(png, info);
  std::vector<png_bytep> rows;
  const std::size_t stride = data.size() / static_cast<std::size_t>(height);
  for (int row = 0; row < height; ++row) {
    rows.push_back(reinterpret_cast<png_bytep>(data.data()) + stride * static_cast<std::size_t>(row));
  }
  png_write_image(png, rows.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  return file;
}

}  // namespace glocal::test
