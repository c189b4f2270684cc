// Whether two matchers have answered alike.
#pragma once

#include <gtest/gtest.h>

#include "glocal/strategies.hpp"

namespace glocal::test {

/// Some hypotheses, bit for bit the same, found with the same work.
inline void expect_same_answer(const MatchResult& one, const MatchResult& other) {
  ASSERT_FALSE(one.hypotheses.empty());
  ASSERT_EQ(one.hypotheses.size(), other.hypotheses.size());
  for (std::size_t i = 0; i < one.hypotheses.size(); ++i) {
    EXPECT_EQ(one.hypotheses[i].map_from_local, other.hypotheses[i].map_from_local);
    EXPECT_EQ(one.hypotheses[i].quality, other.hypotheses[i].quality);
    EXPECT_EQ(one.hypotheses[i].score, other.hypotheses[i].score);
    EXPECT_EQ(one.hypotheses[i].support, other.hypotheses[i].support);
  }
  EXPECT_EQ(one.proposals, other.proposals);
  EXPECT_EQ(one.points_tested, other.points_tested);
}

}  // namespace glocal::test
