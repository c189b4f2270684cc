// MCAP recordings, version 0 of the format (mcap.dev/spec), written.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace glocal::bags {

/// Writes a recording piece by piece: zstd chunks of 1 MiB with their indexes, CRC-32 of all parts, and a
/// summary with schemas, channels, statistics and chunk indexes. Memory holds a chunk, and about 100 bytes
/// for each chunk written.
class McapWriter {
 public:
  /// Takes the bytes of the file, in order.
  using Sink = std::function<void(std::string_view)>;

  explicit McapWriter(Sink sink);

  /// A channel of messages as CDR; `type` as `sensor_msgs/LaserScan`, `definition` in ros2msg. Returns its
  /// id. Throws ConfigError where there are more than 65,535.
  std::uint16_t add_channel(const std::string& topic, const std::string& type, const std::string& definition);
  /// A message and its stamp, ns since 1970.
  void write(std::uint16_t channel, std::int64_t stamp_ns, std::string_view message);
  /// The same of a topic; the first message of each adds its channel.
  void write(const std::string& topic, const std::string& type, std::int64_t stamp_ns,
             std::string_view message);
  /// To be called once, at the end.
  void finish();

 private:
  struct ChunkIndex {
    std::uint64_t first_ns, last_ns, offset, size;
    std::map<std::uint16_t, std::uint64_t> message_indexes;  ///< Where each channel's is in the file.
    std::uint64_t message_indexes_size, packed_size, size_unpacked;
  };
  struct IndexEntry {
    std::uint64_t stamp_ns, offset;
  };

  void emit(std::string_view bytes);
  void end_chunk();
  [[nodiscard]] std::string statistics() const;
  [[nodiscard]] static std::string index_record(const ChunkIndex& chunk);
  void write_summary();

  Sink sink_;
  std::uint64_t written_ = 0;       ///< Bytes.
  std::uint32_t crc_ = 0;           ///< Of the data section, then of the summary.
  std::string schemas_, channels_;  ///< Their records.
  std::map<std::string, std::uint16_t> schema_ids_;
  std::map<std::string, std::uint16_t> topic_channels_;  ///< Of topics written by name.
  std::map<std::uint16_t, std::uint64_t> messages_;      ///< Of each channel.
  std::string chunk_;                                    ///< Records that wait for their chunk.
  std::uint64_t first_ns_ = 0, last_ns_ = 0;             ///< Of the chunk's messages.
  std::map<std::uint16_t, std::vector<IndexEntry>> chunk_entries_;
  std::vector<ChunkIndex> chunks_;
};

}  // namespace glocal::bags
