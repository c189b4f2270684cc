#include "config/disturbed_cases.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "config/writer.hpp"
#include "config/yaml_parser.hpp"
#include "glocal/error.hpp"

namespace glocal::test::disturbed_cases_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

YamlNode tree_of(const std::string& text) {
  std::vector<Fault> faults;
  return *parse_yaml(text, std::make_shared<const Origin>(Origin{"e.yaml", "."}), faults);
}

ExperimentPart part_of(const std::string& name, const std::string& text, CaseRole role) {
  YamlNode tree = tree_of(text);
  const Place place = tree.place;
  return {name, place, std::move(tree), role, true};
}

std::vector<ExperimentPart> rooms() {
  const char* const room = "map: plan\nobservations: {drive: {speed: 2}}\ntrials: {every_m: 6}\n";
  return {part_of("room", room, CaseRole::choose), part_of("hall", room, CaseRole::judge)};
}

std::string faults_of(const std::string& written, std::vector<ExperimentPart> cases = rooms()) {
  std::vector<Fault> faults;
  add_disturbed_cases(tree_of(written), cases, faults);
  std::string all;
  for (const Fault& fault : faults) all += to_string(fault) + "\n";
  return all;
}

TEST(DisturbedCases, FollowThoseThatTheyDisturb) {
  std::vector<ExperimentPart> cases = rooms();
  std::vector<Fault> faults;
  add_disturbed_cases(tree_of("map: {taken: 5}\nobservations: {noise: 1..2, people: [3]}\n"), cases, faults);
  EXPECT_THAT(faults, testing::IsEmpty());
  std::vector<std::string> names;
  for (const ExperimentPart& part : cases) names.push_back(part.name);
  EXPECT_THAT(names, ElementsAre("room", "room_taken-5", "room_noise-1", "room_noise-2", "room_people-3",
                                 "hall", "hall_taken-5", "hall_noise-1", "hall_noise-2", "hall_people-3"));
  EXPECT_EQ(flow_yaml(cases[0].tree), flow_yaml(rooms()[0].tree));
  EXPECT_EQ(flow_yaml(cases[1].tree),
            flow_yaml(tree_of("map: {disturbed: {source: plan, by: [{kind: taken, level: 5}]}}\n"
                              "observations: {drive: {speed: 2}}\ntrials: {every_m: 6}\n")));
  EXPECT_EQ(flow_yaml(cases[3].tree),
            flow_yaml(tree_of("map: plan\nobservations: {disturbed: {source: {drive: {speed: 2}}, "
                              "by: [{kind: noise, level: 2}]}}\ntrials: {every_m: 6}\n")));
  EXPECT_EQ(cases[4].role, CaseRole::choose);
  EXPECT_EQ(cases[9].role, CaseRole::judge);
  for (const ExperimentPart& part : cases) EXPECT_FALSE(part.is_fixed) << "several, so names tell them apart";
}

TEST(DisturbedCases, FaultsAreSaidWhereTheyStand) {
  EXPECT_THAT(
      faults_of("people: 3\n"),
      HasSubstr("e.yaml:1:1: error: disturbances: unknown key 'people'; there are map and observations"));
  EXPECT_THAT(faults_of("[people]\n"), HasSubstr("disturbances: expected `map: {KIND: levels}`"));
  EXPECT_THAT(faults_of("map: taken\n"),
              HasSubstr("disturbances: map: expected {KIND: levels}, got 'taken'"));
  EXPECT_THAT(faults_of("map: {taken: much}\n"), HasSubstr("e.yaml:1:14: error: disturbances: "));
  EXPECT_THAT(faults_of("map: {taken: 3..1}\n"), HasSubstr("disturbances: 3..1 runs backwards; write 1..3"));
  EXPECT_THAT(faults_of("map: {taken: 3}\n", {}), HasSubstr("there are no cases to disturb"));
  EXPECT_THAT(faults_of("map: {taken: 3}\n", {part_of("room", "observations: drive\n", CaseRole::none)}),
              HasSubstr("the case room has no map of its own"));
}

}  // namespace
}  // namespace glocal::test::disturbed_cases_test
