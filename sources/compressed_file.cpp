#include "sources/compressed_file.hpp"

#include <array>
#include <boost/iostreams/copy.hpp>
#include <boost/iostreams/device/array.hpp>
#include <boost/iostreams/device/back_inserter.hpp>
#include <boost/iostreams/filter/bzip2.hpp>
#include <boost/iostreams/filter/gzip.hpp>
#include <boost/iostreams/filter/lzma.hpp>
#include <boost/iostreams/filtering_stream.hpp>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <string_view>

#include "glocal/error.hpp"

namespace glocal {
namespace {

namespace io = boost::iostreams;

[[noreturn]] void refuse_file(const std::filesystem::path& file, std::string message) {
  throw ConfigError({{file.string(), 0, 0, std::move(message)}});
}

std::string read_raw(const std::filesystem::path& file) {
  if (std::filesystem::is_directory(file)) refuse_file(file, "is a folder; a file is needed");
  errno = 0;
  std::ifstream in(file, std::ios::binary);
  if (!in) refuse_file(file, "cannot be opened: " + std::string(std::strerror(errno)));
  std::string content;
  std::array<char, 1U << 16U> chunk{};
  while (in.read(chunk.data(), chunk.size()) || in.gcount() > 0) {
    content.append(chunk.data(), static_cast<std::size_t>(in.gcount()));
  }
  if (in.bad()) refuse_file(file, "cannot be read: " + std::string(std::strerror(errno)));
  return content;
}

template <class Decompressor>
std::string decompress(const std::filesystem::path& file, const std::string& raw, const Decompressor& filter,
                       const char* format) {
  std::string content;
  try {
    io::filtering_istream in;
    in.push(filter);
    in.push(io::array_source(raw.data(), raw.size()));
    io::copy(in, io::back_inserter(content));
  } catch (const std::ios_base::failure&) {
    refuse_file(
        file, std::string("the ") + format + " data is damaged or ends early; get a fresh copy of the file");
  }
  return content;
}

}  // namespace

std::string read_decompressed(const std::filesystem::path& file) {
  using namespace std::string_view_literals;
  std::string raw = read_raw(file);
  if (raw.starts_with("\x1f\x8b"sv)) return decompress(file, raw, io::gzip_decompressor(), "gzip");
  if (raw.starts_with("BZh"sv)) return decompress(file, raw, io::bzip2_decompressor(), "bzip2");
  if (raw.starts_with("\xfd"
                      "7zXZ\0"sv)) {
    return decompress(file, raw, io::lzma_decompressor(), "xz");
  }
  return raw;
}

}  // namespace glocal
