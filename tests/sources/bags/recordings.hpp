// Recordings made byte by byte.
#pragma once

#include <bzlib.h>
#include <lz4frame.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace glocal::test::bags {

/// A number, little-endian.
template <class T>
[[nodiscard]] std::string le(T value) {
  std::string bytes(sizeof(T), '\0');
  std::memcpy(bytes.data(), &value, sizeof(T));
  return bytes;
}
[[nodiscard]] inline std::string sized(std::string_view bytes) {
  return le(static_cast<std::uint32_t>(bytes.size())) + std::string(bytes);
}

[[nodiscard]] inline std::string packed(const std::string& compression, const std::string& bytes) {
  if (compression == "lz4") {
    std::string out(LZ4F_compressFrameBound(bytes.size(), nullptr), '\0');
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), nullptr));
    return out;
  }
  if (compression == "zstd") {
    std::string out(ZSTD_compressBound(bytes.size()), '\0');
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
    return out;
  }
  if (compression == "bz2") {
    std::string in = bytes, out(bytes.size() + bytes.size() / 50 + 1000, '\0');
    auto size = static_cast<unsigned>(out.size());
    BZ2_bzBuffToBuffCompress(out.data(), &size, in.data(), static_cast<unsigned>(in.size()), 1, 0, 0);
    out.resize(size);
    return out;
  }
  return bytes;
}

// MCAP.

inline const std::string mcap_magic("\x89MCAP0\r\n", 8);

[[nodiscard]] inline std::string mcap_record(char op, const std::string& content) {
  return op + le<std::uint64_t>(content.size()) + content;
}
[[nodiscard]] inline std::string mcap_channel(std::uint16_t id, const std::string& topic,
                                              const std::string& type, const std::string& encoding = "cdr") {
  return mcap_record(3, le(id) + sized(type) + sized("ros2msg") + sized("definition")) +
         mcap_record(4, le(id) + le(id) + sized(topic) + sized(encoding) + le<std::uint32_t>(0));
}
[[nodiscard]] inline std::string mcap_message(std::uint16_t channel, std::uint64_t stamp_ns,
                                              const std::string& bytes) {
  return mcap_record(5, le(channel) + le<std::uint32_t>(0) + le(stamp_ns) + le(stamp_ns) + bytes);
}
struct McapChunk {
  std::uint64_t first_ns = 0, last_ns = 0;
  std::string records;
  std::string compression;
  bool has_crc = true;
};
[[nodiscard]] inline std::string mcap_chunk(const McapChunk& c) {
  const auto crc = crc32_z(0, reinterpret_cast<const Bytef*>(c.records.data()), c.records.size());
  const std::string data = packed(c.compression, c.records);
  return mcap_record(6, le(c.first_ns) + le(c.last_ns) + le<std::uint64_t>(c.records.size()) +
                            le(c.has_crc ? static_cast<std::uint32_t>(crc) : 0U) + sized(c.compression) +
                            le<std::uint64_t>(data.size()) + data);
}
/// Behind a chunk: that it has a message of this channel. Where in it is left out.
[[nodiscard]] inline std::string mcap_message_index(std::uint16_t channel) {
  return mcap_record(7, le(channel) + le<std::uint32_t>(0));
}
/// A whole file of these records, with a summary if it is not empty.
[[nodiscard]] inline std::string mcap_file(const std::string& records, const std::string& summary = "") {
  return mcap_magic + mcap_record(1, sized("") + sized("")) + records +
         mcap_record(15, le<std::uint32_t>(0)) + summary + mcap_record(2, std::string(20, '\0')) + mcap_magic;
}

// ROS 1.

inline const std::string ros1_magic = "#ROSBAG V2.0\n";

using Fields = std::vector<std::pair<std::string, std::string>>;

[[nodiscard]] inline std::string ros1_fields(const Fields& fields) {
  std::string bytes;
  for (const auto& [name, value] : fields) bytes += sized(std::string(name).append("=").append(value));
  return bytes;
}
[[nodiscard]] inline std::string ros1_record(const Fields& header, const std::string& data) {
  return sized(ros1_fields(header)) + sized(data);
}
[[nodiscard]] inline std::string ros1_time(std::uint32_t s, std::uint32_t ns) {
  return le(s) + le(ns);
}
[[nodiscard]] inline std::string ros1_bag_header(const Fields& more = {}) {
  Fields fields = {{"op", "\x03"}, {"index_pos", le<std::uint64_t>(0)}};
  fields.insert(fields.end(), more.begin(), more.end());
  return ros1_record(fields, "");
}
[[nodiscard]] inline std::string ros1_connection(std::uint32_t id, const std::string& topic,
                                                 const std::string& type) {
  return ros1_record({{"op", "\x07"}, {"conn", le(id)}, {"topic", topic}},
                     ros1_fields({{"topic", topic}, {"type", type}, {"message_definition", "definition"}}));
}
[[nodiscard]] inline std::string ros1_message(std::uint32_t id, std::uint32_t s, const std::string& bytes) {
  return ros1_record({{"op", "\x02"}, {"conn", le(id)}, {"time", ros1_time(s, 0)}}, bytes);
}
[[nodiscard]] inline std::string ros1_chunk(const std::string& records,
                                            const std::string& compression = "none") {
  return ros1_record({{"op", "\x05"},
                      {"compression", compression},
                      {"size", le(static_cast<std::uint32_t>(records.size()))}},
                     packed(compression, records));
}

/// Behind a chunk: that it has messages of this connection, the first and the last at these times (s).
[[nodiscard]] inline std::string ros1_index(std::uint32_t connection, std::uint32_t first,
                                            std::uint32_t last) {
  const std::string offset = le<std::uint32_t>(0);
  return ros1_record({{"op", "\x04"},
                      {"ver", le<std::uint32_t>(1)},
                      {"conn", le(connection)},
                      {"count", le<std::uint32_t>(2)}},
                     ros1_time(first, 0) + offset + ros1_time(last, 0) + offset);
}

}  // namespace glocal::test::bags
