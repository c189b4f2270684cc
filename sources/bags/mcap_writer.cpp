#include "sources/bags/mcap_writer.hpp"

#include <libdeflate.h>
#include <zstd.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "glocal/error.hpp"
#include "sources/bags/mcap_records.hpp"
#include "sources/bags/message_definitions.hpp"

namespace glocal::bags {
namespace {

constexpr std::size_t chunk_size = 1U << 20U;

/// A record's fields, little-endian, one after the other.
class RecordFields {
 public:
  template <std::unsigned_integral T>
  RecordFields& number(T value) {
    for (std::size_t i = 0; i < sizeof(T); ++i)
      bytes_ += static_cast<char>(static_cast<std::uint64_t>(value) >> (8U * i) & 0xFFU);
    return *this;
  }
  /// With its length before it: text, bytes, arrays and maps.
  RecordFields& sized(std::string_view bytes) {
    return number(static_cast<std::uint32_t>(bytes.size())).raw(bytes);
  }
  RecordFields& map(const std::map<std::uint16_t, std::uint64_t>& values) {
    RecordFields pairs;
    for (const auto& [key, value] : values) pairs.number(key).number(value);
    return sized(pairs.bytes_);
  }
  RecordFields& raw(std::string_view bytes) {
    bytes_ += bytes;
    return *this;
  }
  [[nodiscard]] const std::string& bytes() const { return bytes_; }
  [[nodiscard]] std::string record(McapOp opcode) const { return head(opcode, bytes_.size()) + bytes_; }
  /// What a record begins with; `size` is that of its fields.
  [[nodiscard]] static std::string head(McapOp opcode, std::size_t size) {
    return static_cast<char>(opcode) + RecordFields().number(std::uint64_t{size}).bytes_;
  }

 private:
  std::string bytes_;
};

std::uint32_t crc_of(std::string_view bytes, std::uint32_t before = 0) {
  return libdeflate_crc32(before, bytes.data(), bytes.size());
}

std::string compressed(const std::string& bytes) {
  std::string packed(ZSTD_compressBound(bytes.size()), '\0');
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), bytes.data(), bytes.size(), ZSTD_CLEVEL_DEFAULT);
  if (ZSTD_isError(size) != 0) throw RunError(std::string("zstd: ") + ZSTD_getErrorName(size));
  packed.resize(size);
  return packed;
}

}  // namespace

McapWriter::McapWriter(Sink sink) : sink_(std::move(sink)) {
  emit(mcap_mark);
  emit(RecordFields().sized("ros2").sized("glocal").record(McapOp::header));
}

void McapWriter::emit(std::string_view bytes) {
  crc_ = crc_of(bytes, crc_);
  written_ += bytes.size();
  sink_(bytes);
}

std::uint16_t McapWriter::add_channel(const std::string& topic, const std::string& type,
                                      const std::string& definition) {
  if (messages_.size() == std::numeric_limits<std::uint16_t>::max())
    throw ConfigError(topic, "is one topic more than the 65,535 that MCAP can have");
  const auto channel = static_cast<std::uint16_t>(messages_.size() + 1);
  // Types of the same name may differ from file to file of a recording.
  const auto [schema, is_new] =
      schema_ids_.try_emplace(type + '\n' + definition, static_cast<std::uint16_t>(schema_ids_.size() + 1));
  if (is_new) {
    const std::string record = RecordFields()
                                   .number(schema->second)
                                   .sized(ros2_type(type))
                                   .sized("ros2msg")
                                   .sized(definition)
                                   .record(McapOp::schema);
    schemas_ += record;
    chunk_ += record;
  }
  const std::string record = RecordFields()
                                 .number(channel)
                                 .number(schema->second)
                                 .sized(topic)
                                 .sized("cdr")
                                 .sized("")  // Metadata.
                                 .record(McapOp::channel);
  channels_ += record;
  chunk_ += record;
  messages_[channel] = 0;
  return channel;
}

void McapWriter::write(std::uint16_t channel, std::int64_t stamp_ns, std::string_view message) {
  const auto stamp = static_cast<std::uint64_t>(stamp_ns);
  first_ns_ = chunk_entries_.empty() ? stamp : std::min(first_ns_, stamp);
  last_ns_ = chunk_entries_.empty() ? stamp : std::max(last_ns_, stamp);
  chunk_entries_[channel].push_back({stamp, chunk_.size()});
  const auto sequence = static_cast<std::uint32_t>(messages_[channel]++);
  RecordFields fields;
  fields.number(channel).number(sequence).number(stamp).number(stamp);
  chunk_ += RecordFields::head(McapOp::message, fields.bytes().size() + message.size());
  chunk_ += fields.bytes();
  chunk_ += message;
  if (chunk_.size() >= chunk_size) end_chunk();
}

void McapWriter::write(const std::string& topic, const std::string& type, std::int64_t stamp_ns,
                       std::string_view message) {
  auto channel = topic_channels_.find(topic);
  if (channel == topic_channels_.end())
    channel = topic_channels_.emplace(topic, add_channel(topic, type, definition_of(type))).first;
  write(channel->second, stamp_ns, message);
}

void McapWriter::end_chunk() {
  if (chunk_.empty()) return;
  const std::string packed = compressed(chunk_);
  ChunkIndex index{first_ns_, last_ns_, written_, 0, {}, 0, packed.size(), chunk_.size()};
  emit(RecordFields()
           .number(first_ns_)
           .number(last_ns_)
           .number(std::uint64_t{chunk_.size()})
           .number(crc_of(chunk_))
           .sized("zstd")
           .number(std::uint64_t{packed.size()})
           .raw(packed)
           .record(McapOp::chunk));
  index.size = written_ - index.offset;
  for (const auto& [channel, entries] : chunk_entries_) {
    RecordFields pairs;
    for (const IndexEntry& entry : entries) pairs.number(entry.stamp_ns).number(entry.offset);
    index.message_indexes[channel] = written_;
    emit(RecordFields().number(channel).sized(pairs.bytes()).record(McapOp::message_index));
  }
  index.message_indexes_size = written_ - index.offset - index.size;
  chunks_.push_back(std::move(index));
  chunk_.clear();
  chunk_entries_.clear();
  first_ns_ = last_ns_ = 0;
}

std::string McapWriter::statistics() const {
  std::uint64_t messages = 0, first = std::numeric_limits<std::uint64_t>::max(), last = 0;
  for (const auto& [channel, count] : messages_) messages += count;
  for (const ChunkIndex& chunk : chunks_) {
    if (chunk.message_indexes.empty()) continue;
    first = std::min(first, chunk.first_ns);
    last = std::max(last, chunk.last_ns);
  }
  return RecordFields()
      .number(messages)
      .number(static_cast<std::uint16_t>(schema_ids_.size()))
      .number(static_cast<std::uint32_t>(messages_.size()))
      .number(std::uint32_t{0})  // Attachments.
      .number(std::uint32_t{0})  // Metadata.
      .number(static_cast<std::uint32_t>(chunks_.size()))
      .number(messages == 0 ? 0 : first)
      .number(last)
      .map(messages_)
      .record(McapOp::statistics);
}

std::string McapWriter::index_record(const ChunkIndex& chunk) {
  return RecordFields()
      .number(chunk.first_ns)
      .number(chunk.last_ns)
      .number(chunk.offset)
      .number(chunk.size)
      .map(chunk.message_indexes)
      .number(chunk.message_indexes_size)
      .sized("zstd")
      .number(chunk.packed_size)
      .number(chunk.size_unpacked)
      .record(McapOp::chunk_index);
}

void McapWriter::write_summary() {
  const std::uint64_t begin = written_;
  std::string indexes;
  for (const ChunkIndex& chunk : chunks_) indexes += index_record(chunk);
  std::string offsets;
  for (const auto& [opcode, records] :
       {std::pair(McapOp::schema, schemas_), std::pair(McapOp::channel, channels_),
        std::pair(McapOp::statistics, statistics()), std::pair(McapOp::chunk_index, indexes)}) {
    if (records.empty()) continue;
    offsets += RecordFields()
                   .number(static_cast<std::uint8_t>(opcode))
                   .number(written_)
                   .number(std::uint64_t{records.size()})
                   .record(McapOp::summary_offset);
    emit(records);
  }
  const std::uint64_t begin_of_offsets = written_;
  emit(offsets);
  // The summary's CRC is that of all up to itself, the footer's other fields included.
  RecordFields footer;
  footer.number(begin).number(begin_of_offsets);
  emit(RecordFields::head(McapOp::footer, footer.bytes().size() + sizeof(crc_)) + footer.bytes());
  emit(RecordFields().number(crc_).bytes());
}

void McapWriter::finish() {
  end_chunk();
  emit(RecordFields().number(crc_).record(McapOp::data_end));
  crc_ = 0;
  write_summary();
  emit(mcap_mark);
}

}  // namespace glocal::bags
