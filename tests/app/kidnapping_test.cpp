// A robot that is carried away in mid-drive: the whole pipeline notices, and finds it again.
#include <gtest/gtest.h>

#include <cmath>

#include "app/room.hpp"

namespace glocal::test::kidnapping_test {
namespace {

class Kidnapping : public CommandLine {};

TEST_F(Kidnapping, TakesTheVerdictBackAndFindsTheRobotAgain) {
  good(
      run("run " GLOCAL_SOURCE_DIR "/configs/experiments/sim_kidnapped.yaml --quiet --out results"
          " --set output.maps=none --set observations.simulation.tour_legs=22"
          " --set 'observations.simulation.kidnappings=[{after_m: 40, to: [25.6, 4.0], heading_deg: -60}]'"));

  Json before;
  bool is_carried_away = false;
  bool was_localized = false;
  int wrong = 0;
  int since = 0;
  int found_after = -1;
  for (const Json& step : json_lines("results/steps.jsonl")) {
    const auto& reference = step["reference"];
    if (!before.is_null()) {
      const auto& last = before["reference"];
      const double moved = std::hypot(reference["x"].get<double>() - last["x"].get<double>(),
                                      reference["y"].get<double>() - last["y"].get<double>());
      if (moved > 1.0) is_carried_away = true;
    }
    before = step;
    const bool is_localized = step["verdict"] == "localized";
    if (!is_carried_away) {
      was_localized = was_localized || is_localized;
      continue;
    }
    ++since;
    if (!is_localized) continue;
    if (step["translation_error_m"].get<double>() > 0.5) {
      ++wrong;
    } else if (found_after < 0) {
      found_after = since;
    }
  }
  EXPECT_TRUE(was_localized);
  ASSERT_TRUE(is_carried_away);
  EXPECT_LE(wrong, 2);  // A single observation may be a person in the way.
  EXPECT_GT(found_after, 2);
  EXPECT_LT(found_after, 60);
}

}  // namespace
}  // namespace glocal::test::kidnapping_test
