#include "sources/bags/bag_folder.hpp"

#include <gmock/gmock.h>

#include <cstdlib>

#include "files.hpp"
#include "sources/bags/recording.hpp"

namespace glocal::test::bags::bag_folder_test {
namespace {

namespace fs = std::filesystem;
using glocal::bags::BagFolder;
using glocal::bags::is_bag_folder;
using glocal::bags::read_bag_folder;
using glocal::bags::Recording;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// As rosbag2 of ROS 2 Humble writes it.
std::string metadata(const std::string& files, const std::string& compression = "\"\"") {
  return "rosbag2_bagfile_information:\n"
         "  version: 5\n"
         "  storage_identifier: sqlite3\n"
         "  duration:\n"
         "    nanoseconds: 999\n"
         "  starting_time:\n"
         "    nanoseconds_since_epoch: 1655000000000000001\n"
         "  message_count: 3\n"
         "  topics_with_message_count:\n"
         "    - topic_metadata:\n"
         "        name: /a\n"
         "        type: std_msgs/msg/String\n"
         "        serialization_format: cdr\n"
         "        offered_qos_profiles: \"- history: 3\\n  depth: 0\\n  reliability: 1\"\n"
         "      message_count: 2\n"
         "    - topic_metadata:\n"
         "        name: /b\n"
         "        type: std_msgs/msg/String\n"
         "        serialization_format: cdr\n"
         "        offered_qos_profiles: \"\"\n"
         "      message_count: 1\n"
         "  compression_format: " +
         compression + "\n  compression_mode: " + (compression == "\"\"" ? "\"\"" : "MESSAGE") +
         "\n  relative_file_paths:\n" + files + "  files: []\n";
}

class BagFolders : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> files() const {
    std::vector<std::string> names;
    for (const fs::path& file : read_bag_folder(folder_.path()).files) names.push_back(file.filename());
    return names;
  }
  [[nodiscard]] std::string fault() const {
    return config_error(folder_.path(), [&] { static_cast<void>(read_bag_folder(folder_.path())); });
  }
  /// Runs a program of Python's in the folder; false if that, or the program zstd, is not there.
  [[nodiscard]] bool python(const std::string& program) const {
    folder_.write("program.py", program);
    return std::system(("cd " + folder_.path().string() +
                        " && command -v zstd >program.out && python3 program.py >program.out 2>&1")
                           .c_str()) == 0;
  }

  TemporaryFolder folder_;
};

TEST_F(BagFolders, WithoutMetadataHaveTheirFilesInOrderOfNames) {
  EXPECT_FALSE(is_bag_folder(folder_.path()));
  EXPECT_THAT(fault(), HasSubstr("is a folder without .db3 or .mcap files"));
  for (const char* name : {"b.mcap", "a.db3", "notes.txt"}) folder_.write(name, "");
  EXPECT_TRUE(is_bag_folder(folder_.path()));
  EXPECT_THAT(files(), ElementsAre("a.db3", "b.mcap"));
}

TEST_F(BagFolders, HaveTheFilesThatMetadataNames) {
  folder_.write("metadata.yaml", metadata("    - run_1.db3\n    - run/run_0.db3\n"));
  for (const char* name : {"run_0.db3", "run_1.db3", "run_2.db3"}) folder_.write(name, "");
  EXPECT_THAT(files(), ElementsAre("run_1.db3", "run_0.db3"));
  const BagFolder folder = read_bag_folder(folder_.path());
  EXPECT_THAT(folder.messages, ElementsAre(std::pair("/a", 2U), std::pair("/b", 1U)));
  EXPECT_THAT(folder.warnings,
              ElementsAre(HasSubstr("run_2.db3: is left out, as metadata.yaml does not name it")));
}

TEST_F(BagFolders, SayWhatIsMissing) {
  folder_.write("metadata.yaml", metadata("    - run_0.db3\n    - run_1.db3\n"));
  EXPECT_TRUE(is_bag_folder(folder_.path()));
  EXPECT_THAT(fault(), HasSubstr("names run_0.db3, which is not there; put it into the folder, or make"));
  EXPECT_THAT(fault(), HasSubstr("names run_1.db3, which is not there"));
  folder_.write("metadata.yaml", metadata("    - [\n"));
  EXPECT_THAT(fault(), HasSubstr("make the file anew with ROS (ros2 bag reindex), or delete it"));
  folder_.write("metadata.yaml", metadata("    - run_0.db3\n", "secret"));
  EXPECT_THAT(fault(), HasSubstr("is compressed with 'secret'; only zstd can be read"));
}

TEST_F(BagFolders, CompressedAsAWholeAreToBeUnpacked) {
  folder_.write("metadata.yaml", metadata("    - run_0.db3.zstd\n", "zstd"));
  const fs::path packed = folder_.write("run_0.db3.zstd", "\x28\xB5\x2F\xFD");
  EXPECT_THAT(fault(), HasSubstr("run_0.db3.zstd: error: is compressed as a whole; unpack it: zstd -d "));
  EXPECT_THAT(config_error(folder_.path(), [&] { Recording recording(packed); }),
              HasSubstr("is compressed as a whole; unpack it: zstd -d "));
  folder_.write("run_0.db3", "");
  EXPECT_THAT(files(), ElementsAre("run_0.db3"));
  EXPECT_THAT(read_bag_folder(folder_.path()).warnings, IsEmpty());
  fs::remove(folder_ / "metadata.yaml");
  EXPECT_THAT(files(), ElementsAre("run_0.db3")) << "once, packed and unpacked";
}

/// Messages of two files, compressed one by one with zstd's own program.
constexpr const char* write_compressed_messages =
    "import sqlite3, subprocess\n"
    "def packed(data):\n"
    "    open('message', 'wb').write(data)\n"
    "    subprocess.run(['zstd', '-q', '-f', 'message'], check=True)\n"
    "    return open('message.zst', 'rb').read()\n"
    "for n, messages in ((0, [(1, 11, b'\\0\\1\\0\\0one'), (2, 12, b'\\0\\1\\0\\0two')]),\n"
    "                    (1, [(1, 13, b'\\0\\1\\0\\0' + 5000 * b'x')])):\n"
    "    db = sqlite3.connect(f'run_{n}.db3')\n"
    "    db.execute('CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, '\n"
    "               'serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL)')\n"
    "    db.execute('CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, '\n"
    "               'timestamp INTEGER NOT NULL, data BLOB NOT NULL)')\n"
    "    for i, name in ((1, '/a'), (2, '/b')):\n"
    "        db.execute('INSERT INTO topics VALUES(?, ?, ?, ?, ?)', (i, name, 'std_msgs/msg/String', 'cdr', "
    "''))\n"
    "    for topic, stamp, data in messages:\n"
    "        db.execute('INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)',\n"
    "                   (topic, stamp, packed(data)))\n"
    "    db.commit()\n";

TEST_F(BagFolders, MessagesCompressedOneByOneAreRead) {
  if (!python(write_compressed_messages)) GTEST_SKIP() << "no python3 with sqlite3, or no zstd";
  folder_.write("metadata.yaml", metadata("    - run_0.db3\n    - run_1.db3\n", "zstd"));
  Recording recording(folder_.path());
  std::vector<std::string> messages;
  while (const auto m = recording.next())
    messages.push_back(m->connection->topic + " " + std::string(m->bytes.substr(4)));
  EXPECT_THAT(messages, ElementsAre("/a one", "/b two", "/a " + std::string(5000, 'x')));
  EXPECT_THAT(recording.warnings(), IsEmpty()) << "as many as announced";
  recording.rewind({{"/b"}});
  while (recording.next()) {
  }
  EXPECT_THAT(recording.warnings(), IsEmpty());
}

TEST_F(BagFolders, MessagesThatLackAreTold) {
  if (!python(write_compressed_messages)) GTEST_SKIP() << "no python3 with sqlite3, or no zstd";
  folder_.write("metadata.yaml", metadata("    - run_0.db3\n", "zstd"));
  fs::remove(folder_ / "run_1.db3");
  Recording recording(folder_.path());
  while (recording.next()) {
  }
  EXPECT_THAT(recording.warnings(), ElementsAre(HasSubstr("metadata.yaml announces 3 messages of the topics "
                                                          "that were read, and the files have 2")));
}

}  // namespace
}  // namespace glocal::test::bags::bag_folder_test
