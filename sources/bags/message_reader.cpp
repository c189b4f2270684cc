#include "sources/bags/message_reader.hpp"

#include <fmt/format.h>

#include "glocal/words.hpp"

namespace glocal::bags {

bool is_readable(const Connection& connection) {
  return connection.encoding == "ros1" || connection.encoding == "cdr";
}

MessageReader::MessageReader(const RecordedMessage& message)
    : connection_(*message.connection),
      place_(message.place),
      bytes_(message.bytes),
      is_ros1_(message.connection->encoding == "ros1") {
  if (is_ros1_) return;
  if (connection_.encoding != "cdr")
    refuse(fmt::format("messages encoded as '{}' cannot be read; ros1 and cdr can",
                       shown(connection_.encoding)));
  constexpr std::size_t header_size = 4;
  const std::string_view header = take(header_size);
  if (header[0] != 0 || (header[1] != 0 && header[1] != 1))
    refuse(fmt::format(
        "the message's CDR is of representation {:02x}{:02x}; 0000 and 0001 (CDR_BE, CDR_LE) can be "
        "read",
        static_cast<unsigned char>(header[0]), static_cast<unsigned char>(header[1])));
  order_ = header[1] == 0 ? std::endian::big : std::endian::little;
  begin_ = header_size;
}

std::string_view MessageReader::text() {
  std::string_view text = bytes();
  // CDR counts the zero at the end.
  if (!is_ros1_ && text.ends_with('\0')) text.remove_suffix(1);
  return text;
}

std::size_t MessageReader::count(std::size_t least_size) {
  const auto n = number<std::uint32_t>();
  if (n > (bytes_.size() - at_) / least_size)
    refuse(fmt::format("{} elements are announced where {} bytes are left; get a fresh copy", n,
                       bytes_.size() - at_));
  return n;
}

void MessageReader::refuse(const std::string& message) const {
  place_.refuse(
      at_, fmt::format("{} of topic {}: {}", shown(connection_.type), shown(connection_.topic), message));
}

void MessageReader::align(std::size_t size) {
  const std::size_t beyond = (at_ - begin_) % size;
  if (beyond != 0) skip(size - beyond);
}

std::string_view MessageReader::take(std::size_t n) {
  if (n > bytes_.size() - at_)
    refuse(fmt::format(
        "{} bytes are needed where the message has {} left; it is damaged, or of another definition", n,
        bytes_.size() - at_));
  const std::string_view taken = bytes_.substr(at_, n);
  at_ += n;
  return taken;
}

}  // namespace glocal::bags
