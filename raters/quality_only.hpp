#pragma once

#include <string>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"

namespace glocal::raters {

/// A cluster is rated by the score of its best hypothesis, or by the mean of all: where a matcher gives one
/// hypothesis for each pose, the size of clusters says nothing. Normalised by eq. 8.
class QualityOnly final : public Rater {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    std::string quality = "best";
  };

  explicit QualityOnly(const Params& params) : params_(params) {}
  [[nodiscard]] std::vector<Rating> rate(const std::vector<Cluster>& clusters,
                                         const std::vector<Hypothesis>& hypotheses) override;

 private:
  Params params_;
};
void describe(ParamVisitor& v, QualityOnly::Params& p);

}  // namespace glocal::raters
