// Strategies that break what their kind promises are found out, each at what it breaks.
#include "glocal/contract.hpp"

#include <gmock/gmock.h>

#include <stdexcept>
#include <thread>

#include "glocal/clusters_of.hpp"
#include "glocal/contact.hpp"
#include "glocal/error.hpp"

namespace glocal::test::contract_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// What a toy does wrong; empty if nothing.
struct Wrong {
  std::string wrong;
};
void describe(ParamVisitor& v, Wrong& p) {
  v.field("wrong", p.wrong, {.doc = "What is wrong."});
}

/// Something that is different each time, as what two runs do not share.
int different() {
  static int calls = 0;
  return ++calls;
}

struct ToyMatcher final : Matcher {
  using Params = Wrong;
  ToyMatcher(const Params& params, const StageSetup& setup)
      : wrong(params.wrong), threads(setup.threads), contact(setup.map->points(), setup.contact_epsilon) {}
  MatchResult match(const MatchRequest& request, Rng& rng) override {
    const LocalMap& local = request.local;
    MatchResult result;
    if (local.points.empty() && wrong != "empty map") return result;
    ++asked;
    // Near where the robot of the trial is, whatever it does not know of the room.
    Pose3 pose = Pose2{5.5, 2.5, 0.7} * inverse(local.local_from_robot);
    pose.x += 0.01 * rng.uniform();
    if (wrong == "random") pose.x += 1e-6 * different();
    if (wrong == "threads") pose.x += 1e-6 * threads;
    if (wrong == "memory") pose.x += 1e-6 * asked;
    const double omega = contact.share(local.points, pose);
    result.hypotheses.push_back(Hypothesis::by_contact(pose, wrong == "quality" ? 1.0 - omega / 2.0 : omega));
    if (wrong == "threshold") result.hypotheses.back().score = request.omega_max / 2.0;
    if (wrong == "throws") throw std::runtime_error("no luck");
    return result;
  }
  void reset() override {}
  std::string wrong;
  int threads, asked = 0;
  KdTreeContact contact;
};

struct ToyClusterer final : Clusterer {
  using Params = Wrong;
  explicit ToyClusterer(const Params& params) : wrong(params.wrong) {}
  std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses, Rng& rng) override {
    const auto other_each_time = static_cast<std::size_t>(2 + different() % 3);
    std::vector<std::size_t> labels;
    for (std::size_t i = 0; i < hypotheses.size(); ++i)
      labels.push_back(wrong == "random" ? i % other_each_time : rng.below(3));
    std::vector<Cluster> clusters = clusters_of(hypotheses, labels);
    if (wrong == "loses one" && !clusters.empty()) clusters.front().members.pop_back();
    if (wrong == "one more" && hypotheses.empty()) clusters.emplace_back();
    return clusters;
  }
  std::string wrong;
};

struct ToyRater final : Rater {
  using Params = Wrong;
  explicit ToyRater(const Params& params) : wrong(params.wrong) {}
  std::vector<Rating> rate(const std::vector<Cluster>& clusters,
                           const std::vector<Hypothesis>& /*hypotheses*/) override {
    const double share = clusters.empty() ? 0.0 : 1.0 / static_cast<double>(clusters.size());
    std::vector<Rating> ratings(clusters.size(), {0.5, wrong == "sum" ? 0.9 : share});
    if (wrong == "random" && !ratings.empty()) ratings.front().r = 1.0 / different();
    return ratings;
  }
  std::string wrong;
};

struct ToyThreshold final : ThresholdPolicy {
  using Params = Wrong;
  explicit ToyThreshold(const Params& params) : wrong(params.wrong) {}
  double omega_max() const override {
    if (wrong == "by itself") return 1.0 / different();
    return wrong == "above 1" && now > 0.6 ? 1.5 : now;
  }
  void update(const std::vector<Hypothesis>& hypotheses) override { now = hypotheses.empty() ? 0.5 : 0.7; }
  void reset() override {
    if (wrong != "keeps") now = 0.4;
  }
  std::string wrong;
  double now = 0.4;
};

struct ToyRule final : VerdictRule {
  using Params = Wrong;
  explicit ToyRule(const Params& params) : wrong(params.wrong) {}
  Verdict judge(const StepResult& step) override {
    if (step.clusters.empty()) return {VerdictKind::searching, {}, {}, "nothing is there"};
    if (++steps < 3) return {VerdictKind::searching, {}, {}, wrong == "silent" ? "" : "too early"};
    Pose3 pose = step.clusters.front().map_from_robot;
    if (wrong == "random") pose.x += 1e-6 * different();
    if (wrong == "no pose") return {VerdictKind::localized, {}, {}, "three steps"};
    return {VerdictKind::localized, pose, {}, "three steps"};
  }
  std::size_t least_steps() const override { return wrong == "least" ? 5 : 3; }
  void reset() override {
    if (wrong != "keeps") steps = 0;
  }
  std::string wrong;
  int steps = 0;
};

struct ToyMapper final : LocalMapper {
  using Params = Wrong;
  explicit ToyMapper(const Params& params) : wrong(params.wrong) {}
  void add(const Observation& observation) override {
    if (!begin) begin = wrong == "origin" ? Pose3{} : observation.odom_from_robot;
    local.local_from_robot = inverse(*begin) * observation.odom_from_robot;
    const Points hits = moved(observation.scan.hits, local.local_from_robot);
    if (wrong == "blind" && hits.empty()) local.points.push_back({1.0F, 0.0F, 0.0F});
    for (std::size_t i = 0; i < hits.size(); ++i) local.points.push_back(hits[i]);
    local.ends.push_back(local.points.size());
  }
  const LocalMap& map() const override { return local; }
  void reset() override {
    begin.reset();
    if (wrong != "keeps") local = {};
  }
  std::string wrong;
  std::optional<Pose3> begin;
  LocalMap local;
};

struct ToySource final : ObservationSource {
  using Params = Wrong;
  explicit ToySource(const Params& params) : wrong(params.wrong) {}
  std::optional<Sample> next() override {
    if (++given >= 4) {
      if (wrong == "again") given = 0;
      return std::nullopt;
    }
    Sample sample;
    sample.observation.stamp = wrong == "random" ? different() : given;
    if (wrong == "random times") {
      sample.observation.scan.hits.push_back({1.0F, 0.0F, 0.0F});
      sample.observation.scan.times.push_back(static_cast<float>(different()));
    }
    return sample;
  }
  std::string wrong;
  int given = 0;
};

struct ToyMap final : MapSource {
  using Params = Wrong;
  static constexpr Motions motions = motions_in_space;
  explicit ToyMap(const Params& params) : wrong(params.wrong) {}
  MapData load() override {
    MapData map;
    map.points.push_back({1.0F, 2.0F, 3.0F});
    map.path = {Pose3(Vector3{0.0, 0.0, 1.0})};
    map.resolution = wrong == "random" ? different() : 0.1;
    return map;
  }
  std::string wrong;
};

struct ToyIndex final : ContactIndex {
  using Params = Wrong;
  ToyIndex(const Params& params, const ContactSetup& setup)
      : wrong(params.wrong), contact(*setup.map_points, setup.epsilon) {}
  std::size_t count(const Points& points, std::size_t begin, std::size_t n,
                    const Transform& map_from_points) const override {
    if (wrong == "begin") begin = 0;
    return contact.count(points, begin, n, wrong == "frame" ? Transform(Pose2{}) : map_from_points);
  }
  std::size_t memory_bytes() const override { return 0; }
  std::string wrong;
  KdTreeContact contact;
};

struct ToyLink final : MessageLink {
  using Params = Wrong;
  explicit ToyLink(const Params& params) : wrong(params.wrong) {}
  void subscribe(const LiveTopic& /*topic*/, Delivery /*delivery*/) override {
    if (wrong != "subscribes") throw ConfigError("", "no type is known");
  }
  std::optional<LiveMessage> next(std::chrono::milliseconds longest) override {
    if (wrong == "waits") std::this_thread::sleep_for(11 * longest);
    if (wrong == "speaks") return LiveMessage{};
    return std::nullopt;
  }
  void publish(const LiveTopic& /*topic*/, Delivery /*delivery*/, std::string_view /*bytes*/) override {
    if (wrong != "publishes") throw ConfigError("", "no type is known");
  }
  std::vector<LiveTopic> topics() override { return {}; }
  std::string wrong;
};

class Promises : public testing::Test {
 protected:
  Promises() {
    catalog_.local_mappers.add<ToyMapper>("toy", "A toy.");
    catalog_.matchers.add<ToyMatcher>("toy", "A toy.");
    catalog_.clusterers.add<ToyClusterer>("toy", "A toy.");
    catalog_.raters.add<ToyRater>("toy", "A toy.");
    catalog_.threshold_policies.add<ToyThreshold>("toy", "A toy.");
    catalog_.verdict_rules.add<ToyRule>("toy", "A toy.");
    catalog_.observation_sources.add<ToySource>("toy", "A toy.");
    catalog_.map_sources.add<ToyMap>("toy", "A toy.");
    catalog_.message_links.add<ToyLink>("toy", "A toy.");
    catalog_.contact_indexes.add<ToyIndex>("toy", "A toy.");
    catalog_.contact_indexes.add<BitsetContact>("bitset", "The framework's.");
    catalog_.contact_indexes.add<KdTreeContact>("kd_tree", "The framework's.");
  }

  [[nodiscard]] std::vector<std::string> broken(const std::string& kind, const std::string& wrong) const {
    auto params = std::make_unique<ParamsOf<Wrong>>();
    params->value.wrong = wrong;
    return broken_promises(kind, {"toy", OwnedParams(std::move(params))}, catalog_);
  }

  Catalog catalog_;
};

TEST_F(Promises, AreKeptByToysThatDoNothingWrong) {
  for (const char* kind :
       {"local_mapper", "matcher", "clusterer", "rater", "threshold_policy", "verdict_rule",
        "observation_source", "map_source", "message_link", "contact_index"})
    EXPECT_THAT(broken(kind, ""), IsEmpty()) << kind;
  for (const char* name : {"bitset", "kd_tree"})
    EXPECT_THAT(broken_promises("contact_index", {name}, catalog_), IsEmpty()) << name;
}

TEST_F(Promises, OfMatchers) {
  EXPECT_THAT(broken("matcher", "empty map"), ElementsAre(HasSubstr("an empty local map: ")));
  EXPECT_THAT(broken("matcher", "random"),
              ElementsAre(HasSubstr("two threads: "), HasSubstr("after reset(): ")));
  EXPECT_THAT(broken("matcher", "threads"), ElementsAre(HasSubstr("two threads: ")));
  EXPECT_THAT(broken("matcher", "memory"), ElementsAre(HasSubstr("after reset(): the same random state")));
  EXPECT_THAT(broken("matcher", "quality"), ElementsAre(HasSubstr("hypotheses: one has the quality")));
  EXPECT_THAT(broken("matcher", "threshold").front(), HasSubstr("below omega_max = 0.3"));
  EXPECT_THAT(broken("matcher", "throws").front(), HasSubstr("hypotheses: no luck"));
}

TEST_F(Promises, OfClusterers) {
  EXPECT_THAT(broken("clusterer", "random"), ElementsAre(HasSubstr("the same again: ")));
  EXPECT_THAT(broken("clusterer", "loses one").front(), HasSubstr("1 of 30 hypotheses are in no cluster"));
  EXPECT_THAT(broken("clusterer", "one more"), ElementsAre(HasSubstr("no hypotheses: ")));
}

TEST_F(Promises, OfRaters) {
  EXPECT_THAT(broken("rater", "sum").front(), HasSubstr("add up to 2.7"));
  EXPECT_THAT(broken("rater", "random"), ElementsAre(HasSubstr("the same again: ")));
}

TEST_F(Promises, OfThresholdPolicies) {
  EXPECT_THAT(broken("threshold_policy", "by itself"), ElementsAre(HasSubstr("it changes when it is asked")));
  EXPECT_THAT(broken("threshold_policy", "above 1"), ElementsAre(HasSubstr("omega_max() is 1.5")));
  EXPECT_THAT(broken("threshold_policy", "keeps"),
              ElementsAre(HasSubstr("after reset() it is 0.5, and was 0.4 at first")));
}

TEST_F(Promises, OfVerdictRules) {
  EXPECT_THAT(broken("verdict_rule", "silent"), ElementsAre(HasSubstr("`why` is empty")));
  EXPECT_THAT(broken("verdict_rule", "no pose"), ElementsAre(HasSubstr("localized, without a pose")));
  for (const char* wrong : {"keeps", "random"})
    EXPECT_THAT(broken("verdict_rule", wrong), ElementsAre(HasSubstr("after reset() the same steps")));
  EXPECT_THAT(broken("verdict_rule", "least"), ElementsAre(HasSubstr("before the 5 steps")));
}

TEST_F(Promises, OfLocalMappers) {
  EXPECT_THAT(broken("local_mapper", "origin"), ElementsAre(HasSubstr("the robot is not at the origin")));
  EXPECT_THAT(broken("local_mapper", "blind"), ElementsAre(HasSubstr("without hits: it changes the points")));
  EXPECT_THAT(broken("local_mapper", "keeps"), ElementsAre(HasSubstr("points still")));
}

TEST_F(Promises, OfSources) {
  EXPECT_THAT(broken("observation_source", "again"), ElementsAre(HasSubstr("another observation after it")));
  for (const char* wrong : {"random", "random times"})
    EXPECT_THAT(broken("observation_source", wrong), ElementsAre(HasSubstr("the same seed: ")));
}

TEST_F(Promises, OfMapSources) {
  EXPECT_THAT(broken("map_source", "random"), ElementsAre(HasSubstr("it gives another map each time")));
}

TEST_F(Promises, OfContactIndexes) {
  for (const char* wrong : {"begin", "frame"})
    EXPECT_THAT(broken("contact_index", wrong), ElementsAre(HasSubstr("points of another frame, behind")));
}

TEST_F(Promises, OfMessageLinks) {
  EXPECT_THAT(broken("message_link", "subscribes"), ElementsAre(HasSubstr("it is subscribed to, without")));
  EXPECT_THAT(broken("message_link", "publishes"), ElementsAre(HasSubstr("it is published, without")));
  EXPECT_THAT(broken("message_link", "speaks"), ElementsAre(HasSubstr("there is a message")));
  EXPECT_THAT(broken("message_link", "waits"), ElementsAre(HasSubstr("and was to take 0.1 s")));
}

TEST_F(Promises, AreOnlyThoseOfAStrategyThatThereIs) {
  EXPECT_THROW(static_cast<void>(broken_promises("matcher", {"other"}, catalog_)), std::out_of_range);
  EXPECT_THROW(static_cast<void>(broken_promises("toy", {"toy"}, catalog_)), std::out_of_range);
}

}  // namespace
}  // namespace glocal::test::contract_test
