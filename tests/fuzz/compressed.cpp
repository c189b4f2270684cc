// Files that gzip, bzip2 or xz has compressed.
#include "fuzz/harness.hpp"
#include "sources/compressed_file.hpp"

extern "C" int fuzz_compressed(const std::uint8_t* data, std::size_t size) {
  using namespace glocal;
  const auto file = fuzz::write("drive.log", fuzz::text_of(data, size));
  return fuzz::answer([&] { static_cast<void>(read_decompressed(file)); });
}
