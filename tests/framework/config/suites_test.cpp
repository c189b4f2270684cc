// Suites: which variants they make, which share of their starts is run, and what is refused.
#include "config/suites.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "files.hpp"
#include "framework/config/toy_catalog.hpp"
#include "glocal/experiment.hpp"

namespace glocal::test::suites_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class SuitesTest : public testing::Test {
 protected:
  SuitesTest() {
    register_toys(catalog_);
    folder_.write("configs/cases/map.txt", "a map");
    folder_.write("configs/methods/fast.yaml", "localizer: {matcher: {ransam: {iterations: 7}}}\n");
    folder_.write("configs/cases/room.yaml",
                  "map: {toy_map: {path: map.txt}}\nobservations: toy_drive\ntrials: {every_m: 6}\n");
    ::setenv("GLOCAL_CONFIGS", (folder_ / "configs").c_str(), 1);
  }
  ~SuitesTest() override { ::unsetenv("GLOCAL_CONFIGS"); }

  void write_suite(const std::string& text) const { folder_.write("configs/suites/small.yaml", text); }

  /// Two cases with three seeds, of which one has 40 starts.
  void write_pinned() const {
    write_suite(fmt::format(
        "version: 2\n"
        "seeds: 1..3\n"
        "cases:\n"
        "  dense: {{extends: room, trials: {{every_m: 2}}}}\n"
        "  room: room\n"
        "pinned:\n"
        "  cases:\n"
        "    dense: {{starts: 40, values: \"{}\"}}\n"
        "    room: {{starts: 2, values: \"{}\"}}\n",
        hash_of("{map: {toy_map: {path: map.txt}}, observations: toy_drive, trials: {every_m: 2}}"),
        hash_of("{map: {toy_map: {path: map.txt}}, observations: toy_drive, trials: {every_m: 6}}")));
  }

  std::vector<Variant> read(const std::string& suite, const std::vector<Override>& more = {}) {
    std::vector<Override> overrides = {{"suite", suite}, {"methods", "[fast]"}};
    overrides.insert(overrides.end(), more.begin(), more.end());
    return read_variants("", overrides, catalog_);
  }

  std::string faults_of(const std::string& suite, const std::vector<Override>& more = {}) {
    return error_of([&] { return read(suite, more); });
  }

  Catalog catalog_;
  TemporaryFolder folder_;
};

TEST_F(SuitesTest, ASuiteIsItsCasesWithItsSeeds) {
  write_suite(
      "version: 1\nseeds: [4, 8]\ncases:\n  dense: {extends: room, trials: {every_m: 2}}\n  room: room\n");
  const auto all = read("small@1");
  std::vector<std::string> names;
  for (const Variant& variant : all) names.push_back(variant.name);
  EXPECT_THAT(names,
              ElementsAre("fast_dense_seed-4", "fast_dense_seed-8", "fast_room_seed-4", "fast_room_seed-8"));
  EXPECT_EQ(all[0].experiment.trials.every_m, 2.0);
  EXPECT_EQ(all[3].experiment.trials.every_m, 6.0);
  EXPECT_EQ(all[0].experiment.name, "small-1");
  EXPECT_EQ(all[0].suite->id(), "small@1");
  EXPECT_TRUE(all[0].experiment.trials.only.empty());
}

TEST_F(SuitesTest, SomeOfItsCasesCanBeChosen) {
  write_pinned();
  const auto some = read("small@2", {{"cases", "[room]"}});
  ASSERT_EQ(some.size(), 3U);
  EXPECT_EQ(some[0].case_name, "room");
  EXPECT_THAT(faults_of("small@2", {{"cases", "[rom]"}}),
              HasSubstr("small@2 has no case 'rom' (did you mean 'room'?)"));
}

TEST_F(SuitesTest, AShareIsTheSameForAllMethodsAndHoldsSmallerOnes) {
  write_pinned();
  folder_.write("configs/methods/slow.yaml", "localizer: {matcher: {ransam: {iterations: 900}}}\n");
  const auto chosen = [&](const std::string& share, const std::string& method) {
    std::set<std::string> starts;
    for (const Variant& variant : read("small", {{"share", share}, {"methods", "[" + method + "]"}})) {
      EXPECT_FALSE(variant.experiment.trials.only.empty()) << "nothing of it is run";
      for (const double start : variant.experiment.trials.only)
        starts.insert(fmt::format("{} {} {}", variant.case_name, variant.experiment.seed, start));
    }
    return starts;
  };
  const auto third = chosen("0.3", "fast");
  EXPECT_EQ(third, chosen("0.3", "slow"));
  // Of 126 starts; four standard deviations are 21.
  EXPECT_GT(third.size(), 17U);
  EXPECT_LT(third.size(), 59U);
  for (const std::string& start : chosen("0.05", "fast")) EXPECT_TRUE(third.contains(start)) << start;
}

TEST_F(SuitesTest, ACaseThatHasChangedIsRefused) {
  write_pinned();
  EXPECT_EQ(faults_of("small@2"), "");
  folder_.write("configs/cases/room.yaml",
                "map: {toy_map: {path: map.txt}}\nobservations: toy_drive\ntrials: {every_m: 7}\n");
  const std::string faults = faults_of("small@2");
  EXPECT_THAT(faults, HasSubstr("the case room is not that of small@2: its values have the hash "));
  EXPECT_THAT(faults, HasSubstr(hash_of("{map: {toy_map: {path: map.txt}}, observations: toy_drive, trials: "
                                        "{every_m: 6}}") +
                                " is pinned"));
  EXPECT_THAT(faults, testing::Not(HasSubstr("the case dense")));
}

TEST_F(SuitesTest, AnotherVersionIsRefused) {
  write_pinned();
  EXPECT_THAT(faults_of("small@1"), HasSubstr("there is no small@1; there is small@2"));
  EXPECT_THAT(faults_of("smal@2"), HasSubstr("unknown suite 'smal' (did you mean 'small'?)"));
}

TEST_F(SuitesTest, WhatASuiteSaysCannotBeSaidAgain) {
  write_pinned();
  EXPECT_THAT(faults_of("small", {{"trials.every_m", "3"}}),
              HasSubstr("trials: small@2 has its own; leave it out"));
  EXPECT_THAT(faults_of("small", {{"seeds", "7"}}), HasSubstr("seeds: small@2 has its own; leave it out"));
  EXPECT_THAT(faults_of("small", {{"share", "1.5"}}), HasSubstr("share: "));
  EXPECT_THAT(faults_of("small", {{"share", "1e-9"}}), HasSubstr("share: 1e-09 of small@2 has no start"));
}

TEST_F(SuitesTest, FaultsOfItsFileAreSaidWhereTheyStand) {
  write_suite("version: 0\ncases: [room]\ncolour: red\npinned:\n  cases: {room: {starts: none}}\n");
  const std::string faults = faults_of("small");
  EXPECT_THAT(faults, HasSubstr("small.yaml:1:10: error: suite: version: "));
  EXPECT_THAT(faults, HasSubstr("small.yaml:3:1: error: suite: unknown key 'colour'"));
  EXPECT_THAT(faults, HasSubstr("small.yaml:5:26: error: suite: starts: "));
  write_suite("version: 1\n");
  EXPECT_THAT(faults_of("small"), HasSubstr("suite: missing key 'cases'"));
}

TEST_F(SuitesTest, AShareNeedsPinnedStarts) {
  write_suite("version: 1\ncases: [room]\n");
  EXPECT_THAT(faults_of("small", {{"share", "0.5"}}), HasSubstr("glocal leaderboard pin tells what to add"));
}

TEST_F(SuitesTest, MoreStartsThanCanBeCountedAreRefused) {
  const auto pinned = [&](const std::string& starts, const std::string& seeds) {
    write_suite(
        fmt::format("version: 1\nseeds: {}\ncases: [room]\npinned:\n  cases:\n    room: {{starts: {}, "
                    "values: \"{}\"}}\n",
                    seeds, starts,
                    hash_of("{map: {toy_map: {path: map.txt}}, observations: toy_drive, trials: "
                            "{every_m: 6}}")));
  };
  pinned("2000000000", "1");
  EXPECT_THAT(faults_of("small", {{"share", "0.5"}}), HasSubstr("starts: 2000000000 is out of range"));
  pinned("1000000", "1..11");
  EXPECT_THAT(faults_of("small", {{"share", "0.5"}}),
              HasSubstr("share: small@1 pins more than five million starts"));
  EXPECT_EQ(faults_of("small"), "");
}

// Of the FNV's authors.
TEST(HashOf, IsFnv1a) {
  EXPECT_EQ(hash_of(""), "cbf29ce484222325");
  EXPECT_EQ(hash_of("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(hash_of("foobar"), "85944171f73967e8");
}

TEST(InputName, IsTheSameOnAllMachines) {
  Suite suite;
  suite.file = "/a/configs/suites/small.yaml";
  ::setenv("GLOCAL_DATASETS", "/data/", 1);
  EXPECT_EQ(input_name(suite, "/data/intel/intel.log.xz"), "data:intel/intel.log.xz");
  EXPECT_EQ(input_name(suite, "/a/configs/cases/../worlds/room.yaml"), "../worlds/room.yaml");
  ::unsetenv("GLOCAL_DATASETS");
}

}  // namespace
}  // namespace glocal::test::suites_test
