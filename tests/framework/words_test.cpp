#include "glocal/words.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "glocal/error.hpp"

namespace glocal::test::words_test {
namespace {

using testing::EndsWith;
using testing::SizeIs;
using testing::StartsWith;

TEST(Words, ControlCharactersAreEscaped) {
  EXPECT_EQ(printable("\033]0;PWNED\a\033[31m"), "\\u001b]0;PWNED\\u0007\\u001b[31m");
  EXPECT_EQ(printable("a\tb\nc\x7f\r"), "a\tb\nc\\u007f\\u000d");
  EXPECT_EQ(printable("CSI \xc2\x9b"
                      "31m"),
            "CSI \\u009b31m")
      << "C1 is as good as ESC [";
  EXPECT_EQ(printable("a\xe2\x80\xae"
                      "fdp.exe"),
            "a\\u202efdp.exe")
      << "what follows would run backwards";
  EXPECT_EQ(shown("a\tb\nc"), "a\\u0009b\\u000ac") << "a name has one line";
}

TEST(Words, TextStaysAsItIs) {
  for (const char* text : {"", "/scan front", "größer – 雪 🤖 é", "\xef\xbf\xbd"}) {
    EXPECT_EQ(printable(text), text);
    EXPECT_EQ(shown(text), text);
  }
}

TEST(Words, AByteOrderMarkIsLeftOutWhereItIsFirst) {
  for (const char* text : {"", "a", "a\xef\xbb\xbf", "\xef\xbb"})
    EXPECT_EQ(without_byte_order_mark(text), text);
  EXPECT_EQ(without_byte_order_mark("\xef\xbb\xbf"
                                    "case,seed"),
            "case,seed");
}

TEST(Words, BytesThatAreNoUtf8AreReplaced) {
  const std::string instead = "\xef\xbf\xbd";
  EXPECT_EQ(printable("\xff"
                      "a"),
            instead + "a");
  EXPECT_EQ(printable("a\xc3"), "a" + instead) << "cut off";
  EXPECT_EQ(printable("\xc0\xaf"), instead + instead) << "longer than need be";
  EXPECT_EQ(printable("\xe0\x80\xaf"), instead + instead + instead);
  EXPECT_EQ(printable("\xed\xa0\x80"), instead + instead + instead) << "half a surrogate pair";
  EXPECT_EQ(printable("\xf4\x90\x80\x80"), instead + instead + instead + instead) << "beyond U+10FFFF";
}

TEST(Words, LongOnesLoseTheirMiddle) {
  EXPECT_EQ(shown(std::string(80, 'a')), std::string(80, 'a'));
  EXPECT_EQ(shown(std::string(100, 'a') + std::string(100, 'b')),
            std::string(53, 'a') + "…" + std::string(26, 'b'));
  EXPECT_THAT(shown(std::string(1'000'000, '\033')), SizeIs(testing::Le(90)));
  std::string snow;
  for (int i = 0; i < 100; ++i) snow += "雪";
  EXPECT_EQ(printable(shown(snow)), shown(snow)) << "no character is cut in two";
}

TEST(Words, ListsAreCutShort) {
  EXPECT_EQ(listed(std::vector<std::string>{}), "");
  EXPECT_EQ(listed(std::vector<std::string>{"a", "\033", "c"}), "a, \\u001b, c");
  EXPECT_EQ(listed(std::vector<std::string>{"a", "b"}, " or "), "a or b");
  const std::vector<std::string> many(10'000, "x");
  EXPECT_THAT(listed(many), StartsWith("x, x, "));
  EXPECT_THAT(listed(many), EndsWith("x, x and 9980 more"));
  EXPECT_EQ(first_of(std::vector<std::string>(20, "x")), std::vector<std::string>(20, "x"));
  EXPECT_THAT(first_of(many), SizeIs(21));
  EXPECT_EQ(first_of(many).back(), "and 9980 more like these");
}

TEST(Words, MessagesAreFitToBeRead) {
  EXPECT_EQ(fit_message("one\ntwo\033\n"), "one\ntwo\\u001b\n");
  const std::string message = fit_message("a\n" + std::string(1'000'000, 'b') + "\nc");
  EXPECT_THAT(message, SizeIs(testing::Le(2020)));
  EXPECT_THAT(message, EndsWith("b\nc"));
}

TEST(Words, FaultsAreFitToBeRead) {
  const ConfigError error({{"a\033.yaml", 3, 4, "unknown key '" + std::string(1'000'000, 'k') + "'"}});
  EXPECT_THAT(std::string(error.what()), StartsWith("a\\u001b.yaml:3:4: error: unknown key 'kkk"));
  EXPECT_THAT(std::string(error.what()), SizeIs(testing::Le(2020)));
}

}  // namespace
}  // namespace glocal::test::words_test
