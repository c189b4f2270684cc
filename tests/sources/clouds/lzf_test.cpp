#include "sources/clouds/lzf.hpp"

#include <gtest/gtest.h>

#include "sources/clouds/cloud_files.hpp"

namespace glocal::lzf_test {
namespace {

TEST(Lzf, TakesBytesAsTheyAre) {
  const std::string text(100, 'a');
  EXPECT_EQ(lzf_decompressed(test::stored_as_lzf(text), text.size()), text);
}

TEST(Lzf, RepeatsWhatWasJustWritten) {
  using namespace std::string_literals;
  // "ab", then 4 bytes from 2 bytes back, then 9 + 255 bytes from 1 byte back.
  EXPECT_EQ(lzf_decompressed("\x01"
                             "ab\x40\x01"s,
                             6),
            "ababab");
  EXPECT_EQ(lzf_decompressed("\x00"
                             "a\xe0\xff\x00"s,
                             265),
            std::string(265, 'a'));
}

TEST(Lzf, RefusesWhatIsDamaged) {
  using namespace std::string_literals;
  EXPECT_FALSE(
      lzf_decompressed("\x05"
                       "ab"s,
                       6));  // ends within its bytes
  EXPECT_FALSE(
      lzf_decompressed("\x00"
                       "a\x20"s,
                       4));  // ends within a reference
  EXPECT_FALSE(
      lzf_decompressed("\x00"
                       "a\x20\x01"s,
                       4));  // refers to what is before the beginning
  EXPECT_FALSE(
      lzf_decompressed("\x00"
                       "a\xe0\xff\x00"s,
                       264));  // more than announced
  EXPECT_FALSE(
      lzf_decompressed("\x00"
                       "a"s,
                       2));  // less than announced
  EXPECT_EQ(lzf_decompressed("", 0), "");
}

}  // namespace
}  // namespace glocal::lzf_test
