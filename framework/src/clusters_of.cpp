#include "glocal/clusters_of.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace glocal {

std::vector<double> supports(const std::vector<Hypothesis>& hypotheses) {
  std::vector<double> weights;
  weights.reserve(hypotheses.size());
  for (const Hypothesis& h : hypotheses) weights.push_back(static_cast<double>(h.support));
  return weights;
}

std::vector<Cluster> clusters_of(const std::vector<Hypothesis>& hypotheses,
                                 const std::vector<std::size_t>& labels) {
  const std::size_t none = labels.size();
  if (none != hypotheses.size() ||
      std::ranges::any_of(labels, [&](std::size_t label) { return label >= none; }))
    throw std::invalid_argument("each hypothesis needs a label below the number of hypotheses");
  std::vector<std::size_t> cluster_with(labels.size(), none);
  std::vector<std::vector<std::size_t>> members;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    std::size_t& cluster = cluster_with[labels[i]];
    if (cluster == none) {
      cluster = members.size();
      members.emplace_back();
    }
    members[cluster].push_back(i);
  }
  std::vector<Cluster> clusters;
  clusters.reserve(members.size());
  for (std::vector<std::size_t>& of_one : members)
    clusters.push_back(make_cluster(hypotheses, std::move(of_one)));
  return clusters;
}

}  // namespace glocal
