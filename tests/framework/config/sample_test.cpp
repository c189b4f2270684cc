// variants.sample: how points fill their ranges, and every fault at its place.
#include "config/sample.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "files.hpp"
#include "framework/config/toy_catalog.hpp"
#include "glocal/experiment.hpp"

namespace glocal::test::sample_test {
namespace {

using testing::ElementsAre;

const std::string iterations = "localizer.matcher.ransam.iterations";
const std::string epsilon = "localizer.matcher.ransam.contact_epsilon";

class SampleTest : public testing::Test {
 protected:
  SampleTest() {
    register_toys(catalog_);
    folder_.write("map.txt", "a map");
  }

  /// The sample begins in line 7 of the file.
  std::vector<Variant> read(const std::string& sample) {
    return read_variants(folder_.write("e.yaml",
                                       "schema: 1\n"
                                       "name: toy\n"
                                       "map: {toy_map: {path: map.txt}}\n"
                                       "observations: toy_drive\n"
                                       "trials: {every_m: 6}\n"
                                       "variants:\n"
                                       "  sample: " +
                                           sample),
                         {}, catalog_);
  }

  std::vector<std::string> faults_of(const std::string& sample) {
    return config_faults(folder_.path(), [&] { return read(sample); });
  }

  /// How often each value was drawn for a path.
  static std::map<std::string, int> counts(const std::vector<Variant>& variants, const std::string& path) {
    std::map<std::string, int> counts;
    for (const Variant& variant : variants) {
      for (const auto& [changed, value] : variant.values) {
        if (changed == path) ++counts[value];
      }
    }
    return counts;
  }

  static std::vector<double> numbers(const std::vector<Variant>& variants, const std::string& path) {
    std::vector<double> all;
    for (const auto& [value, n] : counts(variants, path))
      all.insert(all.end(), static_cast<std::size_t>(n), std::stod(value));
    return all;
  }

  Catalog catalog_;
  TemporaryFolder folder_;
};

TEST_F(SampleTest, PointsHaveNumbersForNames) {
  const auto all = read("{count: 12, ranges: {" + iterations + ": [10, 500000]}}\n");
  ASSERT_EQ(all.size(), 12U);
  EXPECT_EQ(all[0].name, "sample-0001");
  EXPECT_EQ(all[11].name, "sample-0012");
  EXPECT_EQ(all[3].setting, "sample-0004");
  EXPECT_EQ(read("{count: 10000, ranges: {" + iterations + ": [10, 500000]}}\n").back().name, "sample-10000");
}

TEST_F(SampleTest, SobolPointsFillEachRangeEvenly) {
  for (const char* seed : {"1", "2", "18446744073709551615"}) {
    const auto all = read(fmt::format(
        "{{count: 64, seed: {}, ranges: {{{}: [5, 68], {}: [0.5, 64.5], observations.toy_drive.mode: "
        "{{choices: [fast, slow]}}, observations.toy_drive.salt: {{from: 1, to: 255, scale: log}}}}}}\n",
        seed, iterations, epsilon));
    // As many whole numbers as points: each of them once.
    const auto whole = counts(all, iterations);
    EXPECT_EQ(whole.size(), 64U);
    EXPECT_TRUE(whole.contains("5") && whole.contains("68"));
    std::map<int, int> parts;
    for (const double number : numbers(all, epsilon)) ++parts[static_cast<int>(std::floor(number - 0.5))];
    EXPECT_EQ(parts.size(), 64U);
    EXPECT_EQ(counts(all, "observations.toy_drive.mode"),
              (std::map<std::string, int>{{"fast", 32}, {"slow", 32}}));
    // On a scale of ratios, each of the 8 doublings from 1 to 256 is as likely.
    std::map<int, int> doublings;
    for (const double number : numbers(all, "observations.toy_drive.salt"))
      ++doublings[static_cast<int>(std::log2(number))];
    EXPECT_EQ(doublings,
              (std::map<int, int>{{0, 8}, {1, 8}, {2, 8}, {3, 8}, {4, 8}, {5, 8}, {6, 8}, {7, 8}}));
  }
}

TEST_F(SampleTest, SobolPointsAreThePublishedOnes) {
  // The output of Joe's and Kuo's own program for 10 points in 3 dimensions
  // (https://web.maths.unsw.edu.au/~fkuo/sobol), in sixteenths.
  constexpr std::array<std::array<int, 3>, 10> published = {{{0, 0, 0},
                                                             {8, 8, 8},
                                                             {12, 4, 4},
                                                             {4, 12, 12},
                                                             {6, 6, 10},
                                                             {14, 14, 2},
                                                             {10, 2, 14},
                                                             {2, 10, 6},
                                                             {3, 5, 15},
                                                             {11, 13, 7}}};
  const std::string sixteen = "{choices: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16]}";
  const std::array<std::string, 3> paths = {iterations, epsilon, "observations.toy_drive.salt"};
  const auto all = read(fmt::format("{{count: 10, ranges: {{{}: {}, {}: {}, {}: {}}}}}\n", paths[0], sixteen,
                                    paths[1], sixteen, paths[2], sixteen));
  for (std::size_t d = 0; d < 3; ++d) {
    const auto part = [&](std::size_t i) { return std::stoi(all.at(i).values.at(d).second) - 1; };
    // The shift of digits is the same for all points, and the first is the corner.
    for (std::size_t i = 0; i < 10; ++i)
      EXPECT_EQ(part(i) ^ part(0), published.at(i).at(d)) << i << ", " << d;
  }
}

TEST_F(SampleTest, RandomPointsFillTheRangesToo) {
  const auto all = read("{count: 4000, sobol: false, ranges: {" + iterations + ": [1, 4], " + epsilon +
                        ": {from: 0.01, to: 1, scale: log}}}\n");
  for (const auto& [value, n] : counts(all, iterations)) {
    // A standard deviation is 27.
    EXPECT_NEAR(n, 1000, 110) << value;
  }
  const auto below = [numbers = numbers(all, epsilon)](double limit) {
    return std::count_if(numbers.begin(), numbers.end(), [&](double x) { return x < limit; });
  };
  EXPECT_EQ(below(0.01), 0);
  EXPECT_NEAR(static_cast<double>(below(0.1)), 2000, 127);
  EXPECT_EQ(below(1.0001), 4000);
}

TEST_F(SampleTest, TheSeedDecidesAndOthersArePointsOfTheirOwn) {
  const auto values = [&](const std::string& how) {
    std::vector<std::string> all;
    for (const Variant& variant : read(fmt::format("{{{}, ranges: {{{}: [0.01, 1]}}}}\n", how, epsilon)))
      all.push_back(variant.values.front().second);
    return all;
  };
  for (const std::string sobol : {"sobol: true, ", "sobol: false, "}) {
    const auto eight = values(sobol + "count: 8");
    EXPECT_EQ(values(sobol + "count: 8, seed: 1"), eight);
    EXPECT_NE(values(sobol + "count: 8, seed: 2"), eight);
    // More points leave the first ones as they are.
    auto more = values(sobol + "count: 20");
    more.resize(8);
    EXPECT_EQ(more, eight);
  }
}

TEST_F(SampleTest, NumbersAreShortAndStayInTheirRange) {
  for (const Variant& variant : read("{count: 200, ranges: {" + epsilon + ": [0.12345678, 0.12345687]}}\n")) {
    const std::string& text = variant.values.front().second;
    EXPECT_THAT(text, testing::AnyOf("0.12345678", "0.12345687")) << "six digits, and not outside";
  }
  for (const Variant& variant : read("{count: 50, ranges: {" + epsilon + ": [0.1, 0.9]}}\n"))
    EXPECT_LE(variant.values.front().second.size(), 8U);
}

TEST_F(SampleTest, BadRangesAreRefusedAtTheirPlace) {
  EXPECT_THAT(
      faults_of(
          "{count: 4, ranges: {\n" + iterations + ": [5, 5],\n" +
          "localizer.contact_epsilon: {from: 0.1, to: 0.05},\n" + "observations.toy_drive.salt: [1.5, 7],\n" +
          "observations.toy_drive.noise.range: {from: 0, to: 1, scale: log},\n" +
          "observations.toy_drive.noise.beams: {from: 1, scale: ln, step: 3},\n" +
          "observations.toy_drive.label: [1, 2],\n" + "observations.toy_drive.loop: {choices: []},\n" +
          "observations.toy_drive.mode: {choices: [fast], from: 1},\n" + "trials.every_m: [1, 2, 3],\n" +
          "threads: 5,\n" + epsilon + ": [0, 1],\n" + "seeds: [1, 2]}}\n"),
      ElementsAre(
          "e.yaml:8:42: error: variants.sample: " + iterations + ": to: must be above from",
          "e.yaml:9:44: error: variants.sample: localizer.contact_epsilon: to: must be above from",
          "e.yaml:10:31: error: variants.sample: observations.toy_drive.salt: from: 1.5 is not a whole "
          "number; write it without point and exponent",
          "e.yaml:11:44: error: variants.sample: observations.toy_drive.noise.range: from: must be above 0 "
          "where the scale is log",
          "e.yaml:12:37: error: variants.sample: observations.toy_drive.noise.beams: missing key 'to': an "
          "end of the range",
          "e.yaml:12:54: error: variants.sample: observations.toy_drive.noise.beams: scale: 'ln' is not one "
          "of linear, log",
          "e.yaml:12:58: error: variants.sample: observations.toy_drive.noise.beams: unknown key 'step' "
          "(known keys: from, to, scale)",
          "e.yaml:13:31: error: variants.sample: observations.toy_drive.label: expected {choices: [a, b]}, "
          "as the values are not numbers (text)",
          "e.yaml:14:40: error: variants.sample: observations.toy_drive.loop: choices: expected a list of "
          "values, got 0 items",
          "e.yaml:15:48: error: variants.sample: observations.toy_drive.mode: choices stand alone; leave "
          "'from' out",
          "e.yaml:16:17: error: variants.sample: trials.every_m: expected [from, to], {from: a, to: b, "
          "scale: log} or {choices: [a, b]}, got 3 items",
          "e.yaml:17:10: error: variants.sample: threads: expected [from, to], {from: a, to: b, scale: log} "
          "or {choices: [a, b]}, got '5'",
          "e.yaml:18:44: error: variants.sample: " + epsilon + ": from: 0 is out of range, must be > 0 m",
          "e.yaml:19:1: error: variants.sample: 'seeds' is the same for all variants and cannot be changed"));
}

TEST_F(SampleTest, CountAndRangesBelongTogetherAndHaveLimits) {
  EXPECT_THAT(faults_of("{count: 4}\n"),
              ElementsAre("e.yaml:7:11: error: variants.sample: count and ranges must be given together"));
  EXPECT_THAT(faults_of("{ranges: {threads: [1, 2]}}\n"),
              ElementsAre("e.yaml:7:11: error: variants.sample: count and ranges must be given together"));
  EXPECT_THAT(
      faults_of("{count: 10001, ranges: {threads: [1, 2]}}\n"),
      ElementsAre(
          "e.yaml:7:19: error: variants.sample: count: 10001 is out of range, must be >= 0 and <= 10000"));
  std::string ranges;
  for (int i = 0; i < 3668; ++i) ranges += (i == 0 ? "a" : ", a") + std::to_string(i) + ": [0, 1]";
  EXPECT_THAT(faults_of("{count: 3, ranges: {" + ranges + "}}\n"),
              ElementsAre("e.yaml:7:30: error: variants.sample: 3668 ranges, but Sobol's sequence has at "
                          "most 3667 dimensions here; leave some out, or draw at random with sobol: false"));
  EXPECT_THAT(faults_of("{count: 1, ranges: {nowhere.at_all: [0, 1]}}\n"),
              ElementsAre(testing::HasSubstr("e.yaml:7:31: error: unknown key 'nowhere'")));
}

}  // namespace
}  // namespace glocal::test::sample_test
