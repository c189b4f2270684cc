#include "sources/ros_map/image.hpp"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <charconv>
#include <csetjmp>
#include <cstring>
#include <limits>
#include <string_view>

#include "glocal/error.hpp"
#include "glocal/occupancy_grid.hpp"
#include "sources/compressed_file.hpp"

namespace glocal::ros_map {
namespace {

/// Refuses what cannot be held, before it takes any memory.
void check_size(const std::filesystem::path& file, double width, double height, double max_pixels) {
  if (width < 1.0 || height < 1.0)
    throw ConfigError(file, fmt::format("is an empty image ({} x {} pixels)", width, height));
  if (width * height > max_pixels) {
    throw ConfigError(
        file,
        fmt::format(
            "is too large to hold ({} x {} pixels, at most {:.0f} million); crop it or lower its resolution",
            width, height, max_pixels / 1e6));
  }
}

/// Reads PGM as netpbm describes it.
class PgmReader {
 public:
  PgmReader(const std::filesystem::path& file, std::string_view bytes) : file_(file), bytes_(bytes) {}

  void read(const TakeRow& take) {
    const bool binary = bytes_[1] == '5';
    at_ = 2;
    const int width = number("width");
    const int height = number("height");
    const int maximum = number("maximum grey");
    if (maximum < 1 || maximum > 65535)
      throw ConfigError(file_, fmt::format("maximum grey must be 1 to 65535, not {}", maximum));
    check_size(file_, width, height, max_grid_cells);
    const double bytes_per_pixel = binary && maximum < 256 ? 1.0 : 2.0;  // a digit and a blank are two, too
    if (static_cast<double>(bytes_.size() - at_) + 1.0 < bytes_per_pixel * width * height)
      truncated("pixels");
    if (binary) ++at_;  // A single blank ends the header.
    ImageRow row{.width = width, .height = height};
    row.grey.resize(static_cast<std::size_t>(width));
    for (; row.row < height; ++row.row) {
      if (binary) {
        read_binary(row.grey, maximum);
      } else {
        for (float& grey : row.grey) grey = scaled(number("pixels"), maximum);
      }
      take(row);
    }
  }

 private:
  void skip_blanks_and_comments() {
    while (at_ < bytes_.size()) {
      if (bytes_[at_] == '#') {
        at_ = std::min(bytes_.find('\n', at_), bytes_.size());
      } else if (std::string_view(" \t\r\n\v\f").find(bytes_[at_]) == std::string_view::npos) {
        return;
      } else {
        ++at_;
      }
    }
  }

  int number(const char* what) {
    skip_blanks_and_comments();
    if (at_ >= bytes_.size()) truncated(what);
    int value = 0;
    const char* end = bytes_.data() + bytes_.size();
    const auto [stop, error] = std::from_chars(bytes_.data() + at_, end, value);
    if (error == std::errc::result_out_of_range) value = std::numeric_limits<int>::max();
    if (error == std::errc::invalid_argument || value < 0)
      throw ConfigError(file_, fmt::format("has no number where its {} should be", what));
    at_ = static_cast<std::size_t>(stop - bytes_.data());
    return value;
  }

  void read_binary(std::vector<float>& row, int maximum) {
    const std::size_t size = maximum < 256 ? 1 : 2;
    if (bytes_.size() < at_ || (bytes_.size() - at_) / size < row.size()) truncated("pixels");
    const auto* bytes = reinterpret_cast<const unsigned char*>(bytes_.data()) + at_;
    for (float& grey : row) {
      const int value = size == 1 ? bytes[0] : bytes[0] * 256 + bytes[1];
      grey = scaled(value, maximum);
      bytes += size;
    }
    at_ += row.size() * size;
  }

  [[nodiscard]] float scaled(int value, int maximum) const {
    if (value > maximum)
      throw ConfigError(
          file_,
          fmt::format("has a pixel of {}, and says that none is above {}; get a fresh copy", value, maximum));
    return static_cast<float>(value) / static_cast<float>(maximum);
  }

  [[noreturn]] void truncated(const char* what) const {
    throw ConfigError(
        file_, fmt::format("ends before the end of its {}: the image is truncated; get a fresh copy", what));
  }

  std::filesystem::path file_;
  std::string_view bytes_;
  std::size_t at_ = 0;
};

/// Reads PNG with libpng, whose errors must not leave through C code: they are kept, and jump back.
class PngReader {
 public:
  PngReader(const std::filesystem::path& file, std::string_view bytes)
      : file_(file), bytes_(bytes), whole_size_(bytes.size()) {
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, this, &PngReader::on_error, &PngReader::on_warning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) throw RunError(file.string() + ": libpng cannot start");
    png_set_read_fn(png_, this, &PngReader::on_read);
    // Texts, profiles and the like are passed over: they may say that they have gigabytes.
    constexpr int all = -1;
    png_set_keep_unknown_chunks(png_, PNG_HANDLE_CHUNK_NEVER, nullptr, all);
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  void read(const TakeRow& take) {
    if (!read_header()) refuse();
    const png_uint_32 width = png_get_image_width(png_, info_);
    const png_uint_32 height = png_get_image_height(png_, info_);
    const bool interlaced = png_get_interlace_type(png_, info_) != PNG_INTERLACE_NONE;
    constexpr double most_held = 64e6;
    check_size(file_, width, height, interlaced ? most_held : max_grid_cells);
    check_length();
    channels_ = png_get_channels(png_, info_);
    const std::size_t stride = png_get_rowbytes(png_, info_);
    pixels_.resize(stride * (interlaced ? height : 1));
    if (interlaced && !read_interlaced(stride, height)) refuse();
    ImageRow row{.width = static_cast<int>(width), .height = static_cast<int>(height)};
    for (; row.row < row.height; ++row.row) {
      if (!interlaced && !read_row()) refuse();
      convert(pixels_.data() + (interlaced ? stride * static_cast<std::size_t>(row.row) : 0), row);
      take(row);
    }
    if (!read_end()) refuse();
  }

 private:
  /// Every kind of image becomes 16-bit grey or RGB, with alpha or without. Between setjmp and the calls that
  /// may jump there are no objects with destructors.
  bool read_header() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_info(png_, info_);
    packed_stride_ = png_get_rowbytes(png_, info_);
    png_set_expand_16(png_);
    png_set_interlace_handling(png_);
    png_read_update_info(png_, info_);
    return true;
  }
  /// Refuses what says it has more pixels than so many bytes decompress to, before it takes any memory.
  void check_length() {
    constexpr double highest_ratio = 1032.0;  // of DEFLATE
    const double packed = static_cast<double>(packed_stride_) * png_get_image_height(png_, info_);
    if (packed <= highest_ratio * static_cast<double>(whole_size_)) return;
    error_ = "the file ends early";
    refuse();
  }
  bool read_row() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_row(png_, pixels_.data(), nullptr);
    return true;
  }
  bool read_interlaced(std::size_t stride, std::size_t height) {
    std::vector<png_bytep> rows(height);
    for (std::size_t row = 0; row < height; ++row) rows[row] = pixels_.data() + row * stride;
    return read_whole(rows.data());
  }
  bool read_whole(png_bytepp rows) {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_image(png_, rows);
    return true;
  }
  bool read_end() {
    if (setjmp(png_jmpbuf(png_)) != 0) return false;
    png_read_end(png_, nullptr);
    return true;
  }

  void convert(const unsigned char* pixels, ImageRow& row) const {
    const bool alpha = channels_ % 2 == 0;
    const int colours = alpha ? channels_ - 1 : channels_;
    const auto width = static_cast<std::size_t>(row.width);
    row.grey.resize(width);
    if (alpha) row.opacity.resize(width);
    const auto sample = [&pixels] {
      const int value = pixels[0] * 256 + pixels[1];
      pixels += 2;
      return static_cast<float>(value) / 65535.0F;
    };
    for (std::size_t i = 0; i < width; ++i) {
      float sum = 0.0F;
      for (int c = 0; c < colours; ++c) sum += sample();
      row.grey[i] = sum / static_cast<float>(colours);
      if (alpha) row.opacity[i] = sample();
    }
  }

  [[noreturn]] void refuse() const {
    throw ConfigError(file_,
                      fmt::format("is a damaged or truncated PNG image ({}); get a fresh copy", error_));
  }

  static void on_error(png_structp png, png_const_charp message) {
    static_cast<PngReader*>(png_get_error_ptr(png))->error_ = message;
    png_longjmp(png, 1);
  }
  static void on_warning(png_structp /*png*/, png_const_charp /*message*/) {}
  static void on_read(png_structp png, png_bytep out, std::size_t n) {
    auto* self = static_cast<PngReader*>(png_get_io_ptr(png));
    if (self->bytes_.size() < n) png_error(png, "the file ends early");
    std::memcpy(out, self->bytes_.data(), n);
    self->bytes_.remove_prefix(n);
  }

  std::filesystem::path file_;
  std::string_view bytes_;  ///< Still to be read.
  std::size_t whole_size_;
  std::size_t packed_stride_ = 0;  ///< Bytes of a row as the file has it.
  std::string error_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
  int channels_ = 0;
  std::vector<unsigned char> pixels_;
};

}  // namespace

void read_image(const std::filesystem::path& file, const TakeRow& take) {
  const std::string bytes = read_decompressed(file);
  if (bytes.starts_with("P5") || bytes.starts_with("P2")) return PgmReader(file, bytes).read(take);
  if (bytes.starts_with("\x89PNG")) return PngReader(file, bytes).read(take);
  throw ConfigError(file, "is neither a PGM (P2, P5) nor a PNG image; convert it to one of these");
}

std::string pgm(const ByteImage& image) {
  return fmt::format("P5\n{} {}\n255\n", image.width, image.height) + image.grey;
}

std::string png(const ByteImage& image) {
  png_image description{};
  description.version = PNG_IMAGE_VERSION;
  description.width = static_cast<png_uint_32>(image.width);
  description.height = static_cast<png_uint_32>(image.height);
  description.format = PNG_FORMAT_GRAY;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(description);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&description, bytes.data(), &size, 0, image.grey.data(), 0, nullptr) == 0) {
    throw RunError(std::string("cannot write a PNG image: ") + description.message);
  }
  bytes.resize(size);
  return bytes;
}

}  // namespace glocal::ros_map
