// What the page of the leaderboard is given.
#include "report/board_page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "glocal/rng.hpp"
#include "report/page_text.hpp"
#include "report/unpacked.hpp"

namespace glocal::test::board_page_test {
namespace {

using Json = nlohmann::ordered_json;

Suite suite_of(const std::string& name, std::size_t starts) {
  Suite suite;
  suite.name = name;
  suite.seeds = {1};
  suite.cases = {{"room", "", starts}, {"hall", "", 1}};
  return suite;
}

/// Right in the hall after 40 steps, and in the room as the letters say.
BoardEntry entry_of(const std::string& method, const std::string& room) {
  const StartResult right = start_result(Outcome::right, 40, 9.0, PoseError{0.012, 0.0});
  BoardEntry entry{"small@1",
                   method,
                   1.0,
                   {{"cpu", "some"}},
                   {{"room", 1, {}, {}, {}, 1.5}, {"hall", 1, {0}, {right}, {}, 9.0}}};
  entry.results[0].numbers = numbers_in_share("room", 1, 1.0, room.size());
  for (const char outcome : room)
    entry.results[0].starts.push_back(
        start_result(outcome == 'r'   ? Outcome::right
                     : outcome == 'w' ? Outcome::wrong
                                      : Outcome::undecided,
                     7, 1.0, outcome == 'u' ? std::nullopt : std::optional(PoseError{0.5, 0.0})));
  return entry;
}

TEST(BoardPage, HasCountsWithIntervalsTheBestFirst) {
  const Json page =
      board_page({{suite_of("small", 4), {entry_of("mine", "rwwu"), entry_of("yours", "rrru")}}}, {}).head;
  EXPECT_EQ(page["methods"], Json({"yours", "mine"}));
  const Json& suite = page["suites"][0];
  EXPECT_EQ(suite["suite"], "small@1");
  EXPECT_EQ(suite["cases"], Json({"room", "hall"}));
  EXPECT_EQ(suite["entries"][0]["method"], "yours");
  const Json& mine = suite["entries"][1];
  EXPECT_EQ(mine["all"]["starts"], 5);
  EXPECT_EQ(mine["all"]["wrong"], 2);
  EXPECT_EQ(mine["all"]["right"], 2);
  EXPECT_EQ(mine["all"]["undecided"], 1);
  // Wilson's interval of 2 of 5, by his formula.
  EXPECT_EQ(mine["all"]["wrong_rate"]["value"], 0.4);
  EXPECT_NEAR(mine["all"]["wrong_rate"]["low"], 0.1176, 1e-4);
  EXPECT_NEAR(mine["all"]["wrong_rate"]["high"], 0.7693, 1e-4);
  EXPECT_EQ(mine["cases"][0]["right"], 1);
  EXPECT_EQ(mine["cases"][1]["right"], 1);
  // Four of the five starts have steps of 1.5 ms.
  EXPECT_EQ(mine["step_ms"], 1.5);
  EXPECT_EQ(mine["imported"], false);
  EXPECT_EQ(mine["results"][0],
            Json::parse(R"({"case": "room", "seed": 1, "ms": 1.5, "outcome": "rwwu", "steps": [7, 7, 7, 7],
                            "cm": [50, 50, 50, null], "deg": [0, 0, 0, null]})"));
}

TEST(BoardPage, HasTheHistoryOfItsEntriesAlone) {
  const auto renewal = [](const std::string& suite, std::size_t right) {
    return Renewal{"2026-11-24", "v1", suite, "mine", {.starts = 100, .right = right, .wrong = 0}};
  };
  const Json page = board_page({{suite_of("small", 1), {entry_of("mine", "r"), entry_of("yours", "r")}}},
                               {renewal("small@1", 20), renewal("large@1", 3), renewal("small@1", 80),
                                renewal("small@1", 81)})
                        .head;
  const Json& entries = page["suites"][0]["entries"];
  const Json& mine = entries[0]["renewals"];
  ASSERT_EQ(mine.size(), 3U);
  EXPECT_EQ(mine[0]["right"], 20);
  EXPECT_FALSE(mine[0].contains("p_right"));
  EXPECT_EQ(mine[1]["significant"], true);
  EXPECT_EQ(mine[2]["significant"], false);
  EXPECT_EQ(mine[2]["p_right"], 1.0);
  EXPECT_TRUE(entries[1]["renewals"].empty());
}

TEST(BoardPage, SharesSayWhichStartsTheyHave) {
  BoardEntry entry = entry_of("mine", "ru");
  entry.share = 0.5;
  entry.results[0].numbers = {1, 3};
  const Json page = board_page({{suite_of("small", 4), {entry, entry_of("yours", "rruu")}}}, {}).head;
  const Json& entries = page["suites"][0]["entries"];
  EXPECT_EQ(entries[0]["label"], "mine (share 0.5)");
  EXPECT_EQ(entries[0]["results"][0]["numbers"], Json({1, 3}));
  EXPECT_EQ(entries[1]["label"], "yours");
  EXPECT_FALSE(entries[1]["results"][0].contains("numbers"));
}

TEST(BoardPage, WhatProvenanceSaysOtherwiseIsLeftOut) {
  BoardEntry entry = entry_of("</script>", "r");
  entry.provenance = {{"cpu", 7}, {"imported_sha256", "00"}};
  const Json page = board_page({{suite_of("small", 1), {entry}}}, {}).head;
  EXPECT_EQ(page["suites"][0]["entries"][0]["cpu"], "");
  EXPECT_EQ(page["suites"][0]["entries"][0]["imported"], true);
}

TEST(BoardPage, OfTenMethodsOnFourSuitesIsSmall) {
  Rng rng(1);
  const auto below = [&](double limit) { return limit * rng.uniform(); };
  std::vector<SuiteBoard> boards;
  for (int s = 0; s < 4; ++s) {
    SuiteBoard& board = boards.emplace_back();
    board.suite = suite_of("suite" + std::to_string(s), 5000);
    for (int m = 0; m < 10; ++m) {
      BoardEntry& entry =
          board.entries.emplace_back(entry_of("method" + std::to_string(m), std::string(5000, 'u')));
      for (StartResult& start : entry.results[0].starts) {
        if (below(1.0) < 0.9)
          start = start_result(Outcome::right, 2 + static_cast<std::size_t>(below(60.0)), 0.0,
                               PoseError{below(0.1), below(0.02)});
      }
    }
  }
  const std::string page = page_with(board_text, "Leaderboard", board_page(boards, {}));
  EXPECT_LT(page.size(), 3'000'000U);
  EXPECT_EQ(page, page_with(board_text, "Leaderboard", board_page(boards, {})));
  EXPECT_EQ(data_in(page).head["suites"].size(), 4U);
}

}  // namespace
}  // namespace glocal::test::board_page_test
