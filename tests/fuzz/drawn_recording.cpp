#include "fuzz/drawn_recording.hpp"

#include <sqlite3.h>

#include <algorithm>
#include <vector>

#include "glocal/pose2.hpp"
#include "sources/bags/message_writer.hpp"

namespace glocal::fuzz {
namespace {

using test::bags::le;
using test::bags::Writer;

struct Message {
  std::string topic, type, bytes;
  std::int64_t stamp_ns = 0;  ///< Of receipt.
};

/// Writes messages of one encoding.
class DrawnMessages {
 public:
  DrawnMessages(Draw& draw, std::string encoding) : draw_(draw), encoding_(std::move(encoding)) {}

  void add(const std::string& topic, const std::string& type, std::int64_t stamp_ns, const Writer& message) {
    if (draw_.byte() == 0xFF) return;
    std::string bytes = message.bytes();
    if (draw_.byte() == 0xFF) bytes.resize(draw_.one_of(bytes.size() + 1));
    messages_.push_back({draw_.name(topic), type, std::move(bytes), draw_.number(stamp_ns)});
  }
  [[nodiscard]] Writer begin() const {
    return Writer(encoding_, order_is_big_ ? std::endian::big : std::endian::little);
  }
  Writer header(const std::string& frame, std::int64_t stamp_ns) {
    order_is_big_ = encoding_ == "cdr" && draw_.byte() == 0xFF;
    Writer w = begin();
    if (encoding_ == "ros1") w.number<std::uint32_t>(7);
    put_header(w, frame, stamp_ns);
    return w;
  }
  void put_header(Writer& w, const std::string& frame, std::int64_t stamp_ns) {
    constexpr std::int64_t second = 1'000'000'000;
    w.number(draw_.number(static_cast<std::uint32_t>(stamp_ns / second)));
    w.number(draw_.number(static_cast<std::uint32_t>(stamp_ns % second)));
    w.text(draw_.name(frame));
  }
  void put_pose(Writer& w, const Pose2& p) {
    for (const double v : {p.x, p.y, 0.0, 0.0, 0.0, std::sin(p.theta / 2.0), std::cos(p.theta / 2.0)})
      w.number(draw_.number(v));
  }

  void transform(const std::string& parent, const std::string& child, std::int64_t stamp_ns,
                 const Pose2& pose, const std::string& topic) {
    Writer w = begin();
    w.number(draw_.number<std::uint32_t>(1));
    if (encoding_ == "ros1") w.number<std::uint32_t>(7);
    put_header(w, parent, stamp_ns);
    w.text(draw_.name(child));
    put_pose(w, pose);
    add(topic, encoding_ == "ros1" ? "tf/tfMessage" : "tf2_msgs/msg/TFMessage", stamp_ns, w);
  }
  void odometry(std::int64_t stamp_ns, const Pose2& pose) {
    Writer w = header("odom", stamp_ns);
    w.text(draw_.name("base_link"));
    put_pose(w, pose);
    add("/odom", type_of("nav_msgs", "Odometry"), stamp_ns, w);
  }
  void reference(std::int64_t stamp_ns, const Pose2& pose) {
    Writer w = header("map", stamp_ns);
    put_pose(w, pose);
    add("/truth", type_of("geometry_msgs", "PoseStamped"), stamp_ns, w);
  }
  void scan(std::int64_t stamp_ns) {
    constexpr std::size_t beams = 24;
    Writer w = header("laser", stamp_ns);
    for (const float v : {-3.0F, 3.0F, 0.25F, 0.0F, 0.1F, 0.05F, 30.0F}) w.number(draw_.number(v));
    w.number(draw_.number(static_cast<std::uint32_t>(beams)));
    for (std::size_t i = 0; i < beams; ++i) w.number(draw_.number(1.0F + 0.1F * static_cast<float>(i % 7)));
    w.number<std::uint32_t>(0);
    add("/scan", type_of("sensor_msgs", "LaserScan"), stamp_ns, w);
  }
  void cloud(std::int64_t stamp_ns) {
    Writer w = header("laser", stamp_ns);
    constexpr std::uint32_t points = 6, step = 20;
    w.number(draw_.number<std::uint32_t>(1))
        .number(draw_.number(points))
        .number(draw_.number<std::uint32_t>(4));
    std::uint32_t offset = 0;
    for (const char* field : {"x", "y", "z", "t"}) {
      const std::uint8_t type = *field == 't' ? 8 : 7;
      w.text(draw_.name(field)).number(draw_.number(offset)).number(draw_.number(type));
      w.number(draw_.number<std::uint32_t>(1));
      offset += 4;
    }
    std::string data;
    for (std::uint32_t i = 0; i < points; ++i) {
      for (const float v : {1.0F, 2.0F, 0.5F}) data += le(draw_.number(v + static_cast<float>(i)));
      data += le(draw_.number(0.01 * i));
    }
    w.number<std::uint8_t>(draw_.number<std::uint8_t>(0)).number(draw_.number(step));
    w.number(draw_.number(step * points));
    add("/points", type_of("sensor_msgs", "PointCloud2"), stamp_ns, w.raw(data).number<std::uint8_t>(1));
  }
  void grid(std::int64_t stamp_ns) {
    constexpr std::uint32_t side = 12;
    Writer w = header("map", stamp_ns);
    w.number<std::uint32_t>(0).number<std::uint32_t>(0).number(draw_.number(0.5F));
    w.number(draw_.number(side)).number(draw_.number(side));
    put_pose(w, {-3.0, -3.0, 0.0});
    std::string cells;
    for (std::uint32_t i = 0; i < side * side; ++i) {
      const bool is_wall = i < side || i >= side * (side - 1) || i % side == 0 || i % side == side - 1;
      cells += static_cast<char>(is_wall ? 100 : 0);
    }
    cells[draw_.one_of(cells.size())] = static_cast<char>(draw_.byte());
    w.raw(cells);
    add("/map", type_of("nav_msgs", "OccupancyGrid"), stamp_ns, w);
  }

  [[nodiscard]] const std::vector<Message>& all() const { return messages_; }

 private:
  [[nodiscard]] std::string type_of(const std::string& package, const std::string& name) const {
    return package + (encoding_ == "ros1" ? "/" : "/msg/") + name;
  }

  Draw& draw_;
  std::string encoding_;
  bool order_is_big_ = false;
  std::vector<Message> messages_;
};

std::vector<Message> drawn_messages(Draw& draw, const std::string& encoding) {
  constexpr std::int64_t first = 1'600'000'000'000'000'000, apart = 100'000'000;
  DrawnMessages messages(draw, encoding);
  messages.grid(first);
  messages.transform("base_link", "laser", first, {0.1, 0.0, 0.0}, "/tf_static");
  const std::size_t scans = 1 + draw.one_of(4);
  const std::size_t kinds = draw.byte();
  for (std::size_t i = 0; i <= scans; ++i) {
    const std::int64_t stamp = first + static_cast<std::int64_t>(i) * apart;
    const Pose2 pose{0.1 * static_cast<double>(i), 0.0, 0.05 * static_cast<double>(i)};
    messages.transform("odom", "base_link", stamp, pose, "/tf");
    if ((kinds & 1U) != 0) messages.odometry(stamp, pose);
    if ((kinds & 2U) != 0) messages.reference(stamp, pose);
    if ((kinds & 4U) != 0) messages.cloud(stamp);
    if ((kinds & 8U) == 0) messages.scan(stamp);
  }
  return messages.all();
}

/// Topics and types in the order in which they first come.
std::vector<Message> channels_of(const std::vector<Message>& messages) {
  std::vector<Message> channels;
  for (const Message& m : messages) {
    const auto is_same = [&](const Message& c) { return c.topic == m.topic && c.type == m.type; };
    if (std::none_of(channels.begin(), channels.end(), is_same)) channels.push_back(m);
  }
  return channels;
}

std::uint16_t id_of(const Message& message, const std::vector<Message>& channels) {
  const auto found = std::find_if(channels.begin(), channels.end(), [&](const Message& c) {
    return c.topic == message.topic && c.type == message.type;
  });
  return static_cast<std::uint16_t>(found - channels.begin() + 1);
}

std::string as_mcap(Draw& draw, const std::vector<Message>& messages) {
  constexpr std::array compressions = {"", "zstd", "lz4"};
  const std::vector<Message> channels = channels_of(messages);
  const std::string compression = compressions.at(draw.one_of(compressions.size()));
  std::string records;
  for (const Message& channel : channels)
    records += test::bags::mcap_channel(id_of(channel, channels), channel.topic, channel.type);
  std::string in_chunk, chunks;
  std::uint64_t first = 0, last = 0;
  const auto end_chunk = [&] {
    chunks += test::bags::mcap_chunk({draw.number(first), draw.number(last), in_chunk, compression});
    in_chunk.clear();
  };
  for (const Message& message : messages) {
    const auto stamp = static_cast<std::uint64_t>(message.stamp_ns);
    if (in_chunk.empty()) first = stamp;
    last = stamp;
    in_chunk += test::bags::mcap_message(id_of(message, channels), stamp, message.bytes);
    if (draw.byte() > 0xE0) end_chunk();
  }
  end_chunk();
  return test::bags::mcap_file(records + chunks);
}

std::string as_ros1(Draw& draw, const std::vector<Message>& messages) {
  constexpr std::array compressions = {"none", "bz2", "lz4"};
  const std::vector<Message> channels = channels_of(messages);
  const std::string compression = compressions.at(draw.one_of(compressions.size()));
  std::string records, bag = test::bags::ros1_magic + test::bags::ros1_bag_header();
  for (const Message& channel : channels)
    records += test::bags::ros1_connection(id_of(channel, channels), channel.topic, channel.type);
  for (const Message& message : messages) {
    const auto seconds = static_cast<std::uint32_t>(message.stamp_ns / 1'000'000'000);
    records += test::bags::ros1_message(id_of(message, channels), draw.number(seconds), message.bytes);
    if (draw.byte() <= 0xE0) continue;
    bag += test::bags::ros1_chunk(records, compression);
    records.clear();
  }
  return bag + test::bags::ros1_chunk(records, compression);
}

std::string as_sqlite(const std::vector<Message>& messages) {
  const std::vector<Message> channels = channels_of(messages);
  sqlite3* database = nullptr;
  sqlite3_open(":memory:", &database);
  sqlite3_exec(
      database,
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT, type TEXT, serialization_format TEXT);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER, timestamp INTEGER, data BLOB);",
      nullptr, nullptr, nullptr);
  const auto run = [&](const char* query, std::int64_t number, std::int64_t stamp_ns,
                       const std::vector<std::string>& texts) {
    sqlite3_stmt* statement = nullptr;
    sqlite3_prepare_v2(database, query, -1, &statement, nullptr);
    sqlite3_bind_int64(statement, 1, number);
    sqlite3_bind_int64(statement, 2, stamp_ns);
    int place = 3;
    for (const std::string& text : texts)
      sqlite3_bind_blob(statement, place++, text.data(), static_cast<int>(text.size()), SQLITE_STATIC);
    sqlite3_step(statement);
    sqlite3_finalize(statement);
  };
  for (const Message& channel : channels)
    run("INSERT INTO topics VALUES(?1, ?3, ?4, 'cdr')", id_of(channel, channels), 0,
        {channel.topic, channel.type});
  for (const Message& message : messages)
    run("INSERT INTO messages(topic_id, timestamp, data) VALUES(?1, ?2, ?3)", id_of(message, channels),
        message.stamp_ns, {message.bytes});
  sqlite3_int64 size = 0;
  unsigned char* bytes = sqlite3_serialize(database, "main", &size, 0);
  std::string file(reinterpret_cast<const char*>(bytes), static_cast<std::size_t>(size));
  sqlite3_free(bytes);
  sqlite3_close(database);
  return file;
}

}  // namespace

std::string drawn_recording(Draw& draw) {
  const std::size_t format = draw.one_of(8);
  const std::vector<Message> messages = drawn_messages(draw, format >= 4 && format < 7 ? "ros1" : "cdr");
  if (format < 4) return as_mcap(draw, messages);
  return format < 7 ? as_ros1(draw, messages) : as_sqlite(messages);
}

}  // namespace glocal::fuzz
