#include "matchers/iransac/preemption.hpp"

#include <algorithm>
#include <functional>
#include <limits>

#include "glocal/parallel.hpp"

namespace glocal::iransac {

std::size_t left_after(std::size_t hypotheses, std::size_t observations, std::size_t block) {
  const std::size_t halvings = observations / block;
  return halvings < std::numeric_limits<std::size_t>::digits ? hypotheses >> halvings : 0;
}

std::size_t preempt(std::vector<ScoredPose>& hypotheses, const ContactIndex& contact, const Points& all,
                    const Points& latest, const PreemptionRule& rule, int threads) {
  struct Contender {
    ScoredPose pose;
    const Points* points;
  };
  std::vector<Contender> contenders;
  for (const ScoredPose& pose : hypotheses) {
    contenders.push_back({pose, pose.looked_at == 0 ? &all : &latest});
  }
  std::size_t points_tested = 0;
  const std::size_t most = std::max(all.size(), latest.size());
  for (std::size_t begin = 0; begin < most; begin += rule.block) {
    parallel_for(threads, contenders.size(), [&](std::size_t i) {
      auto& [pose, points] = contenders[i];
      if (begin >= points->size()) return;
      const std::size_t n = std::min(rule.block, points->size() - begin);
      pose.in_contact += contact.count(*points, begin, n, Transform(pose.map_from_local));
      pose.looked_at += n;
    });
    points_tested += contenders.size() * rule.block;
    std::ranges::stable_sort(contenders, std::greater<>(), [](const Contender& c) { return c.pose.score(); });
    const std::size_t left =
        std::max(rule.fewest, left_after(hypotheses.size(), begin + rule.block, rule.block));
    contenders.resize(std::min(left, contenders.size()));
    if (contenders.size() <= rule.fewest) break;
  }
  hypotheses.clear();
  for (const Contender& contender : contenders) hypotheses.push_back(contender.pose);
  return points_tested;
}

}  // namespace glocal::iransac
