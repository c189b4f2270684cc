// Help and reference say what the descriptions say.
#include "config/field_docs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "config/help.hpp"
#include "config/reference.hpp"
#include "framework/config/toy_catalog.hpp"

namespace glocal::test::field_docs_test {
namespace {

using testing::HasSubstr;

class FieldDocs : public testing::Test {
 protected:
  FieldDocs() { register_toys(catalog_); }
  Catalog catalog_;
};

TEST_F(FieldDocs, HelpOfAStrategyHasEveryFact) {
  EXPECT_EQ(help("toy_map", catalog_).value_or(""), R"(toy_map (map_source, from glocal, experimental)
A map from nowhere.

  path: path, required
      The map's file.
  segments: list of pairs of numbers (at least 1 item; each >= 0 and <= 1), default [[0.0,1.0]]
      Shares of the path.
  resolution: number (> 0 m), default 0.05
      Size of a cell.
  walls: list of maps (at most 3 items), default []
      Walls | besides the map.
      from: list of numbers (2 items; each m), default [0.0,0.0]
          Where it begins.
      height: number (> 0 m), default 2.5
          How high it is.
)");
  EXPECT_EQ(
      help("indexed", catalog_).value_or(""),
      "indexed (matcher, from glocal, stable since 0.1.0)\nMatches nothing, faster.\n\n  No parameters.\n");
}

TEST_F(FieldDocs, WhatToTuneComesFirstAndWhatIsForExpertsLast) {
  EXPECT_EQ(help("ransam", catalog_).value_or(""), R"(ransam (matcher, from glocal, experimental)
Matches nothing.

  Tune first: iterations.

  iterations: whole number (>= 1), default 200000
      Draws on each side.
  contact_epsilon: number (> 0 m), default 0.1
      Distance in contact.

  For experts:

  patience: number or auto (> 0 s), default auto
      How long it waits.
)");
  EXPECT_THAT(parameter_reference(catalog_),
              HasSubstr("Tune first: `iterations`.\n\n"
                        "| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n"
                        "| `iterations` | whole number | `200000` | >= 1 | Draws on each side. |\n"
                        "| `contact_epsilon` | number | `0.1` | > 0 m | Distance in contact. |\n\n"
                        "For experts:\n\n"
                        "| key | type | default | allowed | meaning |\n|---|---|---|---|---|\n"
                        "| `patience` | number or auto | `auto` | > 0 s | How long it waits. |\n"));
}

TEST_F(FieldDocs, HelpTellsRulesChoicesAndUnsignedBounds) {
  const std::string text = help("toy_drive", catalog_).value_or("");
  EXPECT_THAT(text, HasSubstr("  mode: text (fast, slow), default \"fast\"\n"));
  EXPECT_THAT(text, HasSubstr("  salt: whole number (>= 0), default 7\n"));
  EXPECT_THAT(text, HasSubstr("  Rule: min_range must be less than max_range.\n"));
}

TEST_F(FieldDocs, HelpOfTheExperimentNamesTheStrategies) {
  const std::string text = help("experiment", catalog_).value_or("");
  EXPECT_THAT(text, HasSubstr("      matcher: matcher (indexed, ransam), default ransam\n"));
  EXPECT_THAT(text, HasSubstr("  map: map_source (toy_map), required\n"));
}

TEST_F(FieldDocs, HelpShowsAllStrategiesOfAName) {
  catalog_.raters.add<ToyRater>("ransam", "Another of that name.");
  const std::string text = help("ransam", catalog_).value_or("");
  EXPECT_THAT(text, HasSubstr("ransam (matcher, from glocal, experimental)"));
  EXPECT_THAT(text, HasSubstr("ransam (rater, from glocal, experimental)"));
  EXPECT_EQ(help("nothing", catalog_), std::nullopt);
}

TEST_F(FieldDocs, ListAlignsItsColumns) {
  EXPECT_EQ(list_strategies(catalog_.matchers),
            "  indexed  stable since 0.1.0  Matches nothing, faster.\n  ransam   experimental        Matches "
            "nothing.\n");
}

TEST_F(FieldDocs, ReferenceFlattensKeysAndEscapesCells) {
  const std::string text = parameter_reference(catalog_);
  EXPECT_THAT(text, HasSubstr("| `walls[].height` | number | `2.5` | > 0 m | How high it is. |\n"));
  EXPECT_THAT(text, HasSubstr("| Walls \\| besides the map. |\n"));
  EXPECT_THAT(text, HasSubstr("| `trials.max_steps` | whole number | `60` | >= 0 | "));
  EXPECT_THAT(
      text, HasSubstr("- `trials`: exactly one of every_m, starts_m, every_scan and whole must be given.\n"));
  EXPECT_THAT(text, HasSubstr("- `min_range`: must be less than max_range.\n"));
  EXPECT_THAT(
      text,
      HasSubstr(
          "### indexed\n\nMatches nothing, faster.\n\nStatus: stable since 0.1.0.\n\nNo parameters.\n"));
  EXPECT_THAT(text, HasSubstr("| `path` | path | required |  | The map's file. |\n"));
}

}  // namespace
}  // namespace glocal::test::field_docs_test
