// What disturbances leave of a method's success: by hand for a suite of two places.
#include "evaluation/leaderboard/kept_success.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "evaluation/leaderboard/board_tables.hpp"
#include "glocal/error.hpp"

namespace glocal::test::kept_success_test {
namespace {

using testing::HasSubstr;

const DisturbedCase room_1{"room_short_range-1", "room", "short_range", 1};
const DisturbedCase room_5{"room_short_range-5", "room", "short_range", 5};
const DisturbedCase hall_1{"hall_short_range-1", "hall", "short_range", 1};
const DisturbedCase hall_5{"hall_short_range-5", "hall", "short_range", 5};

Suite disturbed_suite() {
  Suite suite;
  suite.name = "rough";
  suite.cases = {{"room", "", 4},      {room_1.name, "", 4},     {room_5.name, "", 4}, {"hall", "", 2},
                 {hall_1.name, "", 2}, {"hall_people-1", "", 2}, {hall_5.name, "", 2}};
  return suite;
}

/// r: right, w: wrong, u: undecided.
CaseResult result_of(const std::string& name, const std::string& outcomes) {
  CaseResult result{.case_name = name, .seed = 1, .numbers = {}, .starts = {}};
  for (const char c : outcomes) {
    const Outcome outcome = c == 'r' ? Outcome::right : c == 'w' ? Outcome::wrong : Outcome::undecided;
    result.numbers.push_back(result.numbers.size());
    result.starts.push_back(start_result(outcome, 3, 1.0, std::nullopt));
  }
  return result;
}

BoardEntry entry_of(const std::string& method) {
  return {.suite = "rough@1",
          .method = method,
          .results = {result_of("room", "rrru"), result_of(room_1.name, "rrru"),
                      result_of(room_5.name, "ruuw"), result_of("hall", "rr"), result_of(hall_1.name, "ru"),
                      result_of("hall_people-1", "rr"), result_of(hall_5.name, "ww")}};
}

TEST(DisturbedKinds, AreThoseBesideAPlaceOfTheSuite) {
  Suite suite = disturbed_suite();
  suite.cases.push_back({"attic_people-1", "", 2});  // There is no attic.
  suite.cases.push_back({"hall_people-6", "", 2});   // No such level.
  suite.cases.push_back({"hall_people", "", 2});
  const std::vector<DisturbedKind> kinds = disturbed_kinds(suite);
  ASSERT_EQ(kinds.size(), 2U);
  EXPECT_EQ(kinds[0].name, "short_range");
  ASSERT_EQ(kinds[0].cases.size(), 4U);
  EXPECT_EQ(kinds[0].cases[3].place, "hall");
  EXPECT_EQ(kinds[0].cases[3].level, 5);
  EXPECT_EQ(kinds[1].name, "people");
  EXPECT_EQ(kinds[1].cases.size(), 1U);
  EXPECT_EQ(of_level(kinds[0].cases, 1).size(), 2U);
}

TEST(KeptSuccess, IsTheMeanOverCasesOfRightOverRightWithoutDisturbances) {
  const KeptSuccess kept = kept_success(entry_of("mine"), {room_1, room_5, hall_1, hall_5});
  // Room: 3/4 of 3/4, 1/4 of 3/4; hall: 1/2 of 1, 0 of 1.
  EXPECT_DOUBLE_EQ(kept.share.value(), (1.0 + 1.0 / 3.0 + 0.5 + 0.0) / 4.0);
  EXPECT_EQ(kept.counts.starts, 12U);
  EXPECT_EQ(kept.counts.right, 5U);
  EXPECT_EQ(kept.counts.wrong, 3U);
}

TEST(KeptSuccess, IsUnknownWhereTheMethodIsNeverRight) {
  BoardEntry entry = entry_of("mine");
  entry.results[0] = result_of("room", "uuuu");
  EXPECT_FALSE(kept_success(entry, {room_1, room_5}).share);
  EXPECT_DOUBLE_EQ(kept_success(entry, {room_1, hall_1}).share.value(), 0.5);
}

TEST(KindsTable, HasAMethodALineThenEachKind) {
  BoardEntry worse = entry_of("worse");
  worse.results[2] = result_of(room_5.name, "uuuu");
  const std::string text = as_markdown(kinds_table(disturbed_suite(), {worse, entry_of("mine")}));
  EXPECT_THAT(text, HasSubstr("| mine | 83 % | – | – | – | 17 % | 57 % | 14 | 3, "));
  EXPECT_THAT(text, HasSubstr("| worse | 83 % | – | – | – | 0 % | 50 % | 14 | 2, "));
  EXPECT_LT(text.find("| mine |"), text.find("| worse |"));
  EXPECT_THAT(text, HasSubstr("| people, worse | 100 % | – | – | – | – | 100 % | 2 | 0, "));
}

TEST(KindsTable, RefusesASuiteWithoutDisturbances) {
  Suite suite = disturbed_suite();
  suite.cases.resize(1);
  EXPECT_THROW(static_cast<void>(kinds_table(suite, {})), ConfigError);
}

}  // namespace
}  // namespace glocal::test::kept_success_test
