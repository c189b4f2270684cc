// Numbers as binary files hold them.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace glocal::clouds {

/// In the order of ROS's PointField, which has all but the last two.
enum class Scalar : std::uint8_t {
  int8,
  uint8,
  int16,
  uint16,
  int32,
  uint32,
  float32,
  float64,
  int64,
  uint64
};

/// Bytes.
[[nodiscard]] std::size_t size_of(Scalar type);
[[nodiscard]] inline bool is_whole(Scalar type) {
  return type != Scalar::float32 && type != Scalar::float64;
}

/// The number in the `sizeof(T)` bytes that begin here.
template <class T>
[[nodiscard]] T number_at(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> own{};
  std::copy_n(bytes, sizeof(T), own.begin());
  if (order != std::endian::native) std::ranges::reverse(own);
  return std::bit_cast<T>(own);
}
/// The number in the `size_of(type)` bytes that begin here.
[[nodiscard]] double number_at(const char* bytes, Scalar type, std::endian order);

}  // namespace glocal::clouds
