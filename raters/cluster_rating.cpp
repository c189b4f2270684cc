#include "raters/cluster_rating.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "raters/mean_score.hpp"
#include "raters/normalise.hpp"

namespace glocal::raters {
namespace {

/// Variance of heading, or of rotation about another axis, at which the third term of eq. 7 is 0; as
/// hierarchical_kmeans has it.
constexpr double max_variance_rotation_deg2 = 50.0;

}  // namespace

void describe(ParamVisitor& v, ClusterRating::Params& p) {
  v.field("weights", p.weights,
          {.doc = "alpha_1 (size), alpha_2 (spread in translation), alpha_3 (spread in rotation) and alpha_4 "
                  "(mean score) "
                  "of eq. 7; they add up to 1.",
           .min = 0.0,
           .max = 1.0,
           .min_items = 4,
           .max_items = 4});
  v.require(std::abs(std::accumulate(p.weights.begin(), p.weights.end(), 0.0) - 1.0) < 1e-9, "weights",
            "the four weights must add up to 1 (eq. 7)");
  v.field("max_variance_translation", p.max_variance_translation,
          {.doc = "Variance along x, y or z at which the second term of eq. 7 is 0; the clusterer's value.",
           .unit = "m^2",
           .above = 0.0});
}

std::vector<Rating> ClusterRating::rate(const std::vector<Cluster>& clusters,
                                        const std::vector<Hypothesis>& hypotheses) {
  std::vector<Rating> ratings(clusters.size());
  double all_support = 0.0;
  for (const Hypothesis& hypothesis : hypotheses) all_support += static_cast<double>(hypothesis.support);
  for (std::size_t i = 0; i < clusters.size(); ++i) {
    ratings[i].r = rate_one(clusters[i], hypotheses, all_support);
  }
  normalise(ratings);
  return ratings;
}

/// eq. 7. A cluster from another clusterer may be spread more widely than the limits: the terms of spread
/// stop at 0. A rating is more than 0 (eq. 8 divides by their sum): r stays in ]0, 1].
double ClusterRating::rate_one(const Cluster& cluster, const std::vector<Hypothesis>& hypotheses,
                               double all_support) const {
  const double degree = radians(1.0);
  const double max_variance_rotation = max_variance_rotation_deg2 * degree * degree;
  double support = 0.0;
  for (const std::size_t i : cluster.members) support += static_cast<double>(hypotheses[i].support);
  const double score = mean_score(hypotheses, cluster.members);

  const double share = support / all_support;
  const double variance = std::max({cluster.variance_x, cluster.variance_y, cluster.variance_z});
  const double variance_rotation =
      std::max({cluster.variance_theta, cluster.variance_about_x, cluster.variance_about_y});
  const double narrow = std::max(0.0, 1.0 - variance / params_.max_variance_translation);
  const double straight = std::max(0.0, 1.0 - variance_rotation / max_variance_rotation);
  const std::vector<double>& alpha = params_.weights;
  constexpr double least = 1e-6;
  // The weights add up to 1, but for what is rounded.
  return std::clamp(alpha[0] * share + alpha[1] * narrow + alpha[2] * straight + alpha[3] * score, least,
                    1.0);
}

}  // namespace glocal::raters
