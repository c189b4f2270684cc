// Two clusters that are rated differently by their best hypothesis and by the mean.
#pragma once

#include "raters/with_scores.hpp"

namespace glocal::test {

/// The first has two members and the better mean, the second three and the best hypothesis.
inline const std::vector<Cluster> two_clusters = {{{1, 2}, {}, 0.0, 0.0, 0.0},
                                                  {{0, 3, 4}, {}, 0.0, 0.0, 0.0}};
inline const std::vector<double> qualities = {0.8, 0.7, 0.5, 0.4, 0.3};

}  // namespace glocal::test
