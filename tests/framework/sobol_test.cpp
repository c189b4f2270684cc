// Sobol's sequence: the points that were published, those of another implementation, and its evenness.
#include "sobol.hpp"

#include <gtest/gtest.h>

#include <array>
#include <boost/random/sobol.hpp>
#include <set>

namespace glocal::test::sobol_test {
namespace {

TEST(Sobol, HasThePublishedPoints) {
  // The output of Joe's and Kuo's own program for 10 points in 3 dimensions
  // (https://web.maths.unsw.edu.au/~fkuo/sobol).
  constexpr std::array<std::array<double, 3>, 10> published = {{{0, 0, 0},
                                                                {0.5, 0.5, 0.5},
                                                                {0.75, 0.25, 0.25},
                                                                {0.25, 0.75, 0.75},
                                                                {0.375, 0.375, 0.625},
                                                                {0.875, 0.875, 0.125},
                                                                {0.625, 0.125, 0.875},
                                                                {0.125, 0.625, 0.375},
                                                                {0.1875, 0.3125, 0.9375},
                                                                {0.6875, 0.8125, 0.4375}}};
  const Sobol sobol(3);
  for (std::uint32_t i = 0; i < published.size(); ++i) {
    const auto x = sobol.point(i);
    for (std::size_t d = 0; d < 3; ++d) EXPECT_EQ(x[d] * 0x1.0p-32, published.at(i).at(d)) << i << ", " << d;
  }
}

TEST(Sobol, AgreesWithBoostInAllDimensions) {
  const Sobol sobol(Sobol::most_dimensions);
  // Boost leaves the corner out.
  boost::random::sobol_engine<std::uint32_t, 32> boost(Sobol::most_dimensions);
  for (std::uint32_t i = 1; i < 5000; ++i) {
    for (const std::uint32_t x : sobol.point(i)) ASSERT_EQ(x, boost()) << i;
  }
}

TEST(Sobol, EachOfEquallyManyPartsHasOnePoint) {
  const Sobol sobol(Sobol::most_dimensions);
  for (const unsigned m : {1U, 5U, 10U}) {
    std::vector<std::set<std::uint32_t>> parts(Sobol::most_dimensions);
    for (std::uint32_t i = 0; i < 1U << m; ++i) {
      const auto x = sobol.point(i);
      for (std::size_t d = 0; d < parts.size(); ++d) parts[d].insert(x[d] >> (32U - m));
    }
    for (std::size_t d = 0; d < parts.size(); ++d) EXPECT_EQ(parts[d].size(), 1U << m) << d << ", " << m;
  }
}

}  // namespace
}  // namespace glocal::test::sobol_test
