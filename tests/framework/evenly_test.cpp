#include "glocal/evenly.hpp"

#include <gtest/gtest.h>

namespace glocal::evenly_test {
namespace {

using Numbers = std::vector<std::size_t>;

TEST(EvenlyChosen, AreAsFarApartAsCanBe) {
  EXPECT_EQ(evenly_chosen(10, 4), (Numbers{0, 2, 5, 7}));
  EXPECT_EQ(evenly_chosen(1200, 600)[599], 1198U);
}

TEST(EvenlyChosen, AreAllIfThereAreNoMore) {
  EXPECT_EQ(evenly_chosen(3, 3), (Numbers{0, 1, 2}));
  EXPECT_EQ(evenly_chosen(2, 5), (Numbers{0, 1}));
  EXPECT_TRUE(evenly_chosen(0, 5).empty());
}

}  // namespace
}  // namespace glocal::evenly_test
