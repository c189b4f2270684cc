#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "glocal/words.hpp"
#include "sources/bags/chunked_file.hpp"
#include "sources/bags/recording_file.hpp"
#include "sources/bags/unpacked.hpp"

namespace glocal::bags {
namespace {

constexpr std::string_view version_2 = "#ROSBAG V2.0\n";

enum class Ros1Op : std::uint8_t {
  message = 2,
  bag = 3,
  index = 4,
  chunk = 5,
  chunk_info = 6,
  connection = 7
};

/// `name=value` fields of a record's header.
class HeaderFields {
 public:
  HeaderFields(std::string_view bytes, const Place& place) : place_(place) {
    FieldReader reader(bytes, place);
    while (!reader.at_end()) {
      const std::string_view field = reader.text();
      const std::size_t equals = field.find('=');
      if (equals == std::string_view::npos) reader.refuse("a header's field has no '='; get a fresh copy");
      fields_[field.substr(0, equals)] = field.substr(equals + 1);
    }
  }

  [[nodiscard]] std::string_view text(std::string_view name) const {
    const auto field = fields_.find(name);
    return field == fields_.end() ? std::string_view() : field->second;
  }
  template <class T>
  [[nodiscard]] T number(std::string_view name) const {
    if (text(name).size() != sizeof(T))
      place_.refuse(0, fmt::format("the record's header has no field '{}' of {} bytes; get a fresh copy",
                                   name, sizeof(T)));
    return FieldReader(text(name), place_).number<T>();
  }
  /// ns
  [[nodiscard]] std::int64_t time(std::string_view name) const {
    const auto value = number<std::uint64_t>(name);
    constexpr std::uint64_t low = 0xFFFFFFFFU;
    return static_cast<std::int64_t>(value & low) * 1'000'000'000 + static_cast<std::int64_t>(value >> 32U);
  }
  [[nodiscard]] Ros1Op op() const { return static_cast<Ros1Op>(number<std::uint8_t>("op")); }

 private:
  Place place_;
  std::map<std::string_view, std::string_view> fields_;
};

class Ros1Bag final : public ChunkedFile {
 public:
  Ros1Bag(const std::filesystem::path& file, const Reading& reading) : ChunkedFile(file, reading) {
    check_version();
    scan();
    for (ChunkSpan& span : chunks_) find_time_and_connections(span);
    indexed_.clear();
    is_open_ = true;
  }

  [[nodiscard]] const char* format() const override { return "ROS 1 bag 2.0"; }

 private:
  /// A record of the file: its header, and where its data is.
  struct Record {
    std::string header;
    std::uint64_t data = 0, data_size = 0;
  };

  void check_version() const {
    const std::string_view beginning = file_.peek(0);
    if (!beginning.starts_with(version_2))
      file_.refuse(0, fmt::format("is a bag of ROS 1 that begins with '{}'; only version 2.0 can be read: "
                                  "convert it with ROS (rosbag fix)",
                                  shown(beginning.substr(0, beginning.find('\n')))));
  }

  /// Goes through all records and skips what chunks hold. An index is not needed for it.
  void scan() {
    const std::uint64_t end = go_through_records(version_2.size(), [&](std::uint64_t at) {
      const Record record = record_at(at);
      note_record(at, record);
      return std::optional(record.data + record.data_size);
    });
    if (end == version_2.size()) file_.refuse(end, "the bag has no record; get a fresh copy");
  }

  [[nodiscard]] Record record_at(std::uint64_t at) const {
    constexpr std::uint64_t largest_header = 1U << 20U, length_size = 4;
    const auto ends_early = [&] { file_.refuse(at, "the file ends within a record; get a fresh copy"); };
    const auto length_at = [&](std::uint64_t offset) {
      const std::string_view bytes = file_.peek(offset);
      if (bytes.size() < length_size) ends_early();
      return FieldReader(bytes, {file_.name(), offset}).number<std::uint32_t>();
    };
    const std::uint32_t header_size = length_at(at);
    if (header_size > largest_header)
      file_.refuse(at,
                   fmt::format("a record's header of {} bytes is announced, at most {} are allowed; get a "
                               "fresh copy",
                               header_size, largest_header));
    const std::uint64_t data_length = at + length_size + header_size;
    const std::uint32_t data_size = length_at(data_length);
    if (data_size > file_.size() - data_length - length_size) ends_early();
    return {file_.read(at + length_size, header_size), data_length + length_size, data_size};
  }

  void note_record(std::uint64_t at, const Record& record) {
    const HeaderFields header(record.header, {file_.name(), at});
    switch (header.op()) {
      case Ros1Op::bag:
        if (!header.text("encryptor").empty())
          file_.refuse(at, fmt::format("the bag is encrypted ({}); decrypt it with ROS (rosbag decrypt)",
                                       shown(header.text("encryptor"))));
        break;
      case Ros1Op::chunk:
        chunks_.push_back({at, record.data + record.data_size - at, 0});
        break;
      case Ros1Op::chunk_info:
        note_chunk_info(header);
        break;
      case Ros1Op::index:
        if (!chunks_.empty()) note_index(header, record);
        break;
      case Ros1Op::connection:
        note_connection(header, file_.read(record.data, record.data_size), {file_.name(), record.data});
        break;
      default:
        break;
    }
  }

  void note_chunk_info(const HeaderFields& header) {
    const std::int64_t first = header.time("start_time");
    static_cast<void>(header.time("end_time"));  // It must be there, too.
    first_times_[header.number<std::uint64_t>("chunk_pos")] = first;
  }

  void note_connection(const HeaderFields& header, std::string_view data, const Place& place) {
    const auto id = header.number<std::uint32_t>("conn");
    if (ids_.contains(id)) return;
    const HeaderFields fields(data, place);
    ids_.emplace(id, connections_.size());
    connections_.push_back({std::string(header.text("topic")), normal_type(fields.text("type")), "ros1",
                            std::string(fields.text("message_definition"))});
  }

  /// Behind each chunk the stamps of a connection's messages in it, in rising order: (s, ns, offset) each.
  void note_index(const HeaderFields& header, const Record& record) {
    constexpr std::uint64_t entry_size = 12;
    const auto count = header.number<std::uint32_t>("count");
    if (count == 0 || record.data_size != entry_size * count) return;
    FieldReader fields(file_.peek(record.data), {file_.name(), record.data});
    const auto s = fields.number<std::uint32_t>();
    const std::int64_t first = static_cast<std::int64_t>(s) * 1'000'000'000 + fields.number<std::uint32_t>();
    Indexed& indexed = indexed_.try_emplace(chunks_.back().offset, Indexed{first, {}}).first->second;
    indexed.first_ns = std::min(indexed.first_ns, first);
    indexed.connections.insert(header.number<std::uint32_t>("conn"));
  }

  /// Only chunks of which no index says enough are unpacked for it.
  void find_time_and_connections(ChunkSpan& span) {
    const auto first_time = first_times_.find(span.offset);
    const auto indexed = indexed_.find(span.offset);
    if (first_time != first_times_.end()) {
      span.first_ns = first_time->second;
    } else if (indexed != indexed_.end() && knows_all(indexed->second.connections)) {
      span.first_ns = indexed->second.first_ns;
    } else {
      take_time_from_messages(span);
    }
  }

  [[nodiscard]] bool knows_all(const std::set<std::uint32_t>& connections) const {
    return std::ranges::all_of(connections, [&](std::uint32_t id) { return ids_.contains(id); });
  }

  /// For chunks that no index knows.
  void take_time_from_messages(ChunkSpan& span) {
    const auto chunk = load_if_whole(span);
    if (!chunk) return;
    for (const ChunkEntry& entry : chunk->entries) {
      const bool is_first = &entry == &chunk->entries.front();
      span.first_ns = is_first ? entry.stamp_ns : std::min(span.first_ns, entry.stamp_ns);
    }
  }

  [[nodiscard]] Chunk load(const ChunkSpan& span) override {
    const Record record = record_at(span.offset);
    const Place in_file{file_.name(), span.offset};
    const HeaderFields header(record.header, in_file);
    Chunk chunk{unpacked(header.text("compression"), file_.read(record.data, record.data_size),
                         header.number<std::uint32_t>("size"), in_file, std::move(spare_)),
                {}};
    FieldReader records(chunk.bytes, place_in(span, 0));
    while (!records.at_end()) {
      const Place place = place_in(span, records.at());
      const HeaderFields fields(records.text(), place);
      const std::string_view data = records.text();
      const std::size_t offset = records.at() - data.size();
      if (fields.op() == Ros1Op::connection && !is_open_)
        note_connection(fields, data, place_in(span, offset));
      if (fields.op() == Ros1Op::message)
        chunk.entries.push_back({fields.time("time"),
                                 connection_of(fields.number<std::uint32_t>("conn"), place), offset,
                                 data.size()});
    }
    return chunk;
  }

  [[nodiscard]] std::size_t connection_of(std::uint32_t id, const Place& place) const {
    const auto found = ids_.find(id);
    if (found == ids_.end())
      place.refuse(0,
                   fmt::format("the message is of connection {}, which the bag does not name; repair it with "
                               "ROS (rosbag reindex)",
                               id));
    return found->second;
  }

  std::map<std::uint64_t, std::int64_t> first_times_;  ///< Of chunks, by offset.
  /// What the indexes behind a chunk say of it.
  struct Indexed {
    std::int64_t first_ns = 0;
    std::set<std::uint32_t> connections = {};
  };
  std::map<std::uint64_t, Indexed> indexed_;  ///< By offset of the chunk.
  std::map<std::uint32_t, std::size_t> ids_;
  bool is_open_ = false;  ///< From then on there are no new connections.
};

}  // namespace

bool is_ros1_bag(std::string_view beginning) {
  // Version 1.1 and 1.2 begin with #ROSRECORD or #ROSLOG.
  return beginning.starts_with("#ROS");
}

std::unique_ptr<RecordingFile> open_ros1_bag(const std::filesystem::path& file, const Reading& reading) {
  return std::make_unique<Ros1Bag>(file, reading);
}

}  // namespace glocal::bags
