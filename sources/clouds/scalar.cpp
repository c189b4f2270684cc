#include "sources/clouds/scalar.hpp"

namespace glocal::clouds {

std::size_t size_of(Scalar type) {
  constexpr std::array<std::size_t, 10> sizes = {1, 1, 2, 2, 4, 4, 4, 8, 8, 8};
  return sizes.at(static_cast<std::size_t>(type));
}

double number_at(const char* bytes, Scalar type, std::endian order) {
  switch (type) {
    case Scalar::int8:
      return number_at<std::int8_t>(bytes, order);
    case Scalar::uint8:
      return number_at<std::uint8_t>(bytes, order);
    case Scalar::int16:
      return number_at<std::int16_t>(bytes, order);
    case Scalar::uint16:
      return number_at<std::uint16_t>(bytes, order);
    case Scalar::int32:
      return number_at<std::int32_t>(bytes, order);
    case Scalar::uint32:
      return number_at<std::uint32_t>(bytes, order);
    case Scalar::float32:
      return number_at<float>(bytes, order);
    case Scalar::int64:
      return static_cast<double>(number_at<std::int64_t>(bytes, order));
    case Scalar::uint64:
      return static_cast<double>(number_at<std::uint64_t>(bytes, order));
    default:
      return number_at<double>(bytes, order);
  }
}

}  // namespace glocal::clouds
