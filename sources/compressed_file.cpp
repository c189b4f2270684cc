#include "sources/compressed_file.hpp"

#include <fmt/format.h>

#include <array>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filtering_streambuf.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>
#include <utility>

#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace io = boost::iostreams;

/// Collects what is read, chunk by chunk, up to the limit: a file of a few kilobytes can decompress to more
/// than any memory holds.
class Content {
 public:
  Content(const std::filesystem::path& file, double max_size_gb) : file_(file), max_size_gb_(max_size_gb) {}

  void append(const char* bytes, std::streamsize n) {
    text_.append(bytes, static_cast<std::size_t>(n));
    constexpr double bytes_per_gb = 1e9;
    if (static_cast<double>(text_.size()) <= max_size_gb_ * bytes_per_gb) return;
    std::string().swap(text_);
    throw ConfigError(
        file_, fmt::format("has more than {} GB (decompressed, if it is compressed); if it is the right "
                           "file, thin it out, or take a part of it",
                           max_size_gb_));
  }
  [[nodiscard]] std::string take() { return std::move(text_); }

 private:
  const std::filesystem::path& file_;
  double max_size_gb_;
  std::string text_;
};

using Chunk = std::array<char, 1U << 16U>;

std::string read_raw(const std::filesystem::path& file, Content content) {
  if (std::filesystem::is_directory(file)) throw ConfigError(file, "is a folder; a file is needed");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) throw ConfigError(file, "cannot be opened: " + std::string(std::strerror(errno)));
  Chunk chunk{};
  while (in.read(chunk.data(), chunk.size()) || in.gcount() > 0) content.append(chunk.data(), in.gcount());
  if (in.bad()) throw ConfigError(file, "cannot be read: " + std::string(std::strerror(errno)));
  return content.take();
}

template <class Decompressor>
std::string decompress(const std::filesystem::path& file, const std::string& raw, Content content,
                       const Decompressor& filter, const char* format) {
  try {
    io::filtering_istreambuf in;
    in.push(filter);
    in.push(io::array_source(raw.data(), raw.size()));
    Chunk chunk{};
    for (std::streamsize n = 0; (n = in.sgetn(chunk.data(), chunk.size())) > 0;)
      content.append(chunk.data(), n);
  } catch (const std::ios_base::failure&) {
    throw ConfigError(
        file, std::string("the ") + format + " data is damaged or ends early; get a fresh copy of the file");
  }
  return content.take();
}

}  // namespace

std::string read_decompressed(const std::filesystem::path& file, double max_size_gb) {
  using namespace std::string_view_literals;
  const Content empty(file, max_size_gb);
  std::string raw = read_raw(file, empty);
  if (raw.starts_with("\x1f\x8b"sv)) return decompress(file, raw, empty, io::gzip_decompressor(), "gzip");
  if (raw.starts_with("BZh"sv)) return decompress(file, raw, empty, io::bzip2_decompressor(), "bzip2");
  if (raw.starts_with("\xfd"
                      "7zXZ\0"sv)) {
    return decompress(file, raw, empty, io::lzma_decompressor(), "xz");
  }
  return raw;
}

}  // namespace glocal
