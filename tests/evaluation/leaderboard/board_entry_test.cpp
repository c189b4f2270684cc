// What the leaderboard keeps: written and read again, counted, compared and told.
#include "evaluation/leaderboard/board_entry.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/leaderboard/board_tables.hpp"
#include "evaluation/leaderboard/entries_of_runs.hpp"
#include "files.hpp"
#include "glocal/pose2.hpp"

namespace glocal::test::board_entry_test {
namespace {

using testing::HasSubstr;
using testing::Not;

StartResult right_after(std::size_t steps) {
  return start_result(Outcome::right, steps, 0.25, PoseError{0.0371, radians(0.456)});
}
StartResult wrong_after(std::size_t steps) {
  return start_result(Outcome::wrong, steps, 1.0, PoseError{3.0, radians(90.0)});
}
StartResult undecided_after(std::size_t steps) {
  return start_result(Outcome::undecided, steps, 12.0, std::nullopt);
}

Suite small_suite() {
  Suite suite;
  suite.name = "small";
  suite.seeds = {1, 2};
  suite.cases = {{"room", "", 3}, {"hall", "", 1}};
  suite.is_pinned = true;
  return suite;
}

BoardEntry entry_of(const std::string& method, const std::vector<StartResult>& room) {
  BoardEntry entry{"small@1", method, 1.0, {{"revision", "v1"}}, {}};
  for (const std::uint64_t seed : {1U, 2U}) entry.results.push_back({"room", seed, {0, 1, 2}, room, {}, 1.5});
  for (const std::uint64_t seed : {1U, 2U})
    entry.results.push_back(
        {"hall", seed, {0}, {right_after(40)}, whole_drive(90, 0.0834, 0.18, 800, 1), 2.0});
  return entry;
}

BoardEntry some_entry() {
  return entry_of("mine", {right_after(2), wrong_after(5), undecided_after(41)});
}

void expect_same(const BoardEntry& a, const BoardEntry& b) {
  EXPECT_EQ(a.suite, b.suite);
  EXPECT_EQ(a.method, b.method);
  EXPECT_EQ(a.share, b.share);
  EXPECT_EQ(a.provenance, b.provenance);
  ASSERT_EQ(a.results.size(), b.results.size());
  for (std::size_t i = 0; i < a.results.size(); ++i) {
    EXPECT_EQ(a.results[i].case_name, b.results[i].case_name);
    EXPECT_EQ(a.results[i].seed, b.results[i].seed);
    EXPECT_EQ(a.results[i].numbers, b.results[i].numbers);
    EXPECT_EQ(a.results[i].starts, b.results[i].starts);
    EXPECT_EQ(a.results[i].drive, b.results[i].drive);
    EXPECT_EQ(a.results[i].step_ms, b.results[i].step_ms);
  }
}

TEST(BoardEntryTest, ComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  expect_same(read_entry(folder.write("mine.json", to_text(some_entry()))), some_entry());
}

TEST(BoardEntryTest, FiguresAreRoundedAndStandOnALineForEachCaseAndSeed) {
  const std::string text = to_text(some_entry());
  EXPECT_THAT(text, HasSubstr("\"outcome\": \"rwu\",\n   \"steps\": [2,5,41],\n   \"m\": [0.3,1,12],\n"
                              "   \"cm\": [3.7,300,null],\n   \"deg\": [0.46,90,null]}"));
  EXPECT_THAT(
      text,
      HasSubstr("\"localized\": 90, \"largest_cm\": 8.34, \"largest_deg\": 0.18, \"clusters\": [800, 1], "
                "\"outcome\": \"r\", \"steps\": [40], \"m\": [0.3], \"cm\": [3.7], \"deg\": [0.46]}"));
}

TEST(BoardEntryTest, DamagedFilesAreRefused) {
  const TemporaryFolder folder;
  std::string text = to_text(some_entry());
  const auto fault = [&](const std::string& from, const std::string& to) {
    std::string damaged = text;
    damaged.replace(damaged.find(from), from.size(), to);
    return error_of([&] { return read_entry(folder.write("mine.json", damaged)); });
  };
  EXPECT_THAT(fault("[2,5,41]", "[2,5]"), HasSubstr("'steps' has not as many values as 'outcome'"));
  EXPECT_THAT(fault("rwu", "rxu"), HasSubstr("'x' is no outcome"));
  EXPECT_THAT(fault("[3.7,300,null]", "[3.7,\"far\",null]"), HasSubstr("a figure is no number"));
  EXPECT_THAT(fault("\"format\": 1", "\"format\": 9"), HasSubstr("it is of another version"));
  EXPECT_THAT(fault("]", ""), HasSubstr("is no entry of a leaderboard"));
}

TEST(BoardEntryTest, AnEntryIsOfTheWholeSuite) {
  BoardEntry entry = some_entry();
  std::swap(entry.results[0], entry.results[3]);
  require_whole(entry, small_suite(), "mine.json");
  expect_same(entry, some_entry());

  entry.results.pop_back();
  EXPECT_THAT(error_of([&] { require_whole(entry, small_suite(), "mine.json"); }),
              HasSubstr("mine.json: error: small@1: there is no result for the case hall with seed 2"));
  entry = some_entry();
  entry.results[1].starts.pop_back();
  EXPECT_THAT(error_of([&] { require_whole(entry, small_suite(), "mine.json"); }),
              HasSubstr("the case room with seed 2 has 2 starts here, and should have 3"));
  entry = some_entry();
  entry.results.push_back({"attic", 1, {}, {}, {}, {}});
  EXPECT_THAT(error_of([&] { require_whole(entry, small_suite(), "mine.json"); }),
              HasSubstr("there are results of other cases or seeds than the suite's"));
}

// Half of the starts: which, is_in_share() says.
BoardEntry half_an_entry(const Suite& suite) {
  BoardEntry entry = some_entry();
  entry.share = 0.5;
  std::vector<CaseResult> whole = std::move(entry.results);
  entry.results.clear();
  for (CaseResult& result : whole) {
    CaseResult half = result;
    half.numbers.clear();
    half.starts.clear();
    for (std::size_t i = 0; i < suite.find_case(result.case_name)->starts; ++i) {
      if (!is_in_share(result.case_name, result.seed, i, 0.5)) continue;
      half.numbers.push_back(i);
      half.starts.push_back(result.starts[i]);
    }
    if (!half.numbers.empty()) entry.results.push_back(std::move(half));
  }
  return entry;
}

TEST(BoardEntryTest, AShareOfASuiteHasItsStarts) {
  const Suite suite = small_suite();
  BoardEntry entry = half_an_entry(suite);
  const BoardCounts counts = counts_of(entry);
  ASSERT_GT(counts.starts, 0U);
  ASSERT_LT(counts.starts, 8U);
  const TemporaryFolder folder;
  const std::filesystem::path file = folder.write("mine.json", to_text(entry));
  BoardEntry again = read_entry(file);
  expect_same(again, entry);
  require_whole(again, suite, file);

  const CaseResult& first = again.results.front();
  EXPECT_EQ(first.find(first.numbers.front()), &first.starts.front());
  EXPECT_EQ(first.find(3), nullptr);
  EXPECT_THAT(as_text(board_tables(suite, {again}, {})), HasSubstr("mine (share 0.5)"));

  again.share = 1.0;
  EXPECT_THAT(error_of([&] { require_whole(again, suite, file); }), HasSubstr("and should have 3"));
}

TEST(BoardEntryTest, SharesThatCannotBeAreRefused) {
  const TemporaryFolder folder;
  const auto fault = [&](double share) {
    BoardEntry entry = some_entry();
    entry.share = share;
    return error_of([&] { return read_entry(folder.write("mine.json", to_text(entry))); });
  };
  EXPECT_THAT(fault(-0.5), HasSubstr("'share' is not in (0, 1]"));
  EXPECT_THAT(fault(1e-9), HasSubstr("'share' is too small for so many starts"));
}

TEST(DifferencesTest, NameEachStartThatEndsOtherwise) {
  const CaseResult stored = some_entry().results[0];
  CaseResult fresh = stored;
  EXPECT_TRUE(differences(stored, fresh).empty());
  fresh.starts = {right_after(2), undecided_after(42), right_after(1)};
  fresh.numbers = {0, 2, 5};  // 5 is not among those that are stored.
  EXPECT_THAT(
      differences(stored, fresh),
      testing::ElementsAre("room, seed 1, start 2: undecided after 41 steps is stored, undecided after 42 "
                           "steps it is now"));
}

TEST(DifferencesTest, WholeDrivesDifferInWhatComesAfterTheDeclaration) {
  const CaseResult stored = some_entry().results[2];
  CaseResult fresh = stored;
  fresh.drive->cm = 8.4;
  EXPECT_THAT(differences(stored, fresh),
              testing::ElementsAre(HasSubstr("hall, seed 1: localized in 90 steps")));
}

// p by hand: 4 of 4 starts that differ do so in one way, 2 / 2^4.
TEST(PairedText, CountsWhatHasChanged) {
  const BoardEntry before = entry_of("mine", {right_after(2), wrong_after(5), wrong_after(9)});
  const BoardEntry now = entry_of("mine", {right_after(4), right_after(5), right_after(9)});
  const std::string text = paired_text(before, now);
  EXPECT_THAT(text, HasSubstr("right  4 before, 8 now: 0 no more, 4 newly (p 0.12)"));
  EXPECT_THAT(text, HasSubstr("wrong  4 before, 0 now: 4 no more, 0 newly (p 0.12)"));
  EXPECT_THAT(
      text, HasSubstr("steps  0 of 4 starts that are right both times need fewer, 2 more, by 1 in the mean"));
}

TEST(BoardTables, BestComesFirstAndEachCaseHasItsLine) {
  const std::vector<BoardEntry> entries = {
      some_entry(), entry_of("yours", {right_after(2), right_after(4), undecided_after(41)})};
  const std::string all = as_text(board_tables(small_suite(), entries, {}));
  EXPECT_LT(all.find("yours"), all.find("mine"));
  // Wilson's interval of 2 of 8, by his formula.
  EXPECT_THAT(all, HasSubstr("2, 7.1 to 59.1 %"));
  const std::string room =
      as_text(board_tables(small_suite(), entries, {.by_case = true, .cases = {"room"}}));
  EXPECT_THAT(room, HasSubstr("room, mine"));
  EXPECT_THAT(room, Not(HasSubstr("hall")));
  const std::string alone = as_text(board_tables(small_suite(), {some_entry()}, {.by_case = true}));
  EXPECT_THAT(alone, HasSubstr("\n  room "));
}

TEST(BoardTables, WholeDrivesStandBesideWhatIsPublished) {
  Suite suite = small_suite();
  suite.published = {{"hall", 8.34, 0.18, "about 800 become one"}};
  EXPECT_THAT(as_markdown(board_tables(suite, {some_entry()}, {})),
              HasSubstr("| hall | 2 of 2 | 8.3 cm, 0.18° | 8.3 cm, 0.18° | 2 of 2 | 800 | 1 |"));
  suite.published[0].rotation_deg = 0.17;
  EXPECT_THAT(as_markdown(board_tables(suite, {some_entry()}, {})), HasSubstr("| 0 of 2 | 800 | 1 |"));
}

TEST(BoardOverview, HasALineForEachMethodAndAColumnForEachSuite) {
  const std::string text = as_markdown(board_overview({"small@1", "large@1"}, {some_entry()}));
  EXPECT_THAT(text, HasSubstr("| small@1 | large@1 |"));
  EXPECT_THAT(text, HasSubstr("| mine | 2 / 4 of 8 | – |"));
}

}  // namespace
}  // namespace glocal::test::board_entry_test
