// Stages that do what a test tells them, and note what is asked of them.
#pragma once

#include <functional>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/localizer.hpp"
#include "points.hpp"

namespace glocal::test {

/// What the stages answer, shared by all of them and the test.
struct Script {
  std::vector<std::string> calls;  ///< In order.
  LocalMap local;                  ///< What the mapper shows, whatever is added.
  double omega_max = 0.3;          ///< Before the first update.
  double updated_omega_max = 0.3;  ///< After it.
  std::function<MatchResult(double omega_max, Rng& rng)> match = [](double, Rng&) { return MatchResult{}; };
  std::size_t searches = 0;  ///< Calls of the matcher's go_on() until the match is over.
  std::function<void(Rng& rng)> cluster = [](Rng&) {};
  std::vector<double> r;         ///< Of the clusters, in the order of their hypotheses.
  PoseGate gate;                 ///< What the matcher was told last.
  std::vector<double> epsilons;  ///< For which a matcher was made.
  std::function<Verdict(const StepResult&)> judge = [](const StepResult&) { return Verdict{}; };
  std::function<Verification(const Pose3& map_from_local)> verify = [](const Pose3&) {
    return Verification{};
  };
};

struct FakeParams {
  std::shared_ptr<Script> script;
};
inline void describe(ParamVisitor& /*v*/, FakeParams& /*p*/) {}

template <class Interface>
class Fake : public Interface {
 public:
  using Params = FakeParams;
  static constexpr Motions motions = all_motions;
  explicit Fake(const Params& params) : script_(params.script) {}

 protected:
  void note(const std::string& call) const { script_->calls.push_back(call); }
  std::shared_ptr<Script> script_;
};

struct FakeMapper final : Fake<LocalMapper> {
  using Fake::Fake;
  void add(const Observation& /*observation*/) override { note("add"); }
  [[nodiscard]] const LocalMap& map() const override { return script_->local; }
  void reset() override { note("reset local map"); }
};

struct FakeMatcher final : Fake<Matcher> {
  FakeMatcher(const Params& params, const StageSetup& setup) : Fake(params) {
    script_->epsilons.push_back(setup.contact_epsilon);
  }
  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override {
    note("match");
    script_->gate = request.gate;
    MatchResult result = script_->match(request.omega_max, rng);
    result.goes_on = script_->searches > 0;
    return result;
  }
  [[nodiscard]] MatchResult go_on(const LocalMap& /*local*/, std::size_t looks) override {
    note("match " + std::to_string(looks));
    Rng rng(0);
    MatchResult result = script_->match(script_->omega_max, rng);
    result.goes_on = --script_->searches > 0;
    return result;
  }
  [[nodiscard]] std::vector<Hypothesis> rescore(std::vector<Hypothesis> found,
                                                const LocalMap& /*local*/) override {
    note("rescore");
    return found;
  }
  void reset() override { note("reset matcher"); }
};

/// Each hypothesis is a cluster.
struct FakeClusterer final : Fake<Clusterer> {
  using Fake::Fake;
  [[nodiscard]] std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses, Rng& rng) override {
    note("cluster");
    script_->cluster(rng);
    std::vector<Cluster> clusters;
    for (std::size_t i = 0; i < hypotheses.size(); ++i)
      clusters.push_back({{i}, hypotheses[i].map_from_robot});
    return clusters;
  }
};

struct FakeRater final : Fake<Rater> {
  using Fake::Fake;
  [[nodiscard]] std::vector<Rating> rate(const std::vector<Cluster>& clusters,
                                         const std::vector<Hypothesis>& /*hypotheses*/) override {
    note("rate");
    const double sum = std::accumulate(script_->r.begin(), script_->r.end(), 0.0);
    std::vector<Rating> ratings;
    for (std::size_t i = 0; i < clusters.size(); ++i)
      ratings.push_back({script_->r.at(i), script_->r.at(i) / sum});
    return ratings;
  }
};

struct FakeThreshold final : Fake<ThresholdPolicy> {
  using Fake::Fake;
  [[nodiscard]] double omega_max() const override {
    note("omega_max");
    return updated_ ? script_->updated_omega_max : script_->omega_max;
  }
  void update(const std::vector<Hypothesis>& /*hypotheses*/) override {
    note("update");
    updated_ = true;
  }
  void reset() override {
    note("reset threshold");
    updated_ = false;
  }

 private:
  bool updated_ = false;
};

struct FakeVerdict final : Fake<VerdictRule> {
  using Fake::Fake;
  [[nodiscard]] Verdict judge(const StepResult& step) override {
    note("judge");
    return script_->judge(step);
  }
  void refute(const Verification& /*verification*/) override { note("refute"); }
  void reset() override { note("reset verdict"); }
};

struct FakeVerifier final : Fake<Verifier> {
  using Fake::Fake;
  [[nodiscard]] Verification verify(const LocalMap& /*local*/, const Pose3& map_from_local,
                                    const PoseGate& /*gate*/) override {
    note("verify");
    return script_->verify(map_from_local);
  }
  void reset() override { note("forget verification"); }
};

/// Delivers what it is given.
class GivenMap : public MapSource {
 public:
  struct Params {
    MapData map;
  };
  explicit GivenMap(Params params) : map_(std::move(params.map)) {}
  [[nodiscard]] MapData load() override { return map_; }

 private:
  MapData map_;
};
inline void describe(ParamVisitor& /*v*/, GivenMap::Params& /*p*/) {}

/// Delivers what it is given.
class ListedSamples : public ObservationSource {
 public:
  struct Params {
    std::vector<Sample> samples;
  };
  explicit ListedSamples(Params params) : samples_(std::move(params.samples)) {}
  [[nodiscard]] std::optional<Sample> next() override {
    return next_ < samples_.size() ? std::optional(samples_[next_++]) : std::nullopt;
  }

 private:
  std::vector<Sample> samples_;
  std::size_t next_ = 0;
};
inline void describe(ParamVisitor& /*v*/, ListedSamples::Params& /*p*/) {}

inline void register_fake_stages(Catalog& catalog) {
  catalog.local_mappers.add<FakeMapper>("fake", "Shows a given map.");
  catalog.matchers.add<FakeMatcher>("fake", "Gives given hypotheses.");
  catalog.clusterers.add<FakeClusterer>("fake", "Puts each hypothesis into a cluster.");
  catalog.raters.add<FakeRater>("fake", "Gives given ratings.");
  catalog.threshold_policies.add<FakeThreshold>("fake", "Gives given thresholds.");
  catalog.verdict_rules.add<FakeVerdict>("fake", "Gives given verdicts.");
  catalog.verifiers.add<FakeVerifier>("fake", "Gives given verifications.");
  catalog.verifiers.add_none("none", "Verifies nothing.", {});
}

/// All stages follow one script, the verifier only if there is to be one; no place is unknown, and the
/// set-up is not checked.
inline LocalizerConfig follow(const std::shared_ptr<Script>& script, bool is_verified = false) {
  const auto stage = [&] {
    auto params = std::make_unique<ParamsOf<FakeParams>>();
    params->value.script = script;
    return StrategyChoice{"fake", std::move(params)};
  };
  return {.contact_epsilon = {},
          .local_mapper = stage(),
          .matcher = stage(),
          .clusterer = stage(),
          .rater = stage(),
          .threshold_policy = stage(),
          .verdict_rule = stage(),
          .verifier = is_verified ? stage() : StrategyChoice{"none", {}},
          .unknown_place = {.max_contact = 0.0},
          .setup_check = {.enabled = false}};
}

/// A map with one point, at the origin, and no grid.
inline std::shared_ptr<const GlobalMap> map_of_one_point() {
  return map_of(points_of({{0.0F, 0.0F, 0.0F}}));
}

}  // namespace glocal::test
