#include "config/nearest.hpp"

#include <gtest/gtest.h>

namespace glocal::test::nearest_test {
namespace {

TEST(EditDistance, CountsEachKindOfSlip) {
  EXPECT_EQ(edit_distance("", ""), 0U);
  EXPECT_EQ(edit_distance("", "abc"), 3U);
  EXPECT_EQ(edit_distance("abc", ""), 3U);
  EXPECT_EQ(edit_distance("window", "windows"), 1U);
  EXPECT_EQ(edit_distance("window", "wimdow"), 1U);
  EXPECT_EQ(edit_distance("window", "wnidow"), 1U);  // Neighbours swapped.
  EXPECT_EQ(edit_distance("kitten", "sitting"), 3U);
}

TEST(Nearest, TakesTheNearestWithinAThird) {
  EXPECT_EQ(nearest("itertions", {"window", "iterations"}), "iterations");
  EXPECT_EQ(nearest("ab", {"xy", "ac"}), "ac");
  EXPECT_EQ(nearest("abcdef", {"uvwxyz"}), std::nullopt);
  EXPECT_EQ(nearest("x", {}), std::nullopt);
}

TEST(Nearest, TakesTheBeginningOfANameWhereThereIsButOne) {
  EXPECT_EQ(nearest("indexed", {"indexed_ransam", "ransam"}), "indexed_ransam");
  EXPECT_EQ(nearest("indexed", {"indexed_ransam", "indexed_search"}), std::nullopt);
  EXPECT_EQ(nearest("in", {"indexed_ransam", "ransam"}), std::nullopt) << "too little of it";
}

TEST(Suggestion, NamesTheNearestOrAll) {
  EXPECT_EQ(suggestion("stepz", {"maps", "steps"}, "known keys"), " (did you mean 'steps'?)");
  EXPECT_EQ(suggestion("colour", {"maps", "steps"}, "known keys"), " (known keys: maps, steps)");
  EXPECT_EQ(suggestion("colour", {}, "known keys"), "");
}

}  // namespace
}  // namespace glocal::test::nearest_test
