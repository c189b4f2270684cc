// Several maps: on which of them the robot is.
#include <gmock/gmock.h>

#include "app/room.hpp"

namespace glocal::test::floors_test {
namespace {

using testing::HasSubstr;

/// Floors of an office of 20 m x 20 m, of the same rooms with other furniture.
class Floors : public CommandLine {
 protected:
  static std::string office(int furniture) {
    return "{office: {side: 20, length: 40, number: 3, furniture: " + std::to_string(furniture) + "}}";
  }
  void write_floors(const std::string& more) const {
    std::ofstream(file("floors.yaml")) << "schema: 1\nname: floors\nmap:\n  several:\n    maps:\n"
                                       << "      - {name: ground, source: " << office(1) << "}\n"
                                       << "      - {name: first, source: " << office(2) << "}\n"
                                       << "observations:\n  several:\n    drives:\n"
                                       << "      - {map: ground, source: " << office(1) << "}\n"
                                       << "      - {map: first, source: " << office(2) << "}\n"
                                       << more;
  }
  /// Writes something else in place of what stands there.
  void change(const std::string& from, const std::string& to) const {
    std::string text = content(file("floors.yaml"));
    text.replace(text.find(from), from.size(), to);
    std::ofstream(file("floors.yaml")) << text;
  }
  [[nodiscard]] Answer run_floors() const {
    return run("run " + file("floors.yaml") + " --method indexed --quiet --force --out " + file("results"));
  }
};

TEST_F(Floors, EachAnswerNamesItsMapAndThePoseThere) {
  write_floors("trials: {every_m: 8, max_steps: 30}\n");
  good(run_floors());
  std::size_t right = 0, on_first = 0;
  for (const Json& trial : json_lines("results/indexed/trials.jsonl")) {
    EXPECT_NE(trial["outcome"], "wrong");
    if (trial["outcome"] != "right") continue;
    ++right;
    EXPECT_EQ(trial["place"]["map"], trial["start"]["map"]);
    if (trial["place"]["map"] == "ground") {
      EXPECT_EQ(trial["place"]["pose"], trial["pose"]);
      continue;
    }
    ++on_first;
    // Beyond the first map's 20 m and the 40 m of nothing.
    EXPECT_NEAR(trial["pose"]["x"].get<double>() - trial["place"]["pose"]["x"].get<double>(), 60.0, 1.0);
    EXPECT_NEAR(trial["pose"]["y"].get<double>(), trial["place"]["pose"]["y"].get<double>(), 1.0);
  }
  EXPECT_GE(right, 6U);
  EXPECT_GE(on_first, 2U);
}

TEST_F(Floors, ALiftIsFollowed) {
  write_floors("trials: {whole: true}\n");
  change("    drives:\n", "    in_lift: true\n    drives:\n");
  good(run_floors());
  std::set<std::string> declared_on;
  for (const Json& step : json_lines("results/indexed/steps.jsonl")) {
    if (step["verdict"] != "localized") continue;
    declared_on.insert(step["place"]["map"]);
  }
  EXPECT_THAT(declared_on, testing::ElementsAre("first", "ground"));
}

TEST_F(Floors, LocalizeAndLiveTakeMoreMapsThanOne) {
  for (const std::string seed : {"1", "2"}) {
    good(run("simulate --site office --side 20 --length 40 --seed " + seed + " --out floor_" + seed));
  }
  const Answer answer =
      good(run("localize floor_1/map.yaml floor_2/drive.log --also floor_2/map.yaml --out results"));
  EXPECT_THAT(answer.out, HasSubstr("one of 2: "));
  EXPECT_THAT(answer.out, HasSubstr("floor_2/map.yaml: x "));
  EXPECT_THAT(answer.err, HasSubstr("reference poses do not say which of the maps they are on"));
  good(run("convert floor_2/drive.log --out drive.mcap"));
  const Answer live =
      good(run("live floor_1/map.yaml --also floor_2/map.yaml --recording drive.mcap --out live"));
  EXPECT_THAT(live.out, HasSubstr("localized"));
  EXPECT_THAT(live.out, HasSubstr("floor_2/map.yaml: x "));
}

TEST_F(Floors, ReferencesOnAMapThatIsNotThereAreRefused) {
  write_floors("trials: {every_m: 8}\n");
  change("{map: first", "{map: attic");
  EXPECT_THAT(refusal(run_floors()),
              HasSubstr("reference poses are on a map 'attic', and there is only ground, first"));
}

TEST_F(Floors, TwoMapsOfOneNameAreRefused) {
  write_floors("trials: {every_m: 8}\n");
  change("{name: first", "{name: ground");
  const std::string said = refusal(run_floors());
  EXPECT_THAT(said, HasSubstr("floors.yaml:5"));
  EXPECT_THAT(said, HasSubstr("maps[1].name: must not be 'ground' again"));
}

}  // namespace
}  // namespace glocal::test::floors_test
