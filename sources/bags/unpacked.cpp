#include "sources/bags/unpacked.hpp"

#include <bzlib.h>
#include <fmt/format.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "glocal/words.hpp"

namespace glocal::bags {
namespace {

/// What a decompressor has done with the bytes that it was given.
struct Progress {
  std::size_t used = 0, made = 0;
  bool is_end = false;
  bool is_damaged = false;
};

class Bzip2 {
 public:
  Bzip2() { is_ready_ = BZ2_bzDecompressInit(&stream_, 0, 0) == BZ_OK; }
  ~Bzip2() { BZ2_bzDecompressEnd(&stream_); }
  Bzip2(const Bzip2&) = delete;
  Bzip2& operator=(const Bzip2&) = delete;

  Progress step(std::string_view in, char* out, std::size_t room) {
    if (!is_ready_) return {.is_damaged = true};
    // The library does not write to what it reads. NOLINTNEXTLINE(cppcoreguidelines-pro-type-const-cast)
    stream_.next_in = const_cast<char*>(in.data());
    stream_.avail_in = static_cast<unsigned>(in.size());
    stream_.next_out = out;
    stream_.avail_out = static_cast<unsigned>(room);
    const int answer = BZ2_bzDecompress(&stream_);
    return {in.size() - stream_.avail_in, room - stream_.avail_out, answer == BZ_STREAM_END,
            answer != BZ_OK && answer != BZ_STREAM_END};
  }

 private:
  bz_stream stream_{};
  bool is_ready_ = false;
};

class Lz4 {
 public:
  Progress step(std::string_view in, char* out, std::size_t room) {
    std::size_t used = in.size(), made = room;
    const std::size_t answer = LZ4F_decompress(context_.get(), out, &made, in.data(), &used, nullptr);
    return {used, made, answer == 0, LZ4F_isError(answer) != 0};
  }

 private:
  static LZ4F_dctx* make() {
    LZ4F_dctx* context = nullptr;
    if (LZ4F_isError(LZ4F_createDecompressionContext(&context, LZ4F_VERSION)) != 0) throw std::bad_alloc();
    return context;
  }
  std::unique_ptr<LZ4F_dctx, decltype(&LZ4F_freeDecompressionContext)> context_{
      make(), LZ4F_freeDecompressionContext};
};

class Zstd {
 public:
  Progress step(std::string_view in, char* out, std::size_t room) {
    ZSTD_inBuffer source{in.data(), in.size(), 0};
    ZSTD_outBuffer target{out, room, 0};
    const std::size_t answer = ZSTD_decompressStream(context_.get(), &target, &source);
    return {source.pos, target.pos, answer == 0, ZSTD_isError(answer) != 0};
  }

 private:
  std::unique_ptr<ZSTD_DCtx, decltype(&ZSTD_freeDCtx)> context_{ZSTD_createDCtx(), ZSTD_freeDCtx};
};

template <class Decompressor>
std::string unpack(std::string_view packed, std::uint64_t size, const char* format, const Place& place,
                   std::string bytes) {
  Decompressor decompressor;
  std::size_t made = 0;
  const auto damaged = [&] {
    place.refuse(0, fmt::format("the chunk's {} data is damaged or does not unpack to the {} bytes that are "
                                "announced; get a fresh copy",
                                format, size));
  };
  for (bool is_end = false; !is_end;) {
    // Room for one byte more than announced, so that more is noticed. All of it at once if that is what such
    // data may well unpack to: decompressors then write where the bytes are to stay.
    constexpr std::size_t least_room = 1U << 16U, usual_ratio = 64;
    const std::size_t room = std::max({least_room, usual_ratio * packed.size(), 2 * made});
    if (made == bytes.size()) bytes.resize(std::min<std::size_t>(size + 1, room));
    const Progress p = decompressor.step(packed, bytes.data() + made, bytes.size() - made);
    if (p.is_damaged || (p.used == 0 && p.made == 0 && !p.is_end)) damaged();
    packed.remove_prefix(p.used);
    made += p.made;
    if (made > size) damaged();
    is_end = p.is_end;
  }
  if (made != size) damaged();
  bytes.resize(made);
  return bytes;
}

}  // namespace

std::string unpacked(std::string_view compression, std::string_view packed, std::uint64_t size,
                     const Place& place, std::string spare) {
  if (size > largest_chunk)
    place.refuse(0,
                 fmt::format("a chunk of {} bytes is announced, at most {} are allowed; write the recording "
                             "anew with smaller chunks",
                             size, largest_chunk));
  if (compression == "bz2") return unpack<Bzip2>(packed, size, "bzip2", place, std::move(spare));
  if (compression == "lz4") return unpack<Lz4>(packed, size, "LZ4", place, std::move(spare));
  if (compression == "zstd") return unpack<Zstd>(packed, size, "Zstandard", place, std::move(spare));
  if (!compression.empty() && compression != "none")
    place.refuse(0, fmt::format("the chunk is compressed with '{}'; none, bz2, lz4 and zstd can be read",
                                shown(compression)));
  if (packed.size() != size)
    place.refuse(0, fmt::format("the chunk has {} bytes where {} are announced; get a fresh copy",
                                packed.size(), size));
  spare.assign(packed);
  return spare;
}

bool is_zstd(std::string_view beginning) {
  return beginning.starts_with("\x28\xB5\x2F\xFD");
}

std::string unpacked_message(std::string_view packed, const Place& place) {
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  if (size == ZSTD_CONTENTSIZE_UNKNOWN || size == ZSTD_CONTENTSIZE_ERROR)
    place.refuse(0, "the message's Zstandard data does not say how large it is; get a fresh copy");
  return unpacked("zstd", packed, size, place);
}

}  // namespace glocal::bags
