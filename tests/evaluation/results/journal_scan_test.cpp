// Journals: what is written is read, also while it is written, and also when it is damaged.
#include "evaluation/results/journal_scan.hpp"

#include <gmock/gmock.h>

#include <array>
#include <chrono>
#include <nlohmann/json.hpp>
#include <optional>

#include "evaluation/results/file_io.hpp"
#include "temporary_folder.hpp"

namespace glocal::test::journal_scan_test {
namespace {

namespace fs = std::filesystem;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;
using testing::SizeIs;

constexpr TrialId first{1, 2}, second{3, 0xfedcba9876543210}, third{5, 6};

TrialOutput output(std::size_t trial) {
  TrialOutput output{{trial, {Outcome::right, 2.0, 1.0 / 3.0}, "a line\n", "some \"steps\"\n"}, {}};
  output.entry.figures.step_ms = {{0.1, 1e-17, 2.0 / 3.0, 4.0, 0.0, 5.0}};
  output.files = {{"maps/a.bin", std::string("\0\xff\n\\\x80n\\n\\", 8)}, {"trajectories/b.tum", "1 2 3\n"}};
  return output;
}

JournalEntry entry(const JournalScan& scan, const TrialId& id) {
  return entry_of(nlohmann::ordered_json::parse(scan.text_at(scan.finished().at(id).entry)));
}

NamedContents files(const JournalScan& scan, const TrialId& id) {
  NamedContents files;
  for (const JournalScan::Place& file : scan.finished().at(id).files)
    files.push_back(file_of_line(scan.text_at(file)));
  return files;
}

class JournalScanTest : public testing::Test {
 protected:
  [[nodiscard]] JournalScan scan(JournalScan::Closed closed = JournalScan::Closed::whole) {
    return {folder_.path(), [this](const std::string& text) { warnings_.push_back(text); }, closed};
  }

  [[nodiscard]] fs::path only_file() const { return fs::directory_iterator(folder_.path())->path(); }

  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
};

TEST(Checksum, IsTheOneOfGzip) {
  EXPECT_EQ(checksum("123456789"), "cbf43926");
  EXPECT_EQ(checksum(""), "00000000");
}

TEST(TrialIds, AreWrittenAsHexadecimalDigits) {
  EXPECT_EQ(to_string(second), "0000000000000003fedcba9876543210");
  EXPECT_EQ(trial_id_of(to_string(second)), second);
  EXPECT_THROW(static_cast<void>(trial_id_of("12")), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(trial_id_of("000000000000000gfedcba9876543210")), std::invalid_argument);
}

TEST_F(JournalScanTest, WhatAShardWritesIsRead) {
  Journal journal(folder_.path(), {3, 64}, 2);
  journal.add_variant("v", {{"key", "value"}});
  journal.begin(first, {{"sample", 7}});
  journal.begin(second, {{"sample", 8}});
  journal.finish(first, 12.4, output(7));
  journal.add_crash(second, {"SIGSEGV", "matcher 'a', step 1"});

  JournalScan read = scan();
  ASSERT_THAT(read.journals(), SizeIs(1));
  EXPECT_EQ(read.journals()[0].jobs, 2U);
  EXPECT_TRUE(read.journals()[0].is_live);
  ASSERT_TRUE(read.finished().contains(first));
  EXPECT_EQ(read.finished().at(first).ms, 12.0);
  EXPECT_EQ(read.finished().at(first).outcome, Outcome::right);
  const JournalEntry found = entry(read, first);
  EXPECT_EQ(found.trial, 7U);
  EXPECT_EQ(found.trial_line, "a line\n");
  EXPECT_EQ(found.step_lines, "some \"steps\"\n");
  EXPECT_EQ(found.figures.distance_m, 1.0 / 3.0);
  EXPECT_EQ(found.figures.step_ms[0].match, 1e-17);
  EXPECT_EQ(found.figures.step_ms[0].after, 5.0);
  EXPECT_EQ(files(read, first), output(7).files) << "bytes that are no text, too";
  ASSERT_THAT(read.begun(), SizeIs(1));
  EXPECT_EQ(read.text_at(read.begun().at(second)), "{\"sample\":8}");
  ASSERT_THAT(read.crashes().at(second), SizeIs(1));
  EXPECT_EQ(read.crashes().at(second)[0].where, "matcher 'a', step 1");
  EXPECT_EQ(read.text_at(read.variants().at("v")[0]), "{\"key\":\"value\"}");
  EXPECT_THAT(warnings_, IsEmpty());
}

TEST_F(JournalScanTest, WhatIsAddedIsReadWhereItWasLeft) {
  Journal journal(folder_.path(), {1, 1}, 1);
  JournalScan read = scan();
  EXPECT_THAT(read.finished(), IsEmpty());
  journal.finish(first, 1.0, output(0));
  read.update();
  EXPECT_THAT(read.finished(), SizeIs(1));
  journal.finish(second, 1.0, output(1));
  Journal other(folder_.path(), {2, 2}, 1);
  other.finish(third, 1.0, output(2));
  journal.close();
  read.update();
  EXPECT_THAT(read.finished(), SizeIs(3));
  EXPECT_THAT(read.journals(), SizeIs(2));
  EXPECT_EQ(entry(read, first).trial, 0U) << "under its new name";
  EXPECT_EQ(std::count_if(read.journals().begin(), read.journals().end(),
                          [](const JournalScan::Journal& j) { return j.is_closed; }),
            1);
}

TEST_F(JournalScanTest, HalfALineAtTheEndIsNotRead) {
  Journal journal(folder_.path(), {1, 1}, 1);
  journal.finish(first, 1.0, output(0));
  journal.finish(second, 1.0, output(1));
  const std::string whole = content_of(only_file());
  for (const std::size_t cut : {std::size_t{1}, std::size_t{20}, to_json(output(1).entry).dump().size()}) {
    fs::resize_file(only_file(), whole.size() - cut);
    EXPECT_THAT(scan().finished(), SizeIs(1)) << cut;
    EXPECT_THAT(warnings_, IsEmpty()) << "it may still be written";
  }
}

TEST_F(JournalScanTest, EveryDamagedByteIsFound) {
  {
    Journal journal(folder_.path(), {1, 1}, 1);
    journal.finish(first, 1.0, output(0));
    journal.close();
  }
  const std::string whole = content_of(only_file());
  const std::size_t begin = whole.find('\n') + 1;
  for (std::size_t i = begin; i + 1 < whole.size(); ++i) {
    std::string damaged = whole;
    damaged[i] = static_cast<char>(damaged[i] ^ 4);
    std::ofstream(only_file(), std::ios::binary) << damaged;
    warnings_.clear();
    EXPECT_THAT(scan().finished(), IsEmpty()) << i;
    EXPECT_FALSE(warnings_.empty()) << i;
  }
}

TEST_F(JournalScanTest, AClosedJournalIsReadOnceAndThenItsIndex) {
  Journal journal(folder_.path(), {1, 1}, 1);
  journal.add_variant("v", {{"key", "value"}});
  journal.begin(first, {{"sample", 7}});
  journal.finish(first, 12.4, output(7));
  journal.begin(second, {{"sample", 8}});
  journal.add_crash(second, {"SIGSEGV", "matcher 'a', step 1"});
  journal.close();
  const auto expect_all = [&](const JournalScan& read) {
    EXPECT_EQ(files(read, first), output(7).files);
    EXPECT_EQ(read.text_at(read.begun().at(second)), "{\"sample\":8}");
    EXPECT_THAT(read.crashes().at(second), SizeIs(1));
    EXPECT_EQ(read.text_at(read.variants().at("v")[0]), "{\"key\":\"value\"}");
    EXPECT_EQ(read.journals()[0].jobs, 1U);
  };
  const fs::path index = fs::path(journal.file()).replace_extension(".index");
  expect_all(scan());
  EXPECT_FALSE(fs::exists(index)) << "who reads all leaves none";
  expect_all(scan(JournalScan::Closed::indexed));
  ASSERT_TRUE(fs::exists(index));
  expect_all(scan(JournalScan::Closed::indexed));

  // A disk may lose bytes and leave the time as it was: who reads all finds out, and all others with him.
  const std::string whole = content_of(journal.file());
  std::ofstream(journal.file()) << std::string(whole).replace(whole.find("right"), 5, "wrong");
  const auto before = fs::last_write_time(index) - std::chrono::seconds(1);
  fs::last_write_time(journal.file(), before);
  expect_all(scan(JournalScan::Closed::indexed));
  EXPECT_THAT(warnings_, IsEmpty());
  EXPECT_THAT(scan().finished(), IsEmpty());
  EXPECT_FALSE(fs::exists(index));
  EXPECT_THAT(scan(JournalScan::Closed::indexed).finished(), IsEmpty());
  EXPECT_FALSE(fs::exists(index));

  std::ofstream(journal.file()) << whole;
  expect_all(scan(JournalScan::Closed::indexed));
  fs::resize_file(index, fs::file_size(index) / 2);
  expect_all(scan(JournalScan::Closed::indexed));

  // What was changed within the tick of the index cannot be told from what was there before.
  std::ofstream(journal.file()) << std::string(whole).replace(whole.find("right"), 5, "wrong");
  fs::last_write_time(journal.file(), fs::last_write_time(index));
  EXPECT_THAT(scan(JournalScan::Closed::indexed).finished(), IsEmpty());
  EXPECT_THAT(warnings_, Not(IsEmpty()));
}

TEST_F(JournalScanTest, FilesAreThoseOfTheProcessThatFinishedTheTrial) {
  const fs::path first_file = [&] {
    Journal killed(folder_.path(), {1, 1}, 1);
    killed.finish(first, 1.0, output(0));
    return killed.file();
  }();
  const std::string whole = content_of(first_file);
  // Before the trial's own line was written.
  fs::resize_file(first_file, whole.rfind('\n', whole.size() - 2) + 1);
  EXPECT_THAT(scan().finished(), IsEmpty());
  Journal next(folder_.path(), {1, 1}, 1);
  next.finish(first, 1.0, output(0));
  EXPECT_EQ(files(scan(), first), output(0).files);
  EXPECT_THAT(warnings_, IsEmpty());

  // A damaged file of a trial is as bad as a damaged trial.
  const std::string text = content_of(next.file());
  std::ofstream(next.file()) << std::string(text).replace(text.find("1 2 3"), 5, "1 2 4");
  EXPECT_THAT(scan().finished(), IsEmpty());
  EXPECT_THAT(warnings_, ElementsAre(HasSubstr("its checksum is another one"),
                                     HasSubstr("a file of the trial is missing")));
}

TEST_F(JournalScanTest, NoFileLeadsOutOfTheResults) {
  using std::string_literals::operator""s;
  EXPECT_EQ(file_of_line("maps/a\0b"s).second, "b");
  for (const std::string& text : {"maps/a"s, "/maps/a\0b"s, "maps/../../a\0b"s, "a\0b"s, "maps/a\0b\\"s})
    EXPECT_ANY_THROW(static_cast<void>(file_of_line(text))) << text;
}

TEST_F(JournalScanTest, LongLinesAndManyOfThem) {
  {
    Journal journal(folder_.path(), {1, 1}, 1);
    for (std::uint64_t i = 0; i < 300; ++i) {
      TrialOutput long_one = output(i);
      long_one.entry.step_lines.assign(i * 200, 's');
      journal.finish({i, i}, 1.0, long_one);
    }
  }
  const JournalScan read = scan();
  ASSERT_THAT(read.finished(), SizeIs(300));
  for (std::uint64_t i = 0; i < 300; ++i) {
    const JournalEntry found = entry(read, {i, i});
    EXPECT_EQ(found.trial, i);
    EXPECT_EQ(found.step_lines.size(), i * 200);
  }
}

TEST_F(JournalScanTest, AWriterIsAliveAsLongAsItTouchesItsFile) {
  const Journal journal(folder_.path(), {1, 1}, 1);
  EXPECT_EQ(scan().count_live(), 1U);
  fs::last_write_time(only_file(), fs::last_write_time(only_file()) - std::chrono::minutes(3));
  EXPECT_EQ(scan().count_live(), 0U);
  journal.touch();
  EXPECT_EQ(scan().count_live(), 1U);
  // Another machine's clock may be ahead.
  fs::last_write_time(only_file(), fs::last_write_time(only_file()) + std::chrono::hours(3));
  EXPECT_EQ(scan().count_live(), 1U);
}

TEST_F(JournalScanTest, ATrialIsBegunByWhoIsAlive) {
  std::array<std::optional<Journal>, 2> journals;
  for (auto& journal : journals) {
    journal.emplace(folder_.path(), Shard{1, 1}, 1);
    journal->begin(first, {{"sample", 7}});
  }
  for (std::size_t i = 0; i < journals.size(); ++i) {
    journals[i]->touch();
    const fs::path& killed = journals[1 - i]->file();
    fs::last_write_time(killed, fs::last_write_time(killed) - std::chrono::minutes(3));
    const JournalScan read = scan();
    EXPECT_EQ(read.journals()[read.begun().at(first).journal].file, journals[i]->file()) << i;
  }
}

TEST_F(JournalScanTest, AFolderThatIsNotThereHasNoJournals) {
  const JournalScan read(folder_ / "nowhere", [](const std::string&) {});
  EXPECT_THAT(read.journals(), IsEmpty());
}

TEST_F(JournalScanTest, FilesOfTwoWritersHaveDifferentNames) {
  const Journal one(folder_.path(), {1, 1}, 1);
  const Journal other(folder_.path(), {1, 1}, 1);
  EXPECT_NE(one.file(), other.file());
}

}  // namespace
}  // namespace glocal::test::journal_scan_test
