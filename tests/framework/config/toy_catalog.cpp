#include "framework/config/toy_catalog.hpp"

namespace glocal::test {
namespace {

struct ToyIndexed final : Matcher {
  using Params = Nothing;
  explicit ToyIndexed(const Params& /*params*/) {}
  MatchResult match(const MatchRequest& /*request*/, Rng& /*rng*/) override { return {}; }
  void reset() override {}
};

struct ToyMapper final : LocalMapper {
  using Params = Nothing;
  explicit ToyMapper(const Params& /*params*/) {}
  void add(const Observation& /*observation*/) override {}
  [[nodiscard]] const LocalMap& map() const override { return map_; }
  void reset() override {}

 private:
  LocalMap map_;
};

struct ToyClusterer final : Clusterer {
  using Params = Nothing;
  explicit ToyClusterer(const Params& /*params*/) {}
  std::vector<Cluster> cluster(const std::vector<Hypothesis>& /*hypotheses*/, Rng& /*rng*/) override {
    return {};
  }
};

struct ToyPolicy final : ThresholdPolicy {
  using Params = Nothing;
  explicit ToyPolicy(const Params& /*params*/) {}
  [[nodiscard]] double omega_max() const override { return 0.5; }
  void update(const std::vector<Hypothesis>& /*hypotheses*/) override {}
  void reset() override {}
};

struct ToyVerdict final : VerdictRule {
  using Params = Nothing;
  explicit ToyVerdict(const Params& /*params*/) {}
  Verdict judge(const StepResult& /*step*/) override { return {}; }
  void reset() override {}
};

}  // namespace

ToyMap::ToyMap(const Params& /*params*/) {}
MapData ToyMap::load() {
  return {};
}

ToyDrive::ToyDrive(const Params& /*params*/) {}
std::optional<Sample> ToyDrive::next() {
  return std::nullopt;
}

ToyMatcher::ToyMatcher(const Params& /*params*/) {}
MatchResult ToyMatcher::match(const MatchRequest& /*request*/, Rng& /*rng*/) {
  return {};
}
void ToyMatcher::reset() {}

std::vector<Rating> ToyRater::rate(const std::vector<Cluster>& /*clusters*/,
                                   const std::vector<Hypothesis>& /*hypotheses*/) {
  return {};
}

void describe(ParamVisitor& /*v*/, Nothing& /*p*/) {}

void describe(ParamVisitor& v, Wall& p) {
  v.field("from", p.from, {.doc = "Where it begins.", .unit = "m", .min_items = 2, .max_items = 2});
  v.field("height", p.height, {.doc = "How high it is.", .unit = "m", .above = 0.0});
}

void describe(ParamVisitor& v, Noise& p) {
  v.field("range", p.range, {.doc = "Standard deviation of a range.", .unit = "m", .min = 0.0, .max = 1.0});
  v.field("beams", p.beams, {.doc = "How many beams.", .min = 1.0, .max = 8.0});
}

void describe(ParamVisitor& v, ToyMap::Params& p) {
  v.field("path", p.path, {.doc = "The map's file.", .required = true});
  v.field("segments", p.segments, {.doc = "Shares of the path.", .min = 0.0, .max = 1.0, .min_items = 1});
  v.field("resolution", p.resolution, {.doc = "Size of a cell.", .unit = "m", .above = 0.0});
  v.field("walls", p.walls, {.doc = "Walls | besides the map.", .max_items = 3});
}

void describe(ParamVisitor& v, ToyDrive::Params& p) {
  v.field("min_range", p.min_range, {.doc = "Nearest reading.", .unit = "m", .min = 0.0});
  v.field("max_range", p.max_range, {.doc = "Farthest reading.", .unit = "m", .min = 0.0});
  v.require(p.min_range < p.max_range, "min_range", "must be less than max_range");
  v.field("label", p.label, {.doc = "Any text."});
  v.field("mode", p.mode,
          {.doc = "How to drive.", .choices = {"fast", "slow"}, .former_choices = {{"crawling", "slow"}}});
  v.field("loop", p.loop, {.doc = "Whether to start again."});
  v.field("salt", p.salt, {.doc = "Added to the seed."});
  v.field("tags", p.tags, {.doc = "Words."});
  v.field("extras", p.extras, {.doc = "More files."});
  v.field("optional_file", p.optional_file, {.doc = "A file, or none."});
  v.field("noise", p.noise, {.doc = "Errors of the laser."});
}

void describe(ParamVisitor& v, ToyMatcher::Params& p) {
  v.field("iterations", p.iterations,
          {.doc = "Draws on each side.", .min = 1.0, .audience = Audience::tuner});
  v.field("contact_epsilon", p.contact_epsilon, {.doc = "Distance in contact.", .unit = "m", .above = 0.0});
  v.field("patience", p.patience,
          {.doc = "How long it waits.",
           .unit = "s",
           .above = 0.0,
           .audience = Audience::expert,
           .formerly = "temper"});
  v.removed("luck", "there is none; raise iterations");
}

void register_toys(Catalog& c) {
  c.map_sources.add<ToyMap>("toy_map", "A map from nowhere.");
  c.observation_sources.add<ToyDrive>("toy_drive", "A drive to nowhere.");
  c.local_mappers.add<ToyMapper>("scan_matching", "Joins nothing.");
  c.matchers.add<ToyMatcher>("ransam", "Matches nothing.");
  c.matchers.add<ToyIndexed>("indexed", "Matches nothing, faster.", stable_since("0.1.0"));
  c.matchers.note_renamed("ransack", "ransam");
  c.clusterers.add<ToyClusterer>("hierarchical_kmeans", "Groups nothing.");
  c.raters.add<ToyRater>("cluster_rating", "Rates nothing.");
  c.threshold_policies.add<ToyPolicy>("sliding_window", "Asks for one half.");
  c.verdict_rules.add<ToyVerdict>("consecutive_rating", "Never sure.");
  c.verifiers.add_none("none", "Verifies nothing.", {});
}

}  // namespace glocal::test
