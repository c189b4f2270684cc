#pragma once

#include <string>
#include <vector>

#include "glocal/hypothesis.hpp"
#include "glocal/params.hpp"

namespace glocal::raters {

/// The parameter `quality` of raters that go by it: "best" or "mean".
void describe_cluster_quality(ParamVisitor& v, std::string& quality);

/// Score of a cluster's best hypothesis, or their mean weighted with support; in [0, 1].
[[nodiscard]] double cluster_score(const Cluster& cluster, const std::vector<Hypothesis>& hypotheses,
                                   const std::string& quality);

}  // namespace glocal::raters
