// What sources of observations deliver.
#pragma once

#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "glocal/strategies.hpp"

namespace glocal::test {

/// All samples that a source has left.
[[nodiscard]] inline std::vector<Sample> all_of(ObservationSource& source) {
  std::vector<Sample> samples;
  while (auto sample = source.next()) samples.push_back(*std::move(sample));
  EXPECT_FALSE(source.next());
  return samples;
}

}  // namespace glocal::test
