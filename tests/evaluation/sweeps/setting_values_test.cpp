// The same choice of a strategy, written in different ways.
#include "evaluation/sweeps/setting_values.hpp"

#include <gmock/gmock.h>

namespace glocal::test::setting_values_test {
namespace {

using testing::ElementsAre;
using testing::Pair;

const std::map<std::string, Setting>& nothing() {
  static const std::map<std::string, Setting> none;
  return none;
}

SettingValues values_of(const SettingValues& written) {
  return comparable_values({{written, &nothing()}}).front();
}

TEST(SettingValues, AStrategyIsAValueHoweverItIsWritten) {
  EXPECT_THAT(values_of({{"localizer.clusterer", "dbscan"}}),
              ElementsAre(Pair("localizer.clusterer", "dbscan")));
  const auto both =
      ElementsAre(Pair("localizer.clusterer", "dbscan"), Pair("localizer.clusterer.dbscan.radius", "0.5"));
  EXPECT_THAT(values_of({{"localizer.clusterer", "{dbscan: {radius: 0.5}}"}}), both);
  EXPECT_THAT(values_of({{"localizer.clusterer.dbscan.radius", "0.5"}}), both);
  EXPECT_THAT(values_of({{"trials.max_steps", "9"}, {"method", "mine"}}),
              ElementsAre(Pair("trials.max_steps", "9"), Pair("method", "mine")));
}

TEST(SettingValues, WhoLeavesAChoiceAloneHasWhatItWasRunWith) {
  const std::map<std::string, Setting> effective = {
      {"localizer.clusterer.hierarchical_kmeans.max_iterations", {"10", "10"}},
      {"localizer.rater", {"ratio", "ratio"}}};
  const auto values = comparable_values(
      {{{{"localizer.clusterer", "dbscan"}}, &nothing()}, {{{"trials.max_steps", "9"}}, &effective}});
  EXPECT_THAT(values[0], ElementsAre(Pair("localizer.clusterer", "dbscan")));
  EXPECT_THAT(values[1],
              ElementsAre(Pair("trials.max_steps", "9"), Pair("localizer.clusterer", "hierarchical_kmeans")));
}

TEST(SettingValues, WhoLeavesAParameterAloneHasItsDefaultIfItHasIt) {
  const std::map<std::string, Setting> ransam = {
      {"localizer.matcher.ransam.iterations", {"200000", "200000"}}, {"trials.max_steps", {"15", "15"}}};
  const std::map<std::string, Setting> indexed = {
      {"localizer.matcher.indexed_ransam.candidates", {"64", "64"}}, {"trials.max_steps", {"15", "15"}}};
  const auto values = comparable_values({{{}, &ransam},
                                         {{{"localizer.matcher.ransam.iterations", "20000"}}, &ransam},
                                         {{{"localizer.matcher", "indexed_ransam"}}, &indexed}});
  EXPECT_THAT(values[0], ElementsAre(Pair("localizer.matcher", "ransam"),
                                     Pair("localizer.matcher.ransam.iterations", "200000")));
  EXPECT_THAT(values[1], ElementsAre(Pair("localizer.matcher", "ransam"),
                                     Pair("localizer.matcher.ransam.iterations", "20000")));
  EXPECT_THAT(values[2], ElementsAre(Pair("localizer.matcher", "indexed_ransam")));
}

}  // namespace
}  // namespace glocal::test::setting_values_test
