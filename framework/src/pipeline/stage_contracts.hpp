// What is checked of the answers of sources and stages, so that a strategy that breaks its contract is named,
// and does not bring down the stages after it. Each check looks at every value once; the clauses are those of
// strategies.hpp. All throw BrokenContract.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <stdexcept>
#include <vector>

#include "glocal/strategies.hpp"

namespace glocal {

/// what() says what the answer is and what it should be.
class BrokenContract : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Throws what is broken if the clause does not hold.
template <class... Values>
void require(bool holds, fmt::format_string<const Values&...> broken, const Values&... values) {
  if (!holds) throw BrokenContract(fmt::format(broken, values...));
}

void check_map(const MapData& map, Motion motion);
void check_sample(const Sample& sample, Motion motion);
void check_observation(const Observation& observation, Motion motion);
void check_local_map(const LocalMap& local, Motion motion);
void check_threshold(double omega_max);
/// Of a matcher: scores fall, and reach omega_max.
void check_hypotheses(const std::vector<Hypothesis>& hypotheses, double omega_max, Motion motion);
void check_clusters(const std::vector<Cluster>& clusters, std::size_t hypotheses, Motion motion);
void check_ratings(const std::vector<Rating>& ratings, std::size_t clusters);
void check_verdict(const Verdict& verdict, Motion motion);
void check_verification(const Verification& verification, Motion motion);

}  // namespace glocal
