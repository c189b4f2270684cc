// One strategy of every kind, as small as they can be.
#include "glocal/error.hpp"
#include "glocal/plugin.hpp"

namespace {

using namespace glocal;

/// A square room of 8 m, a point every 5 cm, and nothing known of what is free.
class Room final : public MapSource {
 public:
  struct Params {
    double side = 8.0;
  };
  explicit Room(const Params& params) : side_(params.side) {}
  MapData load() override {
    MapData map;
    for (double t = 0.0; t < side_; t += 0.05) {
      const auto a = static_cast<float>(t);
      const auto b = static_cast<float>(side_);
      for (const Point& p : {Point{a, 0, 0}, Point{a, b, 0}, Point{0, a, 0}, Point{b, a, 0}})
        map.points.push_back(p);
    }
    return map;
  }

 private:
  double side_;
};
void describe(ParamVisitor& v, Room::Params& p) {
  v.field("side", p.side, {.doc = "Side of the room.", .unit = "m", .above = 0.0});
}

/// Stands in the middle of the room and sees its walls, so many times.
class StandingStill final : public ObservationSource {
 public:
  struct Params {
    int scans = 20;
  };
  explicit StandingStill(const Params& params) : left_(params.scans) {}
  std::optional<Sample> next() override {
    if (left_-- <= 0) return std::nullopt;
    Sample sample;
    sample.observation.stamp = stamp_++;
    sample.map_from_robot = Pose2{4.0, 4.0, 0.0};
    for (int i = -40; i < 40; ++i)
      sample.observation.scan.hits.push_back({4.0F, 0.1F * static_cast<float>(i), 0.0F});
    return sample;
  }

 private:
  int left_;
  double stamp_ = 0.0;
};
void describe(ParamVisitor& v, StandingStill::Params& p) {
  v.field("scans", p.scans, {.doc = "How many.", .min = 1});
}

class LastScan final : public LocalMapper {
 public:
  using Params = NoParams;
  explicit LastScan(const Params& /*params*/) {}
  void add(const Observation& observation) override {
    map_.points = observation.scan.hits;
    ++map_.epoch;
  }
  const LocalMap& map() const override { return map_; }
  void reset() override { map_ = {}; }

 private:
  LocalMap map_;
};

/// Knows the answer.
class Oracle final : public Matcher {
 public:
  using Params = NoParams;
  explicit Oracle(const Params& /*params*/) {}
  MatchResult match(const MatchRequest& request, Rng& /*rng*/) override {
    if (request.local.points.empty() || request.omega_max > 1.0) return {};
    const Pose2 pose{4.0, 4.0, 0.0};
    return {{Hypothesis::by_contact(pose, 1.0)}, 1, request.local.points.size()};
  }
  void reset() override {}
};

class EachAlone final : public Clusterer {
 public:
  using Params = NoParams;
  explicit EachAlone(const Params& /*params*/) {}
  std::vector<Cluster> cluster(const std::vector<Hypothesis>& hypotheses, Rng& /*rng*/) override {
    std::vector<Cluster> clusters;
    for (std::size_t i = 0; i < hypotheses.size(); ++i)
      clusters.push_back({{i}, hypotheses[i].map_from_robot});
    return clusters;
  }
};

class AllAlike final : public Rater {
 public:
  using Params = NoParams;
  explicit AllAlike(const Params& /*params*/) {}
  std::vector<Rating> rate(const std::vector<Cluster>& clusters,
                           const std::vector<Hypothesis>& /*h*/) override {
    return std::vector<Rating>(clusters.size(), Rating{1.0, 1.0 / static_cast<double>(clusters.size())});
  }
};

class Fixed final : public ThresholdPolicy {
 public:
  using Params = NoParams;
  explicit Fixed(const Params& /*params*/) {}
  double omega_max() const override { return 0.5; }
  void update(const std::vector<Hypothesis>& /*hypotheses*/) override {}
  void reset() override {}
};

class AtOnce final : public VerdictRule {
 public:
  using Params = NoParams;
  explicit AtOnce(const Params& /*params*/) {}
  Verdict judge(const StepResult& step) override {
    if (step.clusters.empty()) return {};
    return {VerdictKind::localized, step.clusters.front().map_from_robot, {}, "the first guess is taken"};
  }
  void reset() override {}
};

class Trusting final : public Verifier {
 public:
  using Params = NoParams;
  explicit Trusting(const Params& /*params*/) {}
  Verification verify(const LocalMap& /*local*/, const Pose3& /*map_from_local*/,
                      const PoseGate& /*gate*/) override {
    return {};
  }
};

/// Says the same of all clouds.
class Ahead final : public CloudRegistrar {
 public:
  struct Params {
    double by = 1.0;
  };
  explicit Ahead(const Params& params) : by_(params.by) {}
  Registration find(const Points& /*source*/, const Points& /*target*/) override {
    Registration result;
    result.is_match = true;
    result.why = "all clouds are alike";
    result.target_from_source = Pose3{Vector3{by_, 0.0, 0.0}};
    result.voxel_size = 0.1;
    return result;
  }

 private:
  double by_;
};
void describe(ParamVisitor& v, Ahead::Params& p) {
  v.field("by", p.by, {.doc = "How far.", .unit = "m", .min = 0.0});
}

/// A robot that says nothing, and knows no type of messages.
class Mute final : public MessageLink {
 public:
  using Params = NoParams;
  explicit Mute(const Params& /*params*/) {}
  void subscribe(const LiveTopic& topic, Delivery /*delivery*/) override { refuse(topic); }
  std::optional<LiveMessage> next(std::chrono::milliseconds /*longest*/) override { return std::nullopt; }
  void publish(const LiveTopic& topic, Delivery /*delivery*/, std::string_view /*bytes*/) override {
    refuse(topic);
  }
  std::vector<LiveTopic> topics() override { return {}; }

 private:
  static void refuse(const LiveTopic& topic) {
    throw ConfigError("", "the type '" + topic.type + "' is not known; none is");
  }
};

}  // namespace

GLOCAL_PLUGIN("every_kind", "1.2.3", catalog) {
  catalog.map_sources.add<Room>("room", "A square room.");
  catalog.observation_sources.add<StandingStill>("standing", "A robot that stands still.");
  catalog.local_mappers.add<LastScan>("last_scan", "The last scan alone.");
  catalog.matchers.add<Oracle>("oracle", "Knows the answer.");
  catalog.clusterers.add<EachAlone>("each_alone", "Every hypothesis is a cluster.");
  catalog.raters.add<AllAlike>("all_alike", "Every cluster is as good as any other.");
  catalog.threshold_policies.add<Fixed>("always_half", "Always 0.5.");
  catalog.verdict_rules.add<AtOnce>("at_once", "Takes the first guess.");
  catalog.verifiers.add<Trusting>("trusting", "Believes all that is declared.");
  catalog.cloud_registrars.add<Ahead>("ahead", "The source is ahead.");
  catalog.message_links.add<Mute>("mute", "A robot that says nothing.");
}
