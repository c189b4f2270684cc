// Serialized messages, field by field: ROS 1's serialization (wiki.ros.org/msg) and CDR as ROS 2 writes it
// (OMG DDS-RTPS 2.2, chapter 10: CDR_BE and CDR_LE, which are version 1 of XCDR).
#pragma once

#include <bit>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "sources/bags/recording.hpp"
#include "sources/clouds/scalar.hpp"

namespace glocal::bags {

/// Whether messages of the connection can be read: those encoded as ros1 or cdr.
[[nodiscard]] bool is_readable(const Connection& connection);

/// Reads the fields of a message in order. Throws ConfigError, naming file and byte, for what reaches beyond
/// the message.
class MessageReader {
 public:
  /// Reads CDR's encapsulation header; throws ConfigError for other versions of CDR and other encodings.
  explicit MessageReader(const RecordedMessage& message);

  [[nodiscard]] bool is_ros1() const { return is_ros1_; }
  /// What the numbers are written in.
  [[nodiscard]] std::endian order() const { return order_; }

  /// A number; CDR aligns it to its size.
  template <class T>
  [[nodiscard]] T number() {
    if (!is_ros1_) align(sizeof(T));
    return clouds::number_at<T>(take(sizeof(T)).data(), order_);
  }
  [[nodiscard]] std::string_view text();
  /// How many elements follow, each of `least_size` bytes or more: no more than there is room for.
  [[nodiscard]] std::size_t count(std::size_t least_size);
  template <class T>
  [[nodiscard]] std::vector<T> numbers() {
    std::vector<T> values(count(sizeof(T)));
    for (T& value : values) value = number<T>();
    return values;
  }
  /// A sequence of bytes, as it is.
  [[nodiscard]] std::string_view bytes() { return take(count(1)); }
  void skip(std::size_t n) { static_cast<void>(take(n)); }
  [[noreturn]] void refuse(const std::string& message) const;

 private:
  /// From the end of CDR's header on.
  void align(std::size_t size);
  [[nodiscard]] std::string_view take(std::size_t n);

  const Connection& connection_;
  Place place_;
  std::string_view bytes_;
  std::size_t at_ = 0, begin_ = 0;
  bool is_ros1_;
  std::endian order_ = std::endian::little;
};

}  // namespace glocal::bags
