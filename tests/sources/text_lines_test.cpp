#include "sources/text_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace glocal::text_lines_test {
namespace {

using testing::ElementsAre;

TEST(TextLines, GoFromLineToLine) {
  TextLines lines("a  b\t c\r\n\n \nd");
  ASSERT_TRUE(lines.next());
  EXPECT_THAT(lines.fields(), ElementsAre("a", "b", "c"));
  EXPECT_EQ(lines.rest(), "\n \nd");
  ASSERT_TRUE(lines.next_with_fields());
  EXPECT_THAT(lines.fields(), ElementsAre("d"));
  EXPECT_EQ(lines.number(), 4);
  EXPECT_FALSE(lines.next());
  TextLines marked(
      "\xEF\xBB\xBF"
      "1 2");
  ASSERT_TRUE(marked.next());
  EXPECT_THAT(marked.fields(), ElementsAre("1", "2"));
}

TEST(TextLines, ReadNumbers) {
  EXPECT_EQ(number_in("-1.5e3"), -1500.0);
  EXPECT_EQ(number_in("+2"), 2.0);
  EXPECT_EQ(number_in("1e-999"), 0.0);
  EXPECT_TRUE(std::isnan(number_in("nan").value()));
  EXPECT_TRUE(std::isinf(number_in("-inf").value()));
  for (const char* text : {"", "+", "1e999", "1.0m", "e", "one"}) EXPECT_FALSE(number_in(text)) << text;
  EXPECT_EQ(whole_number_in("12"), 12U);
  for (const char* text : {"", "-1", "1.0", "99999999999999999999"})
    EXPECT_FALSE(whole_number_in(text)) << text;
}

}  // namespace
}  // namespace glocal::text_lines_test
