#include "sources/clouds/lzf.hpp"

namespace glocal {
namespace {

/// A control byte below this announces one byte more than it says, to be taken as they are. All others are
/// the beginning of a reference: three bits of length and five of distance.
constexpr std::size_t first_reference = 32;
constexpr std::size_t length_follows = 7;

}  // namespace

std::optional<std::string> lzf_decompressed(std::string_view data, std::size_t size) {
  std::string out;
  std::size_t at = 0;
  const auto has = [&](std::size_t n) { return n <= data.size() - at; };
  const auto take = [&] { return static_cast<std::size_t>(static_cast<unsigned char>(data[at++])); };
  while (at < data.size()) {
    const std::size_t control = take();
    if (control < first_reference) {
      const std::size_t length = control + 1;
      if (!has(length) || length > size - out.size()) return std::nullopt;
      out.append(data.substr(at, length));
      at += length;
      continue;
    }
    std::size_t length = control >> 5U;
    if (!has(length == length_follows ? 2 : 1)) return std::nullopt;
    if (length == length_follows) length += take();
    length += 2;
    const std::size_t back = ((control & 31U) << 8U) + take() + 1;
    if (back > out.size() || length > size - out.size()) return std::nullopt;
    // One byte after the other: what is copied may be what was just written.
    for (std::size_t i = 0; i < length; ++i) out.push_back(out[out.size() - back]);
  }
  if (out.size() != size) return std::nullopt;
  return out;
}

}  // namespace glocal
