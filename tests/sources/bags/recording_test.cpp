#include "sources/bags/recording.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>

#include "files.hpp"
#include "sources/bags/messages.hpp"
#include "sources/bags/recordings.hpp"

namespace glocal::test::bags::recording_test {
namespace {

using glocal::bags::Connection;
using glocal::bags::LaserScan;
using glocal::bags::read_laser_scan;
using glocal::bags::Recording;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// "stamp topic bytes" of each message, and its warnings behind.
std::vector<std::string> content(Recording& recording) {
  std::vector<std::string> all;
  while (const auto m = recording.next())
    all.push_back(std::to_string(m->stamp_ns) + " " + m->connection->topic + " " + std::string(m->bytes));
  return all;
}

class Recordings : public testing::Test {
 protected:
  [[nodiscard]] std::vector<std::string> read(const std::string& bytes) const {
    Recording recording(folder_.write("file", bytes));
    return content(recording);
  }
  [[nodiscard]] std::string fault(const std::string& bytes) const {
    folder_.write("file", bytes);
    return config_error(folder_.path(), [&] {
      Recording recording(folder_ / "file");
      static_cast<void>(content(recording));
    });
  }
  /// Of the file that was written last, where damage is refused.
  [[nodiscard]] std::string strict_fault() const {
    return config_error(folder_.path(), [&] {
      Recording recording(folder_ / "file", glocal::bags::Damage::refused);
      static_cast<void>(content(recording));
    });
  }
  /// Every beginning of a recording is refused, or read with a warning.
  void expect_each_cut_is_told(const std::string& bytes) const {
    for (std::size_t n = 0; n < bytes.size(); ++n) {
      SCOPED_TRACE(n);
      folder_.write("cut", std::string_view(bytes).substr(0, n));
      try {
        Recording recording(folder_ / "cut");
        static_cast<void>(content(recording));
        EXPECT_TRUE(n >= whole_ || !recording.warnings().empty());
      } catch (const ConfigError&) {
      }
    }
  }

  TemporaryFolder folder_;
  std::size_t whole_ = 0;  ///< Bytes from which on nothing lacks.
};

const std::string two_channels =
    mcap_channel(1, "/a", "sensor_msgs/msg/LaserScan") + mcap_channel(2, "/b", "x/B");

TEST_F(Recordings, OfMcapAreReadInOrderOfTimeWhateverTheCompression) {
  for (const std::string compression : {"", "lz4", "zstd"}) {
    const std::string late =
        mcap_chunk({4, 7, mcap_message(1, 7, "seven") + mcap_message(2, 4, "four"), compression});
    const std::string early = mcap_chunk(
        {1, 5, two_channels + mcap_message(1, 1, "one") + mcap_message(2, 5, "five"), compression, false});
    const std::vector<std::string> all = {"1 /a one", "4 /b four", "5 /b five", "7 /a seven"};
    EXPECT_EQ(read(mcap_file(late + early, two_channels)), all);
    EXPECT_EQ(read(mcap_file(early + late)), all) << "without summary";
  }
}

TEST_F(Recordings, OfMcapNeedNoWholeSummary) {
  const std::string chunks = mcap_chunk({1, 2, two_channels + mcap_message(1, 1, "one"), "zstd"}) +
                             mcap_chunk({2, 2, mcap_message(2, 2, "two"), "zstd"});
  const auto all = ElementsAre("1 /a one", "2 /b two");
  // Cut behind the first channel of the summary.
  const std::string whole = mcap_file(chunks, mcap_channel(1, "/a", "sensor_msgs/msg/LaserScan") + "END");
  EXPECT_THAT(read(whole.substr(0, whole.rfind("END"))), all);
  // Some writers do not repeat schemas.
  const std::string without_schema = mcap_record(
      4, le<std::uint16_t>(1) + le<std::uint16_t>(1) + sized("/a") + sized("cdr") + le<std::uint32_t>(0));
  EXPECT_THAT(read(mcap_file(chunks, without_schema)), all);
}

TEST_F(Recordings, OfMcapNeedNoChunks) {
  EXPECT_THAT(read(mcap_file(two_channels + mcap_message(1, 2, "two") + mcap_message(2, 1, "one"))),
              ElementsAre("1 /b one", "2 /a two"));
}

TEST_F(Recordings, GiveOnlyTheTopicsThatAreWanted) {
  Recording recording(
      folder_.write("file", mcap_file(two_channels + mcap_message(1, 2, "two") + mcap_message(2, 1, "one"))));
  EXPECT_THAT(recording.connections(),
              ElementsAre(Connection{"/a", "sensor_msgs/LaserScan", "cdr", "definition"},
                          Connection{"/b", "x/B", "cdr", "definition"}));
  recording.rewind({{"/a"}});
  EXPECT_THAT(content(recording), ElementsAre("2 /a two"));
  recording.rewind();
  EXPECT_EQ(content(recording).size(), 2U);
}

TEST_F(Recordings, TellHowMuchHasBeenRead) {
  std::string chunks;
  for (std::uint64_t i = 1; i <= 200; ++i)
    chunks += mcap_chunk({i, i, (i == 1 ? two_channels : "") + mcap_message(1, i, "x"), "zstd"});
  Recording recording(folder_.write("file", mcap_file(chunks)));
  std::vector<double> shares;
  recording.tell_progress([&](double share) { shares.push_back(share); });
  static_cast<void>(content(recording));
  ASSERT_EQ(shares.size(), 4U);
  EXPECT_NEAR(shares[0], 0.32, 0.01);
  EXPECT_NEAR(shares[1], 0.64, 0.01);
  EXPECT_NEAR(shares[2], 0.96, 0.01);
  EXPECT_EQ(shares[3], 1.0);
}

TEST_F(Recordings, OfMcapAreCheckedBeforeTheyAreBelieved) {
  std::string damaged = mcap_file(mcap_chunk({1, 1, two_channels + mcap_message(1, 1, "one"), ""}));
  damaged[damaged.find("one")] = 'x';
  EXPECT_THAT(fault(damaged), HasSubstr("file: error: byte 25: the chunk's CRC-32 is "));
  EXPECT_THAT(fault(mcap_file(mcap_chunk({1, 1, two_channels, "brotli"}))),
              HasSubstr("is compressed with 'brotli'; none, bz2, lz4 and zstd can be read"));
  EXPECT_THAT(fault(mcap_file(mcap_message(9, 1, "one"))), HasSubstr("is of channel 9, which"));
  const std::string zeros(1U << 20U, '\0');
  std::string bomb = mcap_file(mcap_chunk({1, 1, zeros, "zstd"}));
  bomb.replace(25 + 9 + 16, 8, le<std::uint64_t>(100));
  EXPECT_THAT(fault(bomb), HasSubstr("does not unpack to the 100 bytes"));
  bomb.replace(25 + 9 + 16, 8, le<std::uint64_t>(1ULL << 40U));
  EXPECT_THAT(fault(bomb), HasSubstr("a chunk of 1099511627776 bytes is announced, at most"));
}

TEST_F(Recordings, SayWhenAChunkBeginsEarlierThanItSays) {
  Recording recording(
      folder_.write("file", mcap_file(two_channels + mcap_chunk({5, 6, mcap_message(1, 2, "two"), ""}))));
  static_cast<void>(content(recording));
  EXPECT_THAT(recording.warnings(),
              ElementsAre(HasSubstr("before the time that the file says it begins at")));
}

TEST_F(Recordings, ThatEndEarlyAreReadUpToThere) {
  const std::string mcap = mcap_file(mcap_chunk({1, 1, two_channels + mcap_message(1, 1, "one"), "zstd"}) +
                                     mcap_chunk({2, 2, mcap_message(2, 2, "two"), "lz4"}));
  whole_ = mcap.size() - mcap_magic.size();
  expect_each_cut_is_told(mcap);
  const std::string bag = ros1_magic + ros1_bag_header() +
                          ros1_chunk(ros1_connection(0, "/a", "x/A") + ros1_message(0, 1, "one"), "bz2") +
                          ros1_chunk(ros1_message(0, 2, "two"), "lz4");
  whole_ = 0;  // A bag may end behind any record.
  expect_each_cut_is_told(bag);
  EXPECT_THAT(read(bag.substr(0, bag.size() - 1)), ElementsAre("1000000000 /a one"));
}

TEST_F(Recordings, ThatAreDamagedBehindSomethingWholeAreReadUpToThere) {
  const std::string whole = ros1_magic + ros1_bag_header() +
                            ros1_chunk(ros1_connection(0, "/a", "x/A") + ros1_message(0, 1, "one"), "bz2");
  const std::string bag = whole + le<std::uint32_t>(528281152) + std::string(400, 'x');
  folder_.write("file", bag);
  Recording recording(folder_ / "file");
  EXPECT_THAT(content(recording), ElementsAre("1000000000 /a one"));
  EXPECT_THAT(recording.warnings(),
              ElementsAre(AllOf(HasSubstr("byte " + std::to_string(whole.size()) +
                                          ": a record's header of 528281152 bytes is announced"),
                                HasSubstr("what comes before it is read: " + std::to_string(whole.size()) +
                                          " of " + std::to_string(bag.size()) + " bytes"))));
  EXPECT_THAT(strict_fault(), HasSubstr("a record's header of 528281152 bytes is announced"));
}

TEST_F(Recordings, ChunksThatAreDamagedAreLeftOut) {
  const auto chunk = [](std::uint64_t at, const char* text) {
    return mcap_chunk({at, at, two_channels + mcap_message(1, at, text), "zstd"});
  };
  std::string mcap = mcap_file(chunk(1, "one") + chunk(2, "two") + chunk(3, "three") + chunk(4, "four"));
  for (const char* text : {"two", "four"}) {
    const std::string part = chunk(text[0] == 't' ? 2 : 4, text);
    mcap[mcap.find(part) + part.size() - 3] ^= 1;
  }
  folder_.write("file", mcap);
  Recording recording(folder_ / "file");
  EXPECT_THAT(content(recording), ElementsAre("1 /a one", "3 /a three"));
  recording.rewind();
  EXPECT_THAT(content(recording), ElementsAre("1 /a one", "3 /a three"));
  EXPECT_THAT(recording.warnings(),
              ElementsAre(HasSubstr("this chunk is left out, as are others that are damaged"),
                          HasSubstr("2 of 4 chunks are damaged and left out, the first at byte ")));
  EXPECT_THAT(strict_fault(), HasSubstr("get a fresh copy"));
}

TEST_F(Recordings, CompressedMessagesThatAreDamagedAreLeftOut) {
  const auto whole = [](std::uint64_t at, const std::string& text) {
    return mcap_message(1, at, packed("zstd", text));
  };
  const auto cut = [](std::uint64_t at, const std::string& text) {
    const std::string bytes = packed("zstd", text);
    return mcap_message(1, at, bytes.substr(0, bytes.size() - 1));
  };
  folder_.write("file",
                mcap_file(two_channels + whole(1, "one") + cut(2, "two") + whole(3, "three") + cut(4, "4")));
  Recording recording(folder_ / "file");
  EXPECT_THAT(content(recording), ElementsAre("1 /a one", "3 /a three"));
  recording.rewind();
  EXPECT_THAT(content(recording), ElementsAre("1 /a one", "3 /a three"));
  EXPECT_THAT(recording.warnings(),
              ElementsAre(HasSubstr("this message is left out, as are others that are damaged"),
                          HasSubstr("file: 2 messages are damaged and left out")));
  EXPECT_THAT(strict_fault(), HasSubstr("does not unpack to the 3 bytes that are announced"));
  EXPECT_THAT(fault(mcap_file(two_channels + cut(2, "two") + cut(4, "4"))),
              HasSubstr("does not unpack to the 3 bytes that are announced"));
}

TEST_F(Recordings, OfRos1NeedNoIndex) {
  for (const std::string compression : {"none", "bz2", "lz4"}) {
    EXPECT_THAT(read(ros1_magic + ros1_bag_header() +
                     ros1_chunk(ros1_connection(0, "/a", "x/A") + ros1_message(0, 3, "three"), compression) +
                     ros1_chunk(ros1_message(0, 4, "four") + ros1_message(0, 2, "two"), compression)),
                ElementsAre("2000000000 /a two", "3000000000 /a three", "4000000000 /a four"));
  }
}

TEST_F(Recordings, WithIndexesBehindTheirChunksAreNotUnpackedForTheirNames) {
  const std::string first = mcap_chunk({3, 4, two_channels + mcap_message(1, 3, "three"), "zstd"});
  std::string second = mcap_chunk({1, 2, mcap_message(2, 1, "one"), "zstd"});
  const std::string mcap = mcap_file(first + mcap_message_index(1) + second + mcap_message_index(2));
  EXPECT_THAT(read(mcap), ElementsAre("1 /b one", "3 /a three"));
  const std::string late_name =
      mcap_file(mcap_chunk({1, 1, mcap_channel(1, "/a", "x/A") + mcap_message(1, 1, "one"), ""}) +
                mcap_message_index(1) +
                mcap_chunk({2, 2, mcap_channel(2, "/b", "x/B") + mcap_message(2, 2, "two"), ""}) +
                mcap_message_index(2));
  EXPECT_THAT(read(late_name), ElementsAre("1 /a one", "2 /b two"));
  std::string damaged = mcap;
  damaged[damaged.find(second) + second.size() - 3] ^= 1;
  EXPECT_NO_THROW(Recording(folder_.write("file", damaged))) << "the second chunk is not looked into";
  EXPECT_THAT(read(damaged), ElementsAre("3 /a three"));

  const std::string names = ros1_connection(0, "/a", "x/A");
  std::string late = ros1_chunk(names + ros1_message(0, 3, "three") + ros1_message(0, 5, "five"), "bz2");
  std::string early = ros1_chunk(ros1_message(0, 1, "one") + ros1_message(0, 4, "four"), "lz4");
  const std::string bag =
      ros1_magic + ros1_bag_header() + late + ros1_index(0, 3, 5) + early + ros1_index(0, 1, 4);
  EXPECT_THAT(read(bag), ElementsAre("1000000000 /a one", "3000000000 /a three", "4000000000 /a four",
                                     "5000000000 /a five"));
  damaged = bag;
  damaged[damaged.find(early) + early.size() - 6] ^= 1;
  EXPECT_NO_THROW(Recording(folder_.write("file", damaged)));
}

TEST_F(Recordings, OfOtherKindsAreRefused) {
  EXPECT_EQ(fault("#ROSRECORD V1.2\n"),
            "file: error: byte 0: is a bag of ROS 1 that begins with '#ROSRECORD V1.2'; only version 2.0 can "
            "be read: convert it with ROS (rosbag fix)");
  EXPECT_THAT(fault(ros1_magic + ros1_bag_header({{"encryptor", "rosbag/AesCbcEncryptor"}})),
              HasSubstr("the bag is encrypted (rosbag/AesCbcEncryptor); decrypt it with ROS"));
  EXPECT_THAT(fault("FLASER 3 1 1 1"), HasSubstr("begins like no recording"));
  EXPECT_THAT(fault(""), HasSubstr("the file is empty"));
  EXPECT_THAT(fault(ros1_magic + ros1_chunk(ros1_message(7, 1, "x"))),
              HasSubstr("is of connection 7, which"));
  EXPECT_THAT(fault(ros1_magic + le<std::uint32_t>(0x7FFFFFFF)),
              HasSubstr("a record's header of 2147483647 bytes"));
}

/// A bag of ROS 2 with messages at 10 * n + 1 and 10 * n + 2.
void write_db3(const std::filesystem::path& file, int n) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  const std::string at = std::to_string(n);
  const std::string sql =
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL, "
      "serialization_format TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL, "
      "data BLOB NOT NULL);"
      "INSERT INTO topics VALUES(1, '/a', 'x/msg/A', 'cdr');"
      "INSERT INTO messages VALUES(1, 1, " +
      at + "2, 'b'), (2, 1, " + at + "1, 'a');";
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(database);
}

TEST_F(Recordings, OfRos2MayHaveSeveralFiles) {
  write_db3(folder_ / "run_0.db3", 2);
  write_db3(folder_ / "run_1.db3", 1);
  folder_.write("metadata.yaml", "rosbag2_bagfile_information: {}\n");
  Recording recording(folder_.path());
  EXPECT_EQ(recording.connections().size(), 1U);
  EXPECT_THAT(content(recording), ElementsAre("11 /a a", "12 /a b", "21 /a a", "22 /a b"));
  Recording moved = std::move(recording);
  moved.rewind();
  EXPECT_EQ(content(moved).size(), 4U);
}

/// Writes into a bag as a recorder in WAL mode, which is killed before it has moved this into the file.
void write_beside(const std::filesystem::path& file, const std::string& sql) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
  sqlite3_db_config(database, SQLITE_DBCONFIG_NO_CKPT_ON_CLOSE, 1, nullptr);
  EXPECT_EQ(sqlite3_exec(database, sql.c_str(), nullptr, nullptr, nullptr), SQLITE_OK);
  sqlite3_close(database);
}

TEST_F(Recordings, OfRos2WhoseRecorderWasKilledAreTold) {
  const std::filesystem::path file = folder_ / "file";
  write_db3(file, 1);
  write_beside(file, "INSERT INTO messages VALUES(3, 1, 13, 'c')");
  const auto damage = [](const std::string& name) {
    return "'" + name +
           "-wal' beside it has messages that it has not, as its recorder has not ended properly; " +
           "put them together: sqlite3 " + name + " 'PRAGMA wal_checkpoint(TRUNCATE)'";
  };
  Recording recording(file);
  EXPECT_THAT(content(recording), ElementsAre("11 /a a", "12 /a b"));
  EXPECT_THAT(recording.warnings(), ElementsAre(file.string() + ": " + damage(file.string()) +
                                                "; only what is in the file itself is read"));
  EXPECT_EQ(strict_fault(), "file: error: " + damage("file"));
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "PRAGMA wal_checkpoint(TRUNCATE)", nullptr, nullptr, nullptr);
  sqlite3_close(database);
  Recording whole(file);
  EXPECT_THAT(content(whole), ElementsAre("11 /a a", "12 /a b", "13 /a c"));
  EXPECT_THAT(whole.warnings(), IsEmpty());
}

TEST_F(Recordings, OfRos2WhoseTablesAreBesideThemAreTold) {
  write_beside(folder_ / "file", "CREATE TABLE topics(id); CREATE TABLE messages(id)");
  EXPECT_THAT(config_error(folder_.path(), [&] { Recording recording(folder_ / "file"); }),
              HasSubstr("file-wal' beside it has messages that it has not"));
}

TEST_F(Recordings, OfRos2WithAJournalThatIsNotDoneWithAreTold) {
  write_db3(folder_ / "file", 1);
  const auto warnings = [&](const std::string& journal) {
    folder_.write("file-journal", journal);
    return Recording(folder_ / "file").warnings();
  };
  EXPECT_THAT(
      warnings("\xD9\xD5\x05\xF9 pages"),
      ElementsAre(HasSubstr("file-journal' beside it has what was there before an unfinished change")));
  EXPECT_THAT(warnings(""), IsEmpty());
  EXPECT_THAT(warnings(std::string(28, '\0') + "pages"), IsEmpty());
}

TEST_F(Recordings, OfRos2AreRefusedWhereTheyAreNone) {
  sqlite3* database = nullptr;
  ASSERT_EQ(sqlite3_open((folder_ / "file").c_str(), &database), SQLITE_OK);
  sqlite3_exec(database, "CREATE VIEW topics AS SELECT 1", nullptr, nullptr, nullptr);
  sqlite3_close(database);
  EXPECT_EQ(config_error(folder_.path(), [&] { Recording recording(folder_ / "file"); }),
            "file: error: is an SQLite database without the table 'topics' of a bag of ROS 2");
  EXPECT_THAT(fault(std::string("SQLite format 3\0", 16) + std::string(200, 'x')),
              HasSubstr("as a bag of ROS 2"));
}

// Numbers found by Python's struct, bz2 and sqlite3, without glocal.

struct Known {
  std::string file;
  std::size_t messages;
  std::string topic, type;
  std::size_t of_topic;
  std::int64_t first_ns;
};

class KnownRecordings : public testing::TestWithParam<Known> {};

TEST_P(KnownRecordings, HaveWhatAnotherReaderFinds) {
  const std::filesystem::path file = dataset("bags/" + GetParam().file);
  if (file.empty() || !exists(file)) GTEST_SKIP() << "GLOCAL_DATASETS has no " << GetParam().file;
  Recording recording(file);
  std::size_t messages = 0, of_topic = 0;
  std::int64_t last = 0;
  while (const auto m = recording.next()) {
    ++messages;
    EXPECT_GE(m->stamp_ns, last);
    last = m->stamp_ns;
    if (m->connection->topic != GetParam().topic) continue;
    if (of_topic++ == 0) {
      EXPECT_EQ(m->stamp_ns, GetParam().first_ns);
      EXPECT_EQ(m->connection->type, GetParam().type);
    }
  }
  EXPECT_EQ(messages, GetParam().messages);
  EXPECT_EQ(of_topic, GetParam().of_topic);
  EXPECT_THAT(recording.warnings(), IsEmpty());
}

INSTANTIATE_TEST_SUITE_P(
    Files, KnownRecordings,
    testing::Values(
        Known{"jarvis/jarvis_circular_path_fast.bag", 7584, "/tf", "tf2_msgs/TFMessage", 6147,
              1411657682002622750},
        Known{"guardian/guardian_3.bag", 53937, "/scan", "sensor_msgs/LaserScan", 1036, 1410356747059621612},
        Known{"formats/tilt_laser.bag", 4093, "/tf", "tf/tfMessage", 711, 1326899528468377678},
        Known{"formats/turtlesim-example-bz2.bag", 8647, "/tf", "tf/tfMessage", 2688, 1396293888056251251},
        Known{"formats/turtlesim-example-lz4.bag", 8647, "/tf", "tf/tfMessage", 2688, 1396293888056251251},
        Known{"formats/turtlesim-example-unsorted-chunks.bag", 3, "foo", "std_msgs/String", 3, 1000000000},
        Known{"formats/turtlesim-no-messages.bag", 0, "", "", 0, 0},
        Known{"formats/lz4_scans_odometry_clouds.bag", 15, "/base_scan", "sensor_msgs/LaserScan", 5,
              1604515197422793434},
        Known{"formats/imu_pose.db3", 4695, "/pose", "geometry_msgs/PoseStamped", 1565, 1588512872785341595},
        Known{"formats/rosbag2_wbag_0.mcap", 1246, "EEE", "std_msgs/String", 147, 1000},
        Known{"formats/json_messages.mcap", 110005, "/eip/alarm_count", "Alarm_Count_data", 3143,
              1751644407895146607}));

TEST(KnownScans, HaveTheValuesThatAnotherReaderFinds) {
  const std::filesystem::path file = dataset("bags/jarvis/jarvis_circular_path_fast.bag");
  if (file.empty() || !exists(file)) GTEST_SKIP() << "GLOCAL_DATASETS has no " << file;
  Recording recording(file);
  recording.rewind({{"/driver_laser_navigation/laser_scan"}});
  const auto message = recording.next();
  ASSERT_TRUE(message);
  const LaserScan scan = read_laser_scan(*message);
  EXPECT_EQ(scan.header.stamp_ns, 1411657682042859022);
  EXPECT_EQ(scan.header.frame, "base_laser_navigation_link");
  EXPECT_FLOAT_EQ(scan.angle_max, 6.27882194519043F);
  EXPECT_FLOAT_EQ(scan.angle_increment, 0.004363323096185923F);
  EXPECT_FLOAT_EQ(scan.range_max, 250.0F);
  ASSERT_EQ(scan.ranges.size(), 1440U);
  EXPECT_FLOAT_EQ(scan.ranges[0], 14.743000030517578F);
  EXPECT_FLOAT_EQ(scan.ranges[720], 5.7779998779296875F);
  EXPECT_FLOAT_EQ(scan.ranges[1439], 14.718999862670898F);
}

TEST(KnownPoses, HaveTheValuesThatAnotherReaderFinds) {
  const std::filesystem::path file = dataset("bags/formats/imu_pose.db3");
  if (file.empty() || !exists(file)) GTEST_SKIP() << "GLOCAL_DATASETS has no " << file;
  Recording recording(file);
  recording.rewind({{"/pose"}});
  // The robot's place is a count, and its quaternion (5, 6, 7, 8) is none.
  EXPECT_THAT(config_error("here", [&] { static_cast<void>(glocal::bags::read_pose(*recording.next())); }),
              HasSubstr("the quaternion has a length of 13.19 instead of 1"));
}

}  // namespace
}  // namespace glocal::test::bags::recording_test
