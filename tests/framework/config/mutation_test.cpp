// Damaged files end in faults or in an experiment, never in anything else.
#include <gtest/gtest.h>

#include <algorithm>
#include <string>

#include "config/overrides.hpp"
#include "config/reader.hpp"
#include "config/yaml_parser.hpp"
#include "framework/config/toy_catalog.hpp"
#include "glocal/rng.hpp"
#include "temporary_folder.hpp"

namespace glocal::test::mutation_test {
namespace {

class Mutation : public testing::Test {
 protected:
  Mutation() {
    register_toys(catalog_);
    folder_.write("map.txt", "a map");
  }

  /// Whether the text is an experiment. What is none must have a fault, which must have a place in the text.
  bool check(const std::string& text) {
    std::vector<Fault> faults;
    Experiment experiment = default_experiment();
    DescribedBy params([&](ParamVisitor& v) { describe(v, experiment, catalog_); });
    auto tree = parse_yaml(text, origin_of(folder_.path() / "e.yaml"), faults);
    if (tree) {
      apply_overrides(*tree, {{"localizer.matcher.ransam.iterations", "5"}}, params, faults);
      read_params(*tree, params, faults);
    }
    EXPECT_TRUE(tree || !faults.empty()) << text;
    const auto lines = std::count(text.begin(), text.end(), '\n') + 1;
    for (const Fault& fault : faults) {
      EXPECT_LE(fault.line, lines) << text;
      EXPECT_FALSE(fault.message.empty()) << text;
    }
    if (faults.empty()) {
      EXPECT_NE(effective_yaml(experiment, catalog_), "");
    }
    return faults.empty();
  }

  Catalog catalog_;
  TemporaryFolder folder_;
};

const std::string unmutated = R"(# An experiment.
schema: 1
name: "toy"
map:
  toy_map:
    path: map.txt
    segments: [[0.0, 0.3]]
    walls:
      - {from: [1, 2], height: 3.5}
      - height: 1
observations: {toy_drive: {label: 'it''s', tags: ["a\t", b]}}
trials: {every_m: 6.0, max_steps: 60}
localizer:
  matcher:
    ransam: {iterations: 500, contact_epsilon: 0.10}
output: {steps: true, maps: first_trial}
)";

TEST_F(Mutation, TruncatedAnywhere) {
  ASSERT_TRUE(check(unmutated));
  for (std::size_t size = 0; size < unmutated.size(); ++size) check(unmutated.substr(0, size));
}

TEST_F(Mutation, OneByteChanged) {
  Rng rng(7);
  int refused = 0;
  for (std::size_t at = 0; at < unmutated.size(); ++at) {
    for (const char byte : {'\0', '\t', '\n', ' ', '"', '\'', '{', ']', ':', '-', '&', '*', '!', '%', '|',
                            '\xff', static_cast<char>(rng.below(256))}) {
      std::string text = unmutated;
      text[at] = byte;
      refused += check(text) ? 0 : 1;
    }
  }
  EXPECT_GT(refused, 1000);
}

TEST_F(Mutation, OneByteLostOrDoubled) {
  for (std::size_t at = 0; at < unmutated.size(); ++at) {
    check(std::string(unmutated).erase(at, 1));
    check(std::string(unmutated).insert(at, 1, unmutated[at]));
  }
}

TEST_F(Mutation, SeveralBytesShuffled) {
  Rng rng(11);
  for (int i = 0; i < 2000; ++i) {
    std::string text = unmutated;
    for (int k = 0; k < 4; ++k) {
      const auto n = static_cast<std::uint32_t>(text.size());
      std::swap(text[rng.below(n)], text[rng.below(n)]);
    }
    check(text);
  }
}

}  // namespace
}  // namespace glocal::test::mutation_test
