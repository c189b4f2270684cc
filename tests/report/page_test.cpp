#include "report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "report/page_text.hpp"

namespace glocal::test::page_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::HasSubstr;
using testing::Not;

constexpr const char* small_page = "<title><!--glocal:title--></title><body><!--glocal:data--></body>";

TEST(Page, HasTitleAndDataInTheirPlaces) {
  EXPECT_EQ(page_with(small_page, "room", {{"format", 1}}),
            "<title>room</title><body><script type=\"application/json\" id=\"glocal-data\">{\"format\":1}"
            "</script></body>");
}

TEST(Page, DataCanNeitherEndTheirElementNorChangeHowItIsRead) {
  const Json data = {{"</script>", "<script>&amp;<!-- \"quoted\" \\ "},
                     {"lines", "\xe2\x80\xa8 \xe2\x80\xa9"}};
  const std::string page = page_with(small_page, "", data);
  const std::string begin = "id=\"glocal-data\">";
  const std::size_t at = page.find(begin) + begin.size();
  const std::string text = page.substr(at, page.find("</script>") - at);
  EXPECT_THAT(text, Not(HasSubstr("<")));
  EXPECT_THAT(text, Not(HasSubstr("\xe2\x80")));
  EXPECT_EQ(Json::parse(text), data);
}

TEST(Page, TitlesAreText) {
  EXPECT_THAT(page_with(small_page, "a</title><b>&amp;", {}),
              HasSubstr("<title>a&lt;/title&gt;&lt;b&gt;&amp;amp;</title>"));
}

TEST(Page, WhatIsNoUtf8IsReplaced) {
  const std::string page = page_with(small_page, "caf\xe9", {{"name", "\xff"}});
  EXPECT_THAT(page, HasSubstr("<title>caf\xef\xbf\xbd</title>"));
  EXPECT_THAT(page, HasSubstr("{\"name\":\"\xef\xbf\xbd\"}"));
}

TEST(Page, HasEachPlaceOnce) {
  EXPECT_THROW(static_cast<void>(page_with("<!--glocal:title-->", "", {})), std::logic_error);
  EXPECT_THROW(static_cast<void>(page_with("<!--glocal:data--><!--glocal:title-->", "", {})),
               std::logic_error);
  const std::string page(small_page);
  EXPECT_THROW(static_cast<void>(page_with(page + page, "", {})), std::logic_error);
}

TEST(Page, HasAScriptAfterItsDataWhereTheyNeedOne) {
  EXPECT_EQ(page_with(small_page, "", {}, "draw()"),
            "<title></title><body><script type=\"application/json\" id=\"glocal-data\">null</script>"
            "<script>draw()</script></body>");
  const Json planar = {{"maps", {{{"x", {1}}, {"y", {2}}}}}};
  const Json in_space = {{"maps", {{{"x", {1}}, {"y", {2}}}, {{"x", {1}}, {"y", {2}}, {"z", {3}}}}}};
  EXPECT_TRUE(script_for(planar).empty());
  EXPECT_TRUE(script_for({{"maps", Json::array()}}).empty());
  EXPECT_EQ(script_for(in_space), space_text);
}

TEST(Page, ThatIsBuiltInTakesDataAndNeedsNothingElse) {
  const std::string page = page_with(page_text, "room", {{"format", 1}});
  EXPECT_THAT(page, HasSubstr("room</title>"));
  EXPECT_THAT(page, HasSubstr(">{\"format\":1}</script>"));
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
}

}  // namespace
}  // namespace glocal::test::page_test
