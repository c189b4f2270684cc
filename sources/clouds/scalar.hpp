// Numbers as binary files hold them.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>

namespace glocal::clouds {

enum class Scalar : std::uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  int64,
  uint64,
  float32,
  float64
};

/// Bytes.
[[nodiscard]] std::size_t size_of(Scalar type);
[[nodiscard]] inline bool is_whole(Scalar type) {
  return type != Scalar::float32 && type != Scalar::float64;
}
/// The number in the `size_of(type)` bytes that begin here.
[[nodiscard]] double number_at(const char* bytes, Scalar type, std::endian order);

}  // namespace glocal::clouds
