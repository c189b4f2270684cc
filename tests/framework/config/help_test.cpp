// Help as text and as data, of small strategies.
#include "config/help.hpp"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "framework/config/toy_catalog.hpp"

namespace glocal::test::help_test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::ordered_json;

class HelpTest : public testing::Test {
 protected:
  HelpTest() { register_toys(catalog_); }

  /// What is known of a field, by its name.
  static Json field(const Json& fields, const std::string& name) {
    for (const Json& one : fields) {
      if (one.at("name") == name) return one;
    }
    ADD_FAILURE() << "there is no " << name;
    return {};
  }

  Catalog catalog_;
};

TEST_F(HelpTest, AStrategyAsDataHasItsParametersWithTypesAndBounds) {
  const Json all = *help_json("toy_drive", catalog_);
  ASSERT_EQ(all.size(), 1U);
  EXPECT_EQ(all[0]["kind"], "observation_source");
  EXPECT_EQ(all[0]["origin"], "glocal");
  EXPECT_EQ(all[0]["motions"], Json::array({"planar"}));
  const Json& fields = all[0]["parameters"];
  EXPECT_EQ(field(fields, "min_range")["default"], 0.1);
  EXPECT_EQ(field(fields, "mode")["type"], "text");
  EXPECT_TRUE(field(fields, "mode")["choices"].is_array());
  const Json noise = field(fields, "noise");
  EXPECT_EQ(field(noise["parameters"], "beams")["default"], 8);
}

TEST_F(HelpTest, APartOfAnExperimentIsFoundByItsPath) {
  EXPECT_THAT(*help("trials", catalog_),
              AllOf(HasSubstr("A part of an experiment file."), HasSubstr("max_steps: whole number")));
  EXPECT_THAT(*help("trials.max_steps", catalog_), HasSubstr("max_steps: whole number"));
  EXPECT_EQ((*help_json("trials", catalog_))[0]["name"], "trials");
  EXPECT_EQ(field((*help_json("localizer", catalog_))[0]["parameters"], "matcher")["strategies"],
            Json::array({"indexed", "ransam"}));
  EXPECT_EQ(help("localizer.matcher.ransam", catalog_), help("ransam", catalog_));
  EXPECT_EQ(help_json("localizer.matcher.ransam", catalog_), help_json("ransam", catalog_));
  EXPECT_EQ(help("localizer.matcher.none", catalog_), std::nullopt);
  EXPECT_EQ(help("trials.none", catalog_), std::nullopt);
  EXPECT_EQ(help_json("nothing", catalog_), std::nullopt);
}

TEST_F(HelpTest, AllStrategiesOfARegistryAreListedAsData) {
  const Json matchers = strategies_json(catalog_.matchers);
  ASSERT_EQ(matchers.size(), 2U);
  EXPECT_EQ(matchers[0]["name"], "indexed");
  EXPECT_EQ(matchers[0]["status"], "stable");
  EXPECT_EQ(matchers[0]["since"], "0.1.0");
  EXPECT_EQ(matchers[1]["name"], "ransam");
  EXPECT_EQ(matchers[1]["status"], "experimental");
  EXPECT_EQ(matchers[1]["kind"], "matcher");
}

}  // namespace
}  // namespace glocal::test::help_test
