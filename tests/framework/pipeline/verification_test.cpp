// What becomes of a declaration that a verifier looks at.
#include <gmock/gmock.h>

#include <string>

#include "files.hpp"
#include "framework/pipeline/fakes.hpp"
#include "glocal/error.hpp"
#include "glocal/localizer.hpp"

namespace glocal::test::verification_test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::EndsWith;
using testing::HasSubstr;
using testing::Not;

class WithVerifier : public testing::Test {
 protected:
  WithVerifier() : localizer_(follow(script_, true), registered(catalog_), {map_of_one_point(), 1}, 1) {
    script_->local.points.push_back({});
    script_->local.ends = {1};
    const Hypothesis best{.map_from_local = declared_, .quality = 0.9, .score = 0.8};
    script_->match = [=](double, Rng&) { return MatchResult{{best}, 1, 1}; };
    script_->r = {1.0};
    script_->judge = [this](const StepResult&) {
      return Verdict{VerdictKind::localized, declared_, {}, "sure", PoseEstimate{declared_, 0.99}};
    };
  }

  static const Catalog& registered(Catalog& catalog) {
    register_fake_stages(catalog);
    return catalog;
  }

  /// What the verifier finds from now on: rivals with these scores, 5 m apart.
  void find(const std::vector<double>& scores, bool is_complete = true) {
    Verification found{.near = {.translation = 1.0, .rotation = 0.5}, .margin = 0.1};
    for (std::size_t i = 0; i < scores.size(); ++i)
      found.rivals.push_back(
          Hypothesis::by_contact(Pose2{5.0 * static_cast<double>(i + 1), 0.0, 0.0}, scores[i]));
    if (is_complete) found.certificate = {.contact = 0.9, .at_most = 0.85, .epsilon = 0.1, .delta = 0.14};
    script_->verify = [found](const Pose3&) { return found; };
  }

  StepResult step() {
    script_->calls.clear();
    return localizer_.step({});
  }

  const Pose3 declared_ = Pose2{0.2, 0.1, 0.0};
  std::shared_ptr<Script> script_ = std::make_shared<Script>();
  Catalog catalog_;
  Localizer localizer_;
};

TEST_F(WithVerifier, ADeclarationWithoutRivalStandsAndTellsItsCertificate) {
  find({0.65});
  const StepResult result = step();
  EXPECT_EQ(result.verdict.kind, VerdictKind::localized);
  EXPECT_EQ(result.verdict.why, "sure; 90 % contact, and at most 85 % at any pose elsewhere");
  ASSERT_TRUE(result.verification);
  EXPECT_FALSE(result.verification->is_refuted);
  EXPECT_EQ(result.verification->score, 0.8);
  EXPECT_EQ(result.verification->certificate->at_most, 0.85);
  EXPECT_THAT(script_->calls, Contains("rescore"));
}

TEST_F(WithVerifier, AnotherPoseThatIsDeclaredIsVerifiedInItsTurn) {
  find({});
  Pose3 declared = declared_;
  script_->judge = [&](const StepResult&) {
    return Verdict{VerdictKind::localized, declared, {}, "sure", PoseEstimate{declared, 0.99}};
  };
  EXPECT_TRUE(step().verification);
  // A local map that drifts takes its pose along, by less than what makes a rival each time.
  for (const double x : {0.9, 1.7, 2.5}) {
    declared = Pose2{x, 0.1, 0.0};
    EXPECT_FALSE(step().verification) << x;
  }
  declared = Pose2{8.0, 0.1, 0.0};
  const StepResult jumped = step();
  ASSERT_TRUE(jumped.verification);
  EXPECT_EQ(jumped.verdict.kind, VerdictKind::localized);
  EXPECT_FALSE(step().verification);
  ++script_->local.epoch;
  EXPECT_TRUE(step().verification) << "of another local map";
}

TEST_F(WithVerifier, ARivalWithinTheMarginRefutesIt) {
  find({0.95, 0.72, 0.65});
  const StepResult result = step();
  EXPECT_EQ(result.verdict.kind, VerdictKind::ambiguous);
  EXPECT_FALSE(result.verdict.map_from_robot);
  EXPECT_THAT(result.verdict.candidates, ElementsAre(declared_, Pose2{5, 0, 0}, Pose2{10, 0, 0}));
  EXPECT_THAT(result.verdict.why, HasSubstr("found 2 others about as good"));
  EXPECT_DOUBLE_EQ(result.verdict.estimate->confidence, 1.0 / 3.0);
  EXPECT_TRUE(result.verification->is_refuted);
  EXPECT_EQ(script_->calls.back(), "refute");
}

TEST_F(WithVerifier, APoseThatTheMatcherHasBroughtBackToTheDeclaredOneIsNoRival) {
  script_->verify = [](const Pose3&) {
    Verification found{.near = {.translation = 1.0, .rotation = 0.5}, .margin = 0.1};
    found.rivals = {Hypothesis::by_contact(Pose2{0.9, 0.1, 0.1}, 0.95)};
    found.certificate = {.contact = 0.9, .at_most = 0.95};
    return found;
  };
  const StepResult result = step();
  EXPECT_EQ(result.verdict.kind, VerdictKind::localized);
  EXPECT_TRUE(result.verification->rivals.empty());
}

TEST_F(WithVerifier, AVerdictThatNeedsACertificateStandsOnlyIfNoPoseElsewhereHasMoreContact) {
  script_->judge = [this](const StepResult&) {
    Verdict verdict{VerdictKind::localized, declared_, {}, "sure"};
    verdict.needs_certificate = true;
    return verdict;
  };
  find({});
  EXPECT_EQ(step().verdict.kind, VerdictKind::localized);
  localizer_.reset(1);
  script_->verify = [](const Pose3&) {
    Verification found;
    found.certificate = {.contact = 0.9, .at_most = 0.92};
    return found;
  };
  const StepResult result = step();
  EXPECT_EQ(result.verdict.kind, VerdictKind::searching);
  EXPECT_THAT(result.verdict.why,
              EndsWith("it has 90 % contact, and up to 92 % cannot be ruled out elsewhere"));
  EXPECT_TRUE(result.verification->is_refuted);
}

TEST_F(WithVerifier, ASearchThatWasGivenUpDeclaresNothing) {
  find({}, false);
  const StepResult result = step();
  EXPECT_EQ(result.verdict.kind, VerdictKind::searching);
  EXPECT_FALSE(result.verdict.map_from_robot);
  EXPECT_THAT(result.verdict.why, HasSubstr("given up"));
}

TEST_F(WithVerifier, WhatFitsBetterInAMirrorIsAFaultOfTheSetUp) {
  script_->verify = [](const Pose3&) {
    return Verification{
        .certificate = Certificate{.contact = 0.8, .at_most = 0.7, .epsilon = 0.1, .delta = 0.14},
        .mirrored_contact = 0.95,
        .is_mirrored = true};
  };
  const StepResult result = step();
  EXPECT_EQ(result.verdict.kind, VerdictKind::searching);
  EXPECT_FALSE(result.verdict.map_from_robot);
  EXPECT_TRUE(result.verification->is_refuted);
  EXPECT_EQ(result.setup.value().fault, SetupFault::mirrored);
  EXPECT_THAT(result.verdict.why, HasSubstr("left and right"));
}

TEST_F(WithVerifier, WhatFitsALittleBetterInAMirrorIsRefutedAndNoFault) {
  script_->verify = [](const Pose3&) {
    return Verification{
        .certificate = Certificate{.contact = 0.8, .at_most = 0.7, .epsilon = 0.1, .delta = 0.14},
        .mirrored_contact = 0.86};
  };
  const StepResult result = step();
  EXPECT_TRUE(result.verification->is_refuted);
  EXPECT_FALSE(result.setup && result.setup->fault);
  EXPECT_THAT(result.verdict.why, EndsWith("its mirror image fits better: 86 % contact"));
}

TEST_F(WithVerifier, WhatIsDeclaredIsVerifiedOnceAndAnewOnceItWasLost) {
  find({});
  EXPECT_TRUE(step().verification);
  EXPECT_FALSE(step().verification);
  EXPECT_EQ(step().verdict.kind, VerdictKind::localized);
  const auto sure = script_->judge;
  script_->judge = [](const StepResult&) { return Verdict{VerdictKind::searching, {}, {}, "lost"}; };
  EXPECT_FALSE(step().verification);
  script_->judge = sure;
  EXPECT_TRUE(step().verification);
  localizer_.reset(1);
  EXPECT_TRUE(step().verification);
}

TEST_F(WithVerifier, WhatWasRefutedIsVerifiedInEachStep) {
  find({0.9});
  EXPECT_TRUE(step().verification);
  find({});
  EXPECT_EQ(step().verdict.kind, VerdictKind::localized);
}

TEST_F(WithVerifier, NothingIsDeclaredWhileTheSearchGoesOn) {
  script_->verify = [](const Pose3&) { return Verification{.goes_on = true}; };
  for (int i = 0; i < 2; ++i) {
    const StepResult result = step();
    EXPECT_EQ(result.verdict.kind, VerdictKind::searching);
    EXPECT_FALSE(result.verdict.map_from_robot);
    EXPECT_THAT(result.verdict.why, HasSubstr("goes on"));
    EXPECT_FALSE(result.verification->is_refuted);
    EXPECT_THAT(script_->calls, Not(Contains("refute")));
  }
  find({});
  EXPECT_EQ(step().verdict.kind, VerdictKind::localized);
  EXPECT_THAT(script_->calls, Not(Contains("forget verification")));
}

TEST_F(WithVerifier, ASearchThatGoesOnIsForgottenOnceNothingIsToBeDeclared) {
  script_->verify = [](const Pose3&) { return Verification{.goes_on = true}; };
  step();
  const auto sure = script_->judge;
  script_->judge = [](const StepResult&) { return Verdict{VerdictKind::searching, {}, {}, "lost"}; };
  step();
  EXPECT_THAT(script_->calls, Contains("forget verification"));
  step();
  EXPECT_THAT(script_->calls, Not(Contains("forget verification"))) << "there is none any more";
  script_->judge = sure;
  step();
  script_->calls.clear();
  localizer_.reset(1);
  EXPECT_THAT(script_->calls, Contains("forget verification"));
}

TEST_F(WithVerifier, ASearchGoesOnWithoutAStepToTheSameAnswer) {
  EXPECT_THROW(static_cast<void>(localizer_.go_on()), std::logic_error);
  script_->verify = [](const Pose3&) { return Verification{.points_tested = 10, .goes_on = true}; };
  const StepResult first = step();
  const StepResult second = localizer_.go_on();
  EXPECT_EQ(second.verdict.why, first.verdict.why);
  EXPECT_EQ(second.verification->points_tested, 20U);
  find({});
  script_->calls.clear();
  const StepResult last = localizer_.go_on();
  EXPECT_THAT(script_->calls, ElementsAre("verify", "rescore"));
  EXPECT_EQ(last.step, first.step);
  EXPECT_EQ(last.verdict.kind, VerdictKind::localized);
  EXPECT_EQ(last.verdict.map_from_robot, declared_);
  EXPECT_EQ(last.verdict.why, "sure; 90 % contact, and at most 85 % at any pose elsewhere");
  EXPECT_EQ(last.verification->points_tested, 20U);
  EXPECT_THROW(static_cast<void>(localizer_.go_on()), std::logic_error);
  EXPECT_EQ(step().verdict.why, "sure") << "it is verified";
}

TEST_F(WithVerifier, AStepIsJudgedOnceItsMatchHasComeToItsEnd) {
  script_->verify = [](const Pose3&) { return Verification{.goes_on = true}; };
  script_->searches = 2;
  const StepResult first = step();
  EXPECT_TRUE(first.goes_on());
  EXPECT_EQ(first.verdict.kind, VerdictKind::searching);
  EXPECT_THAT(first.verdict.why, HasSubstr("goes on"));
  EXPECT_THAT(script_->calls, Not(Contains("judge")));
  script_->calls.clear();
  EXPECT_TRUE(localizer_.go_on(5).is_matching);
  const StepResult matched = localizer_.go_on(6);
  EXPECT_THAT(script_->calls,
              ElementsAre("match 5", "match 6", "update", "cluster", "rate", "judge", "verify"));
  EXPECT_TRUE(matched.is_verifying());
  EXPECT_EQ(matched.verdict.kind, VerdictKind::searching);
  find({});
  const StepResult last = localizer_.go_on(7);
  EXPECT_EQ(last.verdict.kind, VerdictKind::localized);
  EXPECT_FALSE(last.goes_on());
  EXPECT_EQ(last.step, first.step);
  EXPECT_GT(last.stage_ms.after, matched.stage_ms.after);
  EXPECT_EQ(last.stage_ms.match, first.stage_ms.match);
  EXPECT_THROW(static_cast<void>(localizer_.go_on()), std::logic_error);
}

TEST_F(WithVerifier, WhereTheNextScanComesTheLastStepIsJudgedByWhatWasFound) {
  script_->searches = 1;
  step();
  script_->searches = 0;
  EXPECT_FALSE(step().goes_on());
  std::vector<std::string> judged;
  for (const std::string& call : script_->calls)
    if (call == "judge" || call == "add") judged.push_back(call);
  EXPECT_THAT(judged, ElementsAre("judge", "add", "judge"));
}

TEST_F(WithVerifier, WhatGoesOnWithoutAStepMayBeRefutedAndIsForgottenByAReset) {
  script_->verify = [](const Pose3&) { return Verification{.goes_on = true}; };
  step();
  find({0.9});
  EXPECT_EQ(localizer_.go_on().verdict.kind, VerdictKind::ambiguous);
  EXPECT_THAT(script_->calls, Contains("refute"));
  script_->verify = [](const Pose3&) { return Verification{.goes_on = true}; };
  step();
  localizer_.reset(1);
  EXPECT_THROW(static_cast<void>(localizer_.go_on()), std::logic_error);
}

TEST_F(WithVerifier, WithoutOneDeclarationsStand) {
  Localizer unverified(follow(script_), catalog_, {map_of_one_point(), 1}, 1);
  const StepResult result = unverified.step({});
  EXPECT_EQ(result.verdict.kind, VerdictKind::localized);
  EXPECT_EQ(result.verdict.why, "sure");
  EXPECT_FALSE(result.verification);
}

TEST_F(WithVerifier, TheVerifierIsAskedOfTheLocalMapsPose) {
  script_->local.local_from_robot = Pose2{1.0, 0.0, 0.0};
  Pose3 asked;
  script_->verify = [&](const Pose3& map_from_local) {
    asked = map_from_local;
    return Verification{};
  };
  step();
  EXPECT_NEAR(asked.x, declared_.x - 1.0, 1e-12);
}

TEST_F(WithVerifier, NamesAVerifierThatBreaksItsContract) {
  find({1.5});
  EXPECT_EQ(error_of<StrategyError>([&] { return step(); }),
            "verifier 'fake' breaks its contract in step 0: hypothesis 0 has the quality 1.5, not in [0, 1]");
}

}  // namespace
}  // namespace glocal::test::verification_test
