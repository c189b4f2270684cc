#include "sources/bags/mcap_writer.hpp"

#include <gmock/gmock.h>

#include "files.hpp"
#include "sources/bags/message_definitions.hpp"
#include "sources/bags/recording.hpp"
#include "sources/bags/recordings.hpp"

namespace glocal::mcap_writer_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The records of a file or of a chunk: opcodes and what is in them.
std::vector<std::pair<int, std::string>> records_in(std::string_view bytes) {
  std::vector<std::pair<int, std::string>> records;
  while (!bytes.empty()) {
    std::uint64_t size = 0;
    std::memcpy(&size, bytes.data() + 1, sizeof(size));
    records.emplace_back(bytes[0], std::string(bytes.substr(9, size)));
    bytes.remove_prefix(9 + size);
  }
  return records;
}

template <class T>
T number_at(const std::string& bytes, std::size_t at) {
  T value{};
  std::memcpy(&value, bytes.data() + at, sizeof(T));
  return value;
}

std::uint32_t crc(std::string_view bytes) {
  return static_cast<std::uint32_t>(crc32_z(0, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

/// Two channels of one type; `n` messages of a kilobyte on each, in seconds 1, 2 …
std::string recording(int n) {
  std::string bytes;
  bags::McapWriter writer([&](std::string_view more) { bytes += more; });
  const auto a = writer.add_channel("/a", "std_msgs/Header", "string s\n");
  const auto b = writer.add_channel("/b", "std_msgs/Header", "string s\n");
  for (int i = 1; i <= n; ++i) {
    writer.write(a, i * 1'000'000'000LL, "a" + std::to_string(i) + std::string(1000, '.'));
    writer.write(b, i * 1'000'000'000LL + 5, "b" + std::to_string(i) + std::string(1000, '.'));
  }
  writer.finish();
  return bytes;
}

TEST(McapWriter, WritesTheRecordsOfTheSpecification) {
  const std::string bytes = recording(1);
  ASSERT_TRUE(bytes.starts_with(test::bags::mcap_magic));
  ASSERT_TRUE(bytes.ends_with(test::bags::mcap_magic));
  const auto records = records_in(std::string_view(bytes).substr(8, bytes.size() - 16));
  std::vector<int> opcodes;
  for (const auto& [opcode, content] : records) opcodes.push_back(opcode);
  // Header, chunk, its message indexes, end of data; schema, channels, statistics, chunk index; offsets of
  // these four groups; footer.
  EXPECT_THAT(opcodes, ElementsAre(1, 6, 7, 7, 15, 3, 4, 4, 11, 8, 14, 14, 14, 14, 2));
  EXPECT_EQ(records[0].second, test::bags::sized("ros2") + test::bags::sized("glocal"));
  EXPECT_THAT(records[5].second, HasSubstr("std_msgs/msg/Header"));
}

TEST(McapWriter, ChecksumsAndPlacesAreRight) {
  const std::string bytes = recording(2000);
  const std::string_view body = std::string_view(bytes).substr(8, bytes.size() - 16);
  const auto records = records_in(body);
  std::size_t at = 8, chunks = 0;
  std::uint64_t summary = 0;
  for (const auto& [opcode, content] : records) {
    if (opcode == 15) {
      EXPECT_EQ(number_at<std::uint32_t>(content, 0), crc(std::string_view(bytes).substr(0, at)));
      summary = at + 9 + content.size();
    }
    if (opcode == 8) {
      ++chunks;
      const auto offset = number_at<std::uint64_t>(content, 16);
      EXPECT_EQ(bytes[offset], 6) << "the index leads to a chunk";
      EXPECT_EQ(number_at<std::uint64_t>(content, 24), 9 + number_at<std::uint64_t>(bytes, offset + 1));
    }
    if (opcode == 14) {
      const auto begin = number_at<std::uint64_t>(content, 1), size = number_at<std::uint64_t>(content, 9);
      for (const auto& [kind, record] : records_in(std::string_view(bytes).substr(begin, size)))
        EXPECT_EQ(kind, content[0]);
    }
    if (opcode == 2) {
      EXPECT_EQ(number_at<std::uint64_t>(content, 0), summary);
      EXPECT_EQ(bytes[number_at<std::uint64_t>(content, 8)], 14);
      EXPECT_EQ(number_at<std::uint32_t>(content, 16),
                crc(std::string_view(bytes).substr(summary, at + 9 + 16 - summary)));
    }
    at += 9 + content.size();
  }
  EXPECT_GT(chunks, 2U) << "4 MB of messages are more than a chunk";
}

TEST(McapWriter, WhatIsWrittenIsRead) {
  const test::TemporaryFolder folder;
  bags::Recording recorded(folder.write("a.mcap", recording(2000)));
  ASSERT_EQ(recorded.connections().size(), 2U);
  EXPECT_EQ(recorded.connections()[1].topic, "/b");
  EXPECT_EQ(recorded.connections()[1].type, "std_msgs/Header");
  EXPECT_EQ(recorded.connections()[1].definition, "string s\n");
  EXPECT_EQ(recorded.connections()[1].encoding, "cdr");
  for (int i = 1; i <= 2000; ++i) {
    for (const char* name : {"a", "b"}) {
      const auto message = recorded.next();
      ASSERT_TRUE(message);
      EXPECT_EQ(message->connection->topic, std::string("/") + name);
      EXPECT_EQ(message->stamp_ns, i * 1'000'000'000LL + (name[0] == 'b' ? 5 : 0));
      EXPECT_EQ(message->bytes, name + std::to_string(i) + std::string(1000, '.'));
    }
  }
  EXPECT_FALSE(recorded.next());
  EXPECT_TRUE(recorded.warnings().empty());
}

TEST(McapWriter, ARecordingMayBeEmpty) {
  const test::TemporaryFolder folder;
  std::string bytes;
  bags::McapWriter writer([&](std::string_view more) { bytes += more; });
  writer.finish();
  bags::Recording recorded(folder.write("a.mcap", bytes));
  EXPECT_FALSE(recorded.next());
}

TEST(MessageDefinitions, HoldAllTypesInAType) {
  EXPECT_EQ(bags::definition_of("geometry_msgs/PoseStamped"),
            "std_msgs/Header header\ngeometry_msgs/Pose pose\n" + std::string(80, '=') +
                "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp\nstring frame_id\n" +
                std::string(80, '=') + "\nMSG: builtin_interfaces/Time\nint32 sec\nuint32 nanosec\n" +
                std::string(80, '=') +
                "\nMSG: geometry_msgs/Pose\ngeometry_msgs/Point position\n"
                "geometry_msgs/Quaternion orientation\n" +
                std::string(80, '=') + "\nMSG: geometry_msgs/Point\nfloat64 x\nfloat64 y\nfloat64 z\n" +
                std::string(80, '=') +
                "\nMSG: geometry_msgs/Quaternion\nfloat64 x\nfloat64 y\nfloat64 z\nfloat64 w\n");
  EXPECT_EQ(bags::definition_of("sensor_msgs/Imu"), "");
}

}  // namespace
}  // namespace glocal::mcap_writer_test
