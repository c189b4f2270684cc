#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "raters/followed_pose.hpp"

namespace glocal {

/// Localized once the best hypothesis has been clearly better than every rival, a pose far from it, for long
/// enough: the clearer, the sooner. The best hypothesis must stay the same, moved by the local motion;
/// another best one, or a step without any, begins anew.
class StagedMargin final : public VerdictRule {
 public:
  /// A lead in quality of at least `margin`, kept for so many steps and so far.
  struct Stage {
    double margin = 0.3;
    int steps = 3;
    double distance = 0.0;
  };
  struct Params {
    std::vector<Stage> stages = {{0.30, 3, 0.0}, {0.20, 5, 2.0}, {0.10, 5, 5.0}};
    double rival_distance = 1.0;
    double rival_rotation_deg = 30.0;
    double same_distance = 0.5;
    double same_rotation_deg = 15.0;
    double candidate_margin = 0.05;
    int max_candidates = 10;
  };

  explicit StagedMargin(const Params& params) : params_(params), leads_(params.stages.size()) {}
  [[nodiscard]] Verdict judge(const StepResult& step) override;
  void reset() override;

 private:
  /// How long a stage's margin has been kept.
  struct Lead {
    int steps = 0;
    double distance = 0.0;
  };
  [[nodiscard]] double margin(const StepResult& step) const;
  [[nodiscard]] bool continues(const StepResult& step) const;
  [[nodiscard]] std::vector<Pose2> candidates(const StepResult& step) const;
  [[nodiscard]] bool are_rivals(const Pose2& a, const Pose2& b) const;

  Params params_;
  std::vector<Lead> leads_;  ///< One for each stage.
  std::optional<FollowedPose> best_;
};
void describe(ParamVisitor& v, StagedMargin::Stage& p);
void describe(ParamVisitor& v, StagedMargin::Params& p);

}  // namespace glocal
