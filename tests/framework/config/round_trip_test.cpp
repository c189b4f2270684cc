// What is written is read back the same, and written again byte for byte.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>
#include <set>

#include "config/experiment_params.hpp"
#include "config/reader.hpp"
#include "config/scalars.hpp"
#include "config/writer.hpp"
#include "config/yaml_parser.hpp"
#include "framework/config/toy_catalog.hpp"
#include "glocal/error.hpp"
#include "glocal/rng.hpp"
#include "glocal/yaml.hpp"
#include "temporary_folder.hpp"

namespace glocal::test::round_trip_test {
namespace {

class RoundTrip : public testing::Test {
 protected:
  RoundTrip() {
    register_toys(catalog_);
    folder_.write("map.txt", "a map");
  }

  Experiment read(const std::string& name, const std::string& text) {
    return read_experiment(folder_.write(name, text), {}, catalog_);
  }

  Catalog catalog_;
  TemporaryFolder folder_;
};

const std::string rich = R"(schema: 1
name: rich
seed: 18446744073709551615
map:
  toy_map:
    path: map.txt
    segments: [[0.1, 0.30000000000000004], [1e-7, 1]]
    resolution: 1.7976931348623157e308
    walls:
      - {from: [-0.0, 2], height: 5e-324}
      - {}
observations:
  toy_drive:
    label: "  a: 'b' # \"c\"\n\té\\"
    mode: slow
    loop: true
    tags: [plain, "true", "", "~", "12", "- x", no, "1.5e3", 'null', "[a]"]
    extras: ["data:map.txt", map.txt]
    noise:
      range: 0.123456789012345678
trials: {starts_m: [12.5, 80.0], max_steps: 0}
localizer: {matcher: indexed}
)";

TEST_F(RoundTrip, EffectiveYamlIsAFixedPoint) {
  setenv("GLOCAL_DATASETS", folder_.path().c_str(), 1);
  Experiment first = read("a.yaml", rich);
  const std::string written = effective_yaml(first, catalog_);
  const TemporaryFolder elsewhere;  // Relative paths have become absolute, so that the file may be anywhere.
  const auto file = elsewhere.write("effective.yaml", written);
  Experiment second = read_experiment(file, {}, catalog_);
  EXPECT_EQ(effective_yaml(second, catalog_), written);
  unsetenv("GLOCAL_DATASETS");

  const auto& a = dynamic_cast<const ParamsOf<ToyDrive::Params>&>(*first.observations.params).value;
  const auto& b = dynamic_cast<const ParamsOf<ToyDrive::Params>&>(*second.observations.params).value;
  EXPECT_EQ(a.label, "  a: 'b' # \"c\"\n\t\xC3\xA9\\");
  EXPECT_EQ(b.label, a.label);
  EXPECT_EQ(b.tags, a.tags);
  EXPECT_THAT(b.tags,
              testing::ElementsAre("plain", "true", "", "~", "12", "- x", "no", "1.5e3", "null", "[a]"));
  EXPECT_EQ(b.extras[0].text, "data:map.txt");
  EXPECT_EQ(b.extras[0].resolved, folder_.path() / "map.txt");
  EXPECT_EQ(b.extras[1].resolved, folder_.path() / "map.txt");
  EXPECT_EQ(b.noise.range, 0.123456789012345678);
  const auto& map = dynamic_cast<const ParamsOf<ToyMap::Params>&>(*second.map.params).value;
  EXPECT_EQ(map.resolution, std::numeric_limits<double>::max());
  ASSERT_EQ(map.walls.size(), 2U);
  EXPECT_EQ(map.walls[0].height, std::numeric_limits<double>::denorm_min());
  EXPECT_TRUE(std::signbit(map.walls[0].from[0]));
  EXPECT_EQ(map.walls[1].height, 2.5);
  EXPECT_EQ(second.seed, std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(second.trials.max_steps, 0);
}

TEST_F(RoundTrip, EffectiveYamlHasEveryValue) {
  Experiment e = read("a.yaml",
                      "schema: 1\nname: toy\nmap: {toy_map: {path: map.txt}}\nobservations: toy_drive\n"
                      "trials: {whole: true}\n");
  const std::string expected = R"(schema: 1
name: toy
seed: 1
threads: 1
plugins: []
map:
  toy_map:
    path: ")" + (folder_.path() / "map.txt").string() +
                               R"("
    segments: [[0, 1]]
    resolution: 0.05
    walls: []
observations:
  toy_drive:
    min_range: 0.1
    max_range: 20
    label: plain
    mode: fast
    loop: false
    salt: 7
    tags: [a]
    extras: []
    optional_file: ""
    noise:
      range: 0.01
      beams: 8
trials:
  every_m: 0
  starts_m: []
  every_scan: 0
  whole: true
  max_steps: 60
  min_steps: 1
  within_map_m: 0
  only: []
localizer:
  motion: planar
  contact_epsilon: auto
  looks_per_step: 0
  prior:
    region:
      x: auto
      y: auto
      radius: auto
    heading:
      deg: auto
      width_deg: auto
  local_mapper: scan_matching
  matcher:
    ransam:
      iterations: 200000
      contact_epsilon: 0.1
      patience: auto
  clusterer: hierarchical_kmeans
  rater: cluster_rating
  threshold_policy: sliding_window
  verdict_rule: consecutive_rating
  verifier: none
  unknown_place:
)";
  const std::string written = effective_yaml(e, catalog_);
  const auto comment_end = written.find('\n') + 1;
  EXPECT_TRUE(written.starts_with("# "));
  EXPECT_EQ(written.substr(comment_end, expected.size()), expected);
  EXPECT_THAT(written,
              testing::EndsWith(
                  "evaluation:\n  max_translation_error: 0.5\n  max_rotation_error_deg: 10\n"
                  "output:\n  steps: true\n  trajectories: true\n  clusters: 50\n  maps: first_trial\n"));
}

TEST_F(RoundTrip, EachPartOfAnExperimentHasRandomNumbersOfItsOwn) {
  Experiment e;
  std::set<std::uint64_t> seeds;
  for (e.seed = 0; e.seed < 1000; ++e.seed) {
    seeds.insert(e.seed);
    for (const auto part : {RandomPart::map_source, RandomPart::observation_source, RandomPart::localizer})
      seeds.insert(seed_of(part, e));
  }
  EXPECT_EQ(seeds.size(), 4000U);
  EXPECT_EQ(seed_of(RandomPart::localizer, e), seed_of(RandomPart::localizer, e));
}

TEST_F(RoundTrip, WhatFollowsFromTheMapIsAComment) {
  const std::string given =
      "schema: 1\nname: toy\nmap: {toy_map: {path: map.txt}}\nobservations: toy_drive\n"
      "trials: {whole: true}\n";
  Experiment e = read("e.yaml", given);
  MapData data;
  data.grid.resolution = 0.03;
  const GlobalMap map(std::move(data));
  const std::string written = effective_yaml(e, catalog_, map);
  EXPECT_THAT(written,
              testing::HasSubstr(
                  "\nlocalizer:\n  motion: planar\n  contact_epsilon: auto  # 0.06 m here, twice the map's "
                  "resolution\n  looks_per_step: 0\n  prior:\n"));
  Experiment again = read("again.yaml", written);
  EXPECT_EQ(effective_yaml(again, catalog_), effective_yaml(e, catalog_));
  e.localizer.contact_epsilon = 0.05;
  EXPECT_EQ(effective_yaml(e, catalog_, map), effective_yaml(e, catalog_));
}

TEST_F(RoundTrip, ListItemsOfStructsAreBlocks) {
  ParamsOf<ToyMap::Params> params;
  params.value.walls.resize(2);
  params.value.walls[1].height = 3.0;
  EXPECT_THAT(write_yaml(params), testing::EndsWith("walls:\n  - from: [0, 0]\n    height: 2.5\n"
                                                    "  - from: [0, 0]\n    height: 3\n"));
}

TEST_F(RoundTrip, RandomNumbersComeBackExactly) {
  Rng rng(1);
  YamlNode node = make_node(NodeKind::scalar, {});
  for (int i = 0; i < 10000; ++i) {
    const double value = std::ldexp(rng.uniform(-1.0, 1.0), static_cast<int>(rng.below(2000)) - 1000);
    node.text = to_yaml(value);
    double read = 0.0;
    EXPECT_EQ(take_value(node, {.doc = ""}, read), std::nullopt) << node.text;
    EXPECT_EQ(read, value) << node.text;
  }
}

TEST_F(RoundTrip, ReadYamlFillsAStructAndKnowsItsFolder) {
  const auto file = folder_.write(
      "map.yaml", "\xEF\xBB\xBFpath: 'map.txt' # é\r\nresolution: +1.5\r\nwalls: [{height: 4.}]\r\n");
  ParamsOf<ToyMap::Params> params;
  read_yaml(file, params);
  EXPECT_EQ(params.value.path.resolved, folder_.path() / "map.txt");
  EXPECT_EQ(params.value.resolution, 1.5);
  ASSERT_EQ(params.value.walls.size(), 1U);
  EXPECT_EQ(params.value.walls[0].height, 4.0);
  EXPECT_THROW(read_yaml(folder_.write("bad.yaml", "path: map.txt\nresolution: 0\n"), params), ConfigError);
}

TEST_F(RoundTrip, QuotesAreFoundBehindLettersOfSeveralBytesAndCarriageReturns) {
  std::vector<Fault> faults;
  const auto tree =
      parse_yaml("\xEF\xBB\xBFk\xC3\xA9y: \"\xE2\x82\xAC\\\"\"\r\nb: 'it''s'\r\n\"c\": '\xC3\xA9'",
                 origin_of("x"), faults);
  EXPECT_TRUE(faults.empty()) << to_string(faults.front());
  ASSERT_TRUE(tree);
  EXPECT_EQ(tree->entries.at(0).value.text, "\xE2\x82\xAC\"");
  EXPECT_EQ(tree->entries.at(1).value.text, "it's");
  EXPECT_EQ(tree->entries.at(2).value.text, "\xC3\xA9");
}

}  // namespace
}  // namespace glocal::test::round_trip_test
