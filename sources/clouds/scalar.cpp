#include "sources/clouds/scalar.hpp"

#include <algorithm>
#include <array>

namespace glocal::clouds {
namespace {

template <class T>
double load(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> own{};
  std::copy_n(bytes, sizeof(T), own.begin());
  if (order != std::endian::native) std::reverse(own.begin(), own.end());
  return static_cast<double>(std::bit_cast<T>(own));
}

}  // namespace

std::size_t size_of(Scalar type) {
  switch (type) {
    case Scalar::int8:
    case Scalar::uint8:
      return 1;
    case Scalar::int16:
    case Scalar::uint16:
      return 2;
    case Scalar::int32:
    case Scalar::uint32:
    case Scalar::float32:
      return 4;
    default:
      return 8;
  }
}

double number_at(const char* bytes, Scalar type, std::endian order) {
  switch (type) {
    case Scalar::int8:
      return load<std::int8_t>(bytes, order);
    case Scalar::uint8:
      return load<std::uint8_t>(bytes, order);
    case Scalar::int16:
      return load<std::int16_t>(bytes, order);
    case Scalar::uint16:
      return load<std::uint16_t>(bytes, order);
    case Scalar::int32:
      return load<std::int32_t>(bytes, order);
    case Scalar::uint32:
      return load<std::uint32_t>(bytes, order);
    case Scalar::int64:
      return load<std::int64_t>(bytes, order);
    case Scalar::uint64:
      return load<std::uint64_t>(bytes, order);
    case Scalar::float32:
      return load<float>(bytes, order);
    default:
      return load<double>(bytes, order);
  }
}

}  // namespace glocal::clouds
