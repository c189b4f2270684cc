#pragma once

#include <optional>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "raters/followed_pose.hpp"

namespace glocal::raters {

/// The paper's rule (Sections III-B and IV): localized once the same cluster's normalised rating has been
/// high in several consecutive steps. "The same" cluster is the one whose robot pose agrees with the last one
/// moved by the local motion. A step without clusters resets the count and is no failure.
class ConsecutiveRating final : public VerdictRule {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    double min_rating = 0.8;
    int consecutive = 3;
  };

  explicit ConsecutiveRating(const Params& params) : params_(params) {}
  [[nodiscard]] Verdict judge(const StepResult& step) override;
  [[nodiscard]] std::size_t least_steps() const override {
    return static_cast<std::size_t>(params_.consecutive);
  }
  void refute(const Verification& /*verification*/) override { last_.reset(); }
  void reset() override { last_.reset(); }

 private:
  struct Leader {
    FollowedPose pose;
    int count = 0;
  };
  [[nodiscard]] std::vector<Pose3> candidates(const StepResult& step) const;

  Params params_;
  std::optional<Leader> last_;  ///< The cluster that was rated highly in the last step.
};
void describe(ParamVisitor& v, ConsecutiveRating::Params& p);

}  // namespace glocal::raters
