#include "evaluation/comparison/comparison_writers.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "evaluation/comparison/comparison_report.hpp"
#include "evaluation/comparison/runs.hpp"

namespace glocal::test::comparison_writers_test {
namespace {

using testing::HasSubstr;
using testing::Not;

std::vector<std::vector<std::string>> cells_of(const std::string& csv) {
  std::vector<std::vector<std::string>> rows;
  std::istringstream lines(csv);
  for (std::string line; std::getline(lines, line);) {
    rows.emplace_back();
    std::istringstream cells(line + ",");
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

TEST(ComparisonCsv, HasARowForEachTest) {
  const Comparison comparison = compare(slow_and_quick(), 0);
  const auto rows = cells_of(to_csv(comparison));
  ASSERT_EQ(rows.size(), 1U + 7U);
  const auto column = [&](const std::string& name) {
    const auto at = std::find(rows[0].begin(), rows[0].end(), name);
    EXPECT_NE(at, rows[0].end()) << name;
    return static_cast<std::size_t>(at - rows[0].begin());
  };
  for (const auto& row : rows) EXPECT_EQ(row.size(), rows[0].size());
  const auto& right = rows[2];
  EXPECT_EQ(right[column("variant")], "quick");
  EXPECT_EQ(right[column("baseline")], "slow");
  EXPECT_EQ(right[column("measure")], "right");
  EXPECT_EQ(right[column("starts")], "30");
  EXPECT_EQ(right[column("places")], "30");
  EXPECT_EQ(right[column("baseline_value")], "21");
  EXPECT_EQ(right[column("variant_value")], "29");
  EXPECT_EQ(right[column("test")], "sign_flips_exact");
  EXPECT_EQ(right[column("differing")], "10");
  EXPECT_EQ(right[column("p")], "0.021484375");
  EXPECT_EQ(right[column("significant")], "true");
  const auto& steps = rows[3];
  EXPECT_EQ(steps[column("measure")], "steps");
  EXPECT_EQ(steps[column("difference")], "-2");
  EXPECT_EQ(steps[column("low")], "-2");
  EXPECT_EQ(steps[column("median_difference")], "-2");
  EXPECT_EQ(steps[column("test")], "wilcoxon_exact");
}

TEST(ComparisonCsv, QuotesNames) {
  std::vector<NamedRun> runs = slow_and_quick();
  runs[1].name = "a \"quick\", one";
  EXPECT_THAT(to_csv(compare(runs, 0)), HasSubstr("\"a \"\"quick\"\", one\",slow,wrong,"));
}

TEST(ComparisonJson, HoldsWhatTheComparisonHolds) {
  const Comparison comparison = compare(slow_and_quick(), 0);
  const nlohmann::ordered_json json = to_json(comparison);
  EXPECT_EQ(json["starts"], 30);
  EXPECT_EQ(json["places"], 30);
  EXPECT_EQ(json["methods"][0]["success_rate"]["value"], 0.7);
  EXPECT_EQ(json["methods"][0]["medians"]["steps"], 19.0);
  EXPECT_EQ(json["methods"][1]["cases"][0]["wrong_points"]["value"], -30.0);
  const auto& pair = json["pairs"][0];
  EXPECT_EQ(pair["variant"], "quick");
  EXPECT_EQ(pair["outcomes"][0]["outcome"], "wrong");
  EXPECT_EQ(pair["outcomes"][0]["only_baseline"], 9);
  EXPECT_EQ(pair["outcomes"][0]["significant"], true);
  EXPECT_EQ(pair["measures"][0]["median_difference"], -2.0);
  EXPECT_EQ(pair["measures"][0]["mean_difference"]["value"], -2.0);
  EXPECT_EQ(pair["measures"][0]["positive_rank_sum"], 0.0);
}

TEST(ComparisonReport, IsTheSameAsTextAndAsMarkdown) {
  std::vector<NamedRun> runs = slow_and_quick();
  runs[1].name = "qu|ck_2";
  runs[1].results.complete = false;
  const Comparison comparison = compare(runs, 0);
  const std::string text = as_text(comparison_report(comparison));
  EXPECT_THAT(text, HasSubstr("1 method compared with slow, by 30 starts: 30 places\n"));
  EXPECT_THAT(text, HasSubstr("  ! qu|ck_2 was interrupted: later trials are missing.\n"));
  EXPECT_THAT(text, HasSubstr("  method   starts      right, %      wrong, %"));
  EXPECT_THAT(text, HasSubstr("  slow         30  70.0 (52-83)  30.0 (17-48)"));
  EXPECT_THAT(text, HasSubstr("qu|ck_2 is better than slow: wrong less often"));
  const std::string markdown = as_markdown(comparison_report(comparison));
  EXPECT_THAT(markdown, HasSubstr("- qu\\|ck\\_2 was interrupted: later trials are missing.\n"));
  EXPECT_THAT(markdown, HasSubstr("| method | starts | right, % | wrong, % |"));
  EXPECT_THAT(markdown, HasSubstr("| slow | 30 | 70.0 (52-83) |"));
  EXPECT_THAT(markdown, HasSubstr("| qu\\|ck\\_2 | 30 |"));
}

TEST(ComparisonReport, MarksOnlyWhatMatters) {
  const auto stars = [](std::size_t wrong) {
    std::vector<TrialResult> first(1000, right_after(10.0));
    std::vector<TrialResult> second = first;
    for (std::size_t i = 0; i < wrong; ++i) second[i].outcome = Outcome::wrong;
    const std::string text =
        as_text(comparison_report(compare({run_of("a", first), run_of("b", second)}, 0)));
    return std::count(text.begin(), text.end(), '*');
  };
  // Besides the sentence that says so: wrong from 1 point on, right from 2. All three are sure.
  EXPECT_EQ(stars(9), 1);
  EXPECT_EQ(stars(11), 2);
  EXPECT_EQ(stars(21), 3);
}

TEST(ComparisonReport, KeepsToTheWidthOfATerminal) {
  std::istringstream lines(as_text(comparison_report(compare(slow_and_quick(), 0))));
  for (std::string line; std::getline(lines, line);) {
    EXPECT_LE(line.size(), 120U) << line;
    EXPECT_THAT(line, Not(testing::EndsWith(" ")));
  }
}

}  // namespace
}  // namespace glocal::test::comparison_writers_test
