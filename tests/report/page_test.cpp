#include "report/page.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "report/packed.hpp"
#include "report/page_text.hpp"
#include "report/unpacked.hpp"

namespace glocal::test::page_test {
namespace {

using Json = nlohmann::ordered_json;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

constexpr const char* small_page =
    "<meta leave<!--glocal:leave-->><title><!--glocal:title--></title><body><!--glocal:data--></body>";

PageData planar(const Json& more = {}) {
  PageData data{{{"maps", Json::array()}}};
  data.head.update(more.is_null() ? Json::object() : more);
  return data;
}

TEST(Packed, IsReadByOthers) {
  for (const std::size_t length : {0U, 1U, 2U, 3U, 4U, 5000U}) {
    const Json data = {{"text", std::string(length, 'a')}, {"numbers", {1, 2.5, nullptr}}};
    EXPECT_EQ(unpacked(packed(data)), data) << length;
  }
  EXPECT_LT(packed(std::string(5000, 'a')).size(), 100U);
  // RFC 4648, and what any zlib makes of so little.
  EXPECT_EQ(from_base64("Zm9vYg=="), "foob");
}

TEST(Page, HasTitleAndDataInTheirPlaces) {
  PageData data = planar({{"format", 1}});
  data.chunks = {packed({{"columns", 1}}), packed({{"columns", 2}})};
  const std::string page = page_with(small_page, "room", data);
  EXPECT_THAT(
      page,
      StartsWith("<meta leave><title>room</title><body><script type=\"text/plain\" id=\"glocal-data\">"));
  EXPECT_THAT(page, EndsWith("</script></body>"));
  EXPECT_EQ(data_in(page).head, data.head);
  EXPECT_EQ(data_in(page).chunks, data.chunks);
}

TEST(Page, DataCannotEndTheirElement) {
  const PageData data = planar({{"</script>", "<script>&amp;<!-- \"quoted\" \\ "}});
  const std::string page = page_with(small_page, "", data);
  EXPECT_THAT(std::string(element_of(page, "glocal-data")), Not(HasSubstr("<")));
  EXPECT_EQ(data_in(page).head, data.head);
}

TEST(Page, TitlesAreText) {
  EXPECT_THAT(page_with(small_page, "a</title><b>&amp;", planar()),
              HasSubstr("<title>a&lt;/title&gt;&lt;b&gt;&amp;amp;</title>"));
}

TEST(Page, WhatIsNotUtf8IsReplaced) {
  const std::string page = page_with(small_page, "caf\xe9", planar({{"name", "\xff"}}));
  EXPECT_THAT(page, HasSubstr("<title>caf\xef\xbf\xbd</title>"));
  EXPECT_EQ(data_in(page).head["name"], "\xef\xbf\xbd");
}

TEST(Page, MustHaveItsMarksOnce) {
  const std::string page = small_page;
  for (const std::string& wrong :
       {std::string("<!--glocal:leave--><!--glocal:title-->"),
        std::string("<!--glocal:leave--><!--glocal:data--><!--glocal:title-->"), page + page})
    EXPECT_THROW(static_cast<void>(page_with(wrong, "", planar())), std::logic_error) << wrong;
}

TEST(Page, MapsWithHeightsBringTheScriptThatDrawsThem) {
  const Json in_space = {{"maps", {{{"x", {1}}}, {{"x", {1}}, {"z", {1}}}}}};
  EXPECT_TRUE(script_for({{"maps", {{{"x", {1}}}}}}).empty());
  EXPECT_TRUE(script_for({{"maps", Json::array()}}).empty());
  EXPECT_EQ(script_for(in_space), space_text);
  EXPECT_THAT(page_with(small_page, "", {in_space}),
              HasSubstr("</script><script>" + std::string(space_text)));
}

TEST(Page, LoadsWhatWasPutBesideIt) {
  PageData data = planar();
  // Three to a file of 200 kB.
  for (std::size_t i = 0; i < 7; ++i) data.chunks.emplace_back(80'000, static_cast<char>('a' + i));
  const std::vector<std::string> chunks = data.chunks;
  PageData again = data;
  const std::vector<PageFile> files = put_beside(data, "page_steps");
  ASSERT_EQ(files.size(), 3U);
  EXPECT_TRUE(data.chunks.empty());
  EXPECT_EQ(data.head["beside"]["folder"], "page_steps");
  EXPECT_EQ(data.head["beside"]["first"], Json::parse("[0, 3, 6]"));
  const std::string hash = data.head["beside"]["hash"];
  for (std::size_t f = 0; f < 3; ++f) {
    EXPECT_EQ(files[f].name, hash + "_" + std::to_string(f) + ".js");
    EXPECT_TRUE(is_beside_file(files[f].name));
  }
  EXPECT_EQ(files[2].content, "glocalChunks({\"6\":\"" + chunks[6] + "\",\n});\n");
  EXPECT_THAT(page_with(small_page, "", data), StartsWith("<meta leave 'self' file:>"));
  // Other steps have other names, and the same ones the same.
  EXPECT_EQ(put_beside(again, "page_steps")[0].name, files[0].name);
  again.chunks = chunks;
  again.chunks[4] += "x";
  EXPECT_NE(put_beside(again, "page_steps")[0].name, files[0].name);
}

TEST(Page, TakesNothingElseForItsOwn) {
  for (const char* name : {"0123456789abcdef_1.txt", "0123456789abcdeg_1.js", "0123456789abcdef_.js",
                           "x_1.js", "0123456789abcdef_1x.js", ".0123456789abcdef_1.js.17.unfinished"})
    EXPECT_FALSE(is_beside_file(name)) << name;
}

TEST(Page, ThatIsBuiltInTakesDataAndNeedsNothingElse) {
  const std::string page = page_with(page_text, "room", planar({{"format", 1}}));
  EXPECT_THAT(page, HasSubstr("room</title>"));
  EXPECT_THAT(page, HasSubstr("script-src 'unsafe-inline'; "));
  EXPECT_EQ(data_in(page).head["format"], 1);
  for (const char* outside : {"src=\"http", "href=\"http", "@import", "url(http"})
    EXPECT_THAT(page, Not(HasSubstr(outside)));
}

}  // namespace
}  // namespace glocal::test::page_test
