// The leaderboard's history: read again as it was written, and what has changed from one renewal to the next.
#include "evaluation/leaderboard/board_history.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "files.hpp"

namespace glocal::test::board_history_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;

Renewal renewal(std::size_t right, std::size_t wrong) {
  return {"2026-11-24", "v1", "small@1", "mine", {.starts = 8, .right = right, .wrong = wrong}};
}

TEST(BoardHistory, ComesBackAsItWasWritten) {
  const TemporaryFolder folder;
  EXPECT_TRUE(read_history(folder.path() / "history.jsonl").empty());
  const std::string text = to_line(renewal(5, 1)) + to_line(renewal(6, 0));
  EXPECT_THAT(text, HasSubstr(R"("starts":8,"right":5,"wrong":1,"undecided":2})"));
  const auto read = read_history(folder.write("history.jsonl", text));
  ASSERT_EQ(read.size(), 2U);
  EXPECT_EQ(to_line(read[0]) + to_line(read[1]), text);
}

TEST(BoardHistory, EachDamagedLineIsNamed) {
  const TemporaryFolder folder;
  const auto file = folder.write("history.jsonl", to_line(renewal(5, 1)) + to_line(renewal(5, 4)) + "{\n");
  // 9 of 8 starts are right or wrong, and half a line.
  EXPECT_THAT(error_of([&] { return read_history(file); }),
              AllOf(HasSubstr("history.jsonl:2: error: is no line of a leaderboard's history (its "
                              "numbers do not add up); leave it out"),
                    HasSubstr("history.jsonl:3: error: ")));
}

// By hand: one division of 8 right among 16 starts in C(16, 8) is as far off either way, and there are 4
// tests.
TEST(BoardHistory, StepsAreTestedTogether) {
  EXPECT_TRUE(steps_between({renewal(0, 0)}).empty());
  const auto steps = steps_between({renewal(0, 0), renewal(8, 0), renewal(7, 1)});
  ASSERT_EQ(steps.size(), 2U);
  EXPECT_NEAR(steps[0].p_right, 4.0 * 2.0 / 12870.0, 1e-9);
  EXPECT_EQ(steps[0].p_wrong, 1.0);
  EXPECT_EQ(steps[1].p_right, 1.0);
}

}  // namespace
}  // namespace glocal::test::board_history_test
