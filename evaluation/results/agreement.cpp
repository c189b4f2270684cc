#include "evaluation/results/agreement.hpp"

#include <algorithm>
#include <tuple>

namespace glocal {
namespace {

bool agree(const Declaration& before, const Declaration& after) {
  constexpr double least_m = 0.5, per_metre = 0.1;
  constexpr double least_deg = 10.0, deg_per_metre = 2.0;
  const double way = after.at_m - before.at_m;
  const Pose3 carried = before.map_from_robot * inverse(before.odom_from_robot) * after.odom_from_robot;
  return distance(carried, after.map_from_robot) <= least_m + per_metre * way &&
         degrees(rotation_between(carried, after.map_from_robot)) <= least_deg + deg_per_metre * way;
}

}  // namespace

Agreement agreement_of(std::vector<Declaration> declarations) {
  std::stable_sort(declarations.begin(), declarations.end(), [](const Declaration& a, const Declaration& b) {
    return std::tie(a.segment, a.at_m) < std::tie(b.segment, b.at_m);
  });
  Agreement agreement;
  for (std::size_t i = 1; i < declarations.size(); ++i) {
    if (declarations[i].segment != declarations[i - 1].segment) continue;
    ++agreement.pairs;
    if (!agree(declarations[i - 1], declarations[i])) agreement.disagree_at_m.push_back(declarations[i].at_m);
  }
  return agreement;
}

}  // namespace glocal
