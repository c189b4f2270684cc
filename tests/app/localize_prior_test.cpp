// glocal localize --region and --heading.
#include <gmock/gmock.h>

#include "app/room.hpp"

namespace glocal::test::localize_prior_test {
namespace {

using testing::HasSubstr;
using testing::Not;

/// A world that is the same when it is turned by 180 degrees about (6, 3), and a drive in it, as files.
class LocalizeWithPrior : public Room {
 protected:
  LocalizeWithPrior() {
    write_symmetric_world();
    good(run("simulate " + file("room.yaml") + " --out " + file("recorded")));
  }

  [[nodiscard]] Answer localize(const std::string& options) const {
    return run("localize " + file("recorded/map.yaml") + " " + file("recorded/drive.log") +
               " --force --out " + file("found") + " " + options);
  }

  /// Where it is said to be, and how it is judged.
  [[nodiscard]] Json trial() const { return Json::parse(content(file("found/trials.jsonl"))); }
};

TEST_F(LocalizeWithPrior, ARegionSettlesWhatSymmetryLeavesOpen) {
  good(localize(""));
  EXPECT_EQ(trial()["outcome"], "undecided");
  EXPECT_THAT(content("found.yaml"), Not(HasSubstr("prior")));

  // The drive begins at (2, 3); its image at (10, 3).
  const Answer left = good(localize("--region 2.5 3 3"));
  EXPECT_EQ(trial()["outcome"], "right") << left.out;
  EXPECT_THAT(trial()["why"].get<std::string>(),
              HasSubstr("; only starts within 3 m of x 2.5, y 3 were looked at"));
  EXPECT_THAT(left.out, HasSubstr("prior       only starts within 3 m of x 2.5, y 3\n"));
  EXPECT_THAT(content("found.yaml"), HasSubstr("  prior: {region: {x: 2.5, y: 3, radius: 3}}\n"));

  good(localize("--region 10 3 3"));
  EXPECT_EQ(trial()["outcome"], "wrong") << "as the region is";
}

TEST_F(LocalizeWithPrior, AHeadingDoesSo) {
  const Answer answer = good(localize("--heading -10 90"));
  EXPECT_EQ(trial()["outcome"], "right") << answer.out;
  EXPECT_THAT(content("found.yaml"), HasSubstr("  prior: {heading: {deg: -10, width_deg: 90}}\n"));
}

TEST_F(LocalizeWithPrior, WhatCannotBeIsRefused) {
  EXPECT_THAT(refusal(localize("--region -200 3 3")),
              HasSubstr("localizer.prior.region: the map has nothing within 3 m of x -200, y 3"));
  EXPECT_THAT(refusal(localize("--region 2 3 0")),
              HasSubstr("localizer.prior.region: radius: 0 is out of range"));
  EXPECT_NE(localize("--region 2 3").exit_code, 0);
  EXPECT_NE(localize("--heading 90").exit_code, 0);
}

}  // namespace
}  // namespace glocal::test::localize_prior_test
