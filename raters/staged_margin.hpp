#pragma once

#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/params.hpp"
#include "glocal/pose_tolerance.hpp"
#include "glocal/strategies.hpp"
#include "raters/followed_pose.hpp"

namespace glocal::raters {

/// Localized once the best hypothesis has been clearly better than every rival, a pose far from it, for long
/// enough: the clearer, the sooner. The best hypothesis must stay the same, moved by the local motion;
/// another best one, a step without any, another local map, or a scan with less contact there than usual
/// begins anew, and a scan with less than `min_scan_contact` lets the stages begin anew. That, or a margin
/// below every stage's with a low confidence, takes the verdict back. Where declarations are verified, there
/// are lower stages, too, for poses that the verifier certifies to have no more contact anywhere else.
///
/// Where the matcher tells what beams say, and declarations are verified, a confidence of `min_confidence` is
/// enough, too, however little of the scan is on the map.
///
/// Believes in the best hypothesis, with a confidence by a logistic model and the covariance of the matcher,
/// widened by hypotheses near it that are about as good.
class StagedMargin final : public VerdictRule {
 public:
  static constexpr Motions motions = all_motions;

  /// A margin in score of at least `margin`, kept for so many steps and so far.
  struct Stage {
    double margin = 0.3;
    int steps = 3;
    double distance = 0.0;
  };
  struct Params {
    std::vector<Stage> stages = {{0.30, 3, 0.0}, {0.25, 4, 1.0}, {0.20, 5, 2.0}, {0.12, 8, 3.0}};
    std::vector<Stage> certified_stages = {{0.25, 2, 0.0}, {0.20, 3, 0.0}, {0.15, 4, 1.0}, {0.12, 5, 2.0}};
    double max_turn_rate_deg = 60.0;
    double max_free_space_violation = 0.4;
    double min_scan_contact = 0.75;
    double min_confidence = 0.993;
  };

  StagedMargin(const Params& params, const StageSetup& setup);
  [[nodiscard]] Verdict judge(const StepResult& step) override;
  [[nodiscard]] std::size_t least_steps() const override;
  void refute(const Verification& verification) override;
  void withhold() override { is_declared_ = false; }
  void reset() override;

 private:
  /// How long a stage's margin has been kept.
  struct Kept {
    int steps = 0;
    double distance = 0.0;
  };
  /// Stages of one kind, and how long each has been kept.
  class Stages {
   public:
    explicit Stages(std::vector<Stage> stages) : stages_(std::move(stages)), kept_(stages_.size()) {}
    void begin_anew() { kept_.assign(stages_.size(), {}); }
    /// Counts a step for each stage, if it is a look, and says whether one is reached.
    [[nodiscard]] bool is_reached(double margin, double driven, bool is_look);
    /// Whether not even the least margin was kept in the last step.
    [[nodiscard]] bool is_lost() const;
    /// Steps of the shortest stage; the largest number there is without any.
    [[nodiscard]] std::size_t least_steps() const;

   private:
    std::vector<Stage> stages_;
    std::vector<Kept> kept_;
  };
  void begin_anew();
  void begin_stages_anew();
  void count(const StepResult& step, double margin, double driven, double contact);
  [[nodiscard]] double margin_of(const StepResult& step) const;
  void follow_turn(const StepResult& step);
  [[nodiscard]] bool is_steady();
  [[nodiscard]] Verdict localized(const StepResult& step, double margin) const;
  [[nodiscard]] Verdict undecided(const StepResult& step, double margin) const;
  [[nodiscard]] std::vector<Pose3> candidates(const StepResult& step) const;

  Params params_;
  Stages stages_;
  Stages certified_stages_;  ///< None where nothing is verified.
  bool has_verifier_;
  std::optional<FollowedPose> best_;
  /// Where the robot was in the first step of the latest stamp; of no pose in the map.
  std::optional<FollowedPose> last_step_;
  double turn_rate_deg_ = 0.0;   ///< Until that step, in a second.
  int steps_ = 0;                ///< In which the best pose has been the same.
  double mean_margin_ = 0.0;     ///< In the latest of these.
  int views_ = 0;                ///< Of these, without those that see the same again.
  Pose3 last_view_;              ///< local_from_robot of the last one of them.
  double distance_ = 0.0;        ///< m; driven in these.
  bool is_declared_ = false;     ///< In one of them.
  double sum_of_contact_ = 0.0;  ///< Of the latest scan at the best pose, in each of them.
  int views_to_be_sure_;         ///< Twice as many after each refutation.
  /// Steps since the robot last turned fast; none while it has not.
  std::optional<int> since_turn_;
};
void describe(ParamVisitor& v, StagedMargin::Stage& p);
void describe(ParamVisitor& v, StagedMargin::Params& p);

}  // namespace glocal::raters
