#include <fmt/format.h>
#include <libdeflate.h>

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "glocal/limits.hpp"
#include "sources/bags/chunked_file.hpp"
#include "sources/bags/mcap_records.hpp"
#include "sources/bags/recording_file.hpp"
#include "sources/bags/unpacked.hpp"

namespace glocal::bags {
namespace {

constexpr std::uint64_t record_head = 9;  ///< Opcode and length.

struct McapRecord {
  McapOp op = McapOp::footer;
  std::uint64_t size = 0;  ///< Of what follows its head.
};

std::int64_t stamp(FieldReader& fields) {
  const auto ns = static_cast<std::int64_t>(fields.number<std::uint64_t>());
  // Those that are more than 63 bits are negative, and too early.
  const std::string fault = fault_of_stamp_ns(ns);
  if (!fault.empty()) fields.refuse(fault);
  return ns;
}

class McapFile final : public ChunkedFile {
 public:
  McapFile(const std::filesystem::path& file, const Reading& reading) : ChunkedFile(file, reading) {
    scan();
    // Only a summary names the channels of chunks outside of them.
    if (!has_whole_summary_) find_channels();
    is_open_ = true;
  }

  [[nodiscard]] const char* format() const override { return "MCAP"; }

 private:
  /// Goes through all records and skips what chunks hold. Messages outside of chunks are taken together as
  /// uncompressed ones.
  void scan() {
    bool has_end = false, has_channels = false;
    const std::uint64_t end =
        go_through_records(mcap_mark.size(), [&](std::uint64_t at) -> std::optional<std::uint64_t> {
          const McapRecord record = record_at(at);
          is_in_summary_ |= record.op == McapOp::data_end;
          has_end = record.op == McapOp::footer;
          has_channels |= is_in_summary_ && record.op == McapOp::channel;
          note_record(at, record);
          if (has_end) return std::nullopt;
          return at + record_head + record.size;
        });
    has_whole_summary_ = has_end && has_channels && !lacks_schemas_;
    is_in_summary_ = false;
    if (end == mcap_mark.size()) file_.refuse(end, "the recording has no record; get a fresh copy");
    if (!has_end && end == file_.size())
      reading_.note(fmt::format("{}: byte {}: the recording ends without a footer; it may lack messages",
                                file_.name(), end));
  }

  /// A channel is named in the chunk that has its first message. Chunks all of whose channels are known,
  /// as the indexes behind them tell, need not be unpacked for that.
  void find_channels() {
    for (const ChunkSpan& span : chunks_) {
      const auto indexed = indexed_.find(span.offset);
      const bool is_known =
          indexed != indexed_.end() &&
          std::ranges::all_of(indexed->second, [&](std::uint16_t id) { return channels_.contains(id); });
      if (!is_known) static_cast<void>(load_if_whole(span));
    }
    indexed_.clear();
  }

  [[nodiscard]] McapRecord record_at(std::uint64_t at) const {
    const std::string_view head = file_.peek(at);
    McapRecord record;
    if (head.size() >= record_head) {
      FieldReader reader(head, {file_.name(), at});
      record.op = static_cast<McapOp>(reader.number<std::uint8_t>());
      record.size = reader.number<std::uint64_t>();
    }
    if (head.size() < record_head || record.size > file_.size() - at - record_head)
      file_.refuse(at, "the file ends within a record; get a fresh copy");
    return record;
  }

  void note_record(std::uint64_t at, const McapRecord& record) {
    const std::uint64_t begin = at + record_head;
    const auto reader = [&](std::string_view bytes) {
      return FieldReader(
          bytes.substr(0, static_cast<std::size_t>(std::min<std::uint64_t>(bytes.size(), record.size))),
          {file_.name(), begin});
    };
    if (record.op != McapOp::message) loose_messages_end_ = 0;
    if (record.op == McapOp::schema || record.op == McapOp::channel) {
      const std::string bytes = file_.read(begin, record.size);
      FieldReader fields = reader(bytes);
      note_channel_or_schema(record.op, fields);
    } else if (record.op == McapOp::chunk) {
      FieldReader fields = reader(file_.peek(begin));
      const std::int64_t first = stamp(fields);
      static_cast<void>(stamp(fields));  // The last one must be a stamp, too.
      chunks_.push_back({at, record_head + record.size, first});
    } else if (record.op == McapOp::message_index && !chunks_.empty()) {
      indexed_[chunks_.back().offset].insert(reader(file_.peek(begin)).number<std::uint16_t>());
    } else if (record.op == McapOp::message) {
      FieldReader fields = reader(file_.peek(begin));
      static_cast<void>(fields.number<std::uint16_t>());
      static_cast<void>(fields.number<std::uint32_t>());
      add_loose_message(at, record_head + record.size, stamp(fields));
    }
  }

  /// Messages that follow each other make a chunk.
  void add_loose_message(std::uint64_t at, std::uint64_t size, std::int64_t stamp_ns) {
    constexpr std::uint64_t enough = 1U << 20U;
    if (size > largest_chunk)
      file_.refuse(
          at, fmt::format("a message of {} bytes is announced, at most {} are allowed", size, largest_chunk));
    if (at != loose_messages_end_ || chunks_.back().size > enough) {
      chunks_.push_back({at, size, stamp_ns});
    } else {
      ChunkSpan& span = chunks_.back();
      span.size += size;
      span.first_ns = std::min(span.first_ns, stamp_ns);
    }
    loose_messages_end_ = at + size;
  }

  void note_channel_or_schema(McapOp op, FieldReader& fields) {
    const auto id = fields.number<std::uint16_t>();
    if (op == McapOp::schema) {
      const std::string_view name = fields.text();
      static_cast<void>(fields.text());  // The definition's language.
      schemas_.try_emplace(id, normal_type(name), std::string(fields.text()));
      return;
    }
    const auto schema = fields.number<std::uint16_t>();
    const std::string_view topic = fields.text(), encoding = fields.text();
    if (channels_.contains(id)) return;
    // A channel without a schema has 0.
    const auto found = schemas_.find(schema);
    if (schema != 0 && found == schemas_.end()) {
      // A summary need not repeat schemas; then chunks tell the channel.
      lacks_schemas_ |= is_in_summary_;
      if (is_in_summary_) return;
      fields.refuse(fmt::format(
          "channel {} has the schema {}, which no record before it is; get a fresh copy", id, schema));
    }
    const auto& [type, definition] = found == schemas_.end() ? no_schema_ : found->second;
    channels_.emplace(id, connections_.size());
    connections_.push_back({std::string(topic), type, std::string(encoding), definition});
  }

  [[nodiscard]] Chunk load(const ChunkSpan& span) override {
    const bool is_chunk = static_cast<McapOp>(file_.peek(span.offset).front()) == McapOp::chunk;
    Chunk chunk;
    chunk.bytes = is_chunk ? unpacked_chunk(span) : file_.read(span.offset, span.size);
    FieldReader records(chunk.bytes, is_chunk ? place_in(span, 0) : Place{file_.name(), span.offset});
    while (!records.at_end()) {
      const auto op = static_cast<McapOp>(records.number<std::uint8_t>());
      const std::string_view record = records.take(records.number<std::uint64_t>());
      const std::size_t offset = records.at() - record.size();
      FieldReader fields(record, place_in(span, offset));
      if ((op == McapOp::schema || op == McapOp::channel) && !is_open_) note_channel_or_schema(op, fields);
      if (op == McapOp::message) chunk.entries.push_back(entry_of(fields, offset));
    }
    return chunk;
  }

  [[nodiscard]] std::string unpacked_chunk(const ChunkSpan& span) {
    const Place in_file{file_.name(), span.offset};
    const std::string record = file_.read(span.offset + record_head, span.size - record_head);
    FieldReader fields(record, {file_.name(), span.offset + record_head});
    static_cast<void>(fields.take(2 * sizeof(std::uint64_t)));  // First and last stamp.
    const auto size = fields.number<std::uint64_t>();
    const auto crc = fields.number<std::uint32_t>();
    const std::string_view compression = fields.text();
    const std::string_view packed = fields.take(fields.number<std::uint64_t>());
    std::string bytes = unpacked(compression, packed, size, in_file, std::move(spare_));
    const auto found = libdeflate_crc32(0, bytes.data(), bytes.size());
    if (crc != 0 && crc != found)
      in_file.refuse(
          0, fmt::format("the chunk's CRC-32 is {:08x} where {:08x} is announced: it is damaged; get a "
                         "fresh copy",
                         found, crc));
    return bytes;
  }

  /// `offset`: of the record in the chunk.
  [[nodiscard]] ChunkEntry entry_of(FieldReader& fields, std::size_t offset) const {
    const auto id = fields.number<std::uint16_t>();
    static_cast<void>(fields.number<std::uint32_t>());  // Sequence.
    const std::int64_t received = stamp(fields);
    static_cast<void>(fields.number<std::uint64_t>());  // Time of publishing.
    const auto channel = channels_.find(id);
    if (channel == channels_.end())
      fields.refuse(
          fmt::format("the message is of channel {}, which the recording does not name; repair it with "
                      "'mcap recover'",
                      id));
    return {received, channel->second, offset + fields.at(), fields.rest().size()};
  }

  std::map<std::uint16_t, std::pair<std::string, std::string>> schemas_;  ///< Type and definition.
  std::pair<std::string, std::string> no_schema_;
  std::map<std::uint16_t, std::size_t> channels_;
  std::map<std::uint64_t, std::set<std::uint16_t>> indexed_;  ///< Channels of chunks, by offset.
  std::uint64_t loose_messages_end_ = 0;                      ///< 0: the record before was none.
  bool is_in_summary_ = false, lacks_schemas_ = false, has_whole_summary_ = false;
  bool is_open_ = false;  ///< From then on there are no new channels.
};

}  // namespace

bool is_mcap(std::string_view beginning) {
  return beginning.starts_with(mcap_mark);
}

std::unique_ptr<RecordingFile> open_mcap(const std::filesystem::path& file, const Reading& reading) {
  return std::make_unique<McapFile>(file, reading);
}

}  // namespace glocal::bags
