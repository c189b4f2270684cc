// Sources that break their contract are refused by name.
#include "evaluation/running/experiment_loader.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "files.hpp"
#include "framework/pipeline/fakes.hpp"

namespace glocal::test::experiment_loader_test {
namespace {

class Loading : public testing::Test {
 protected:
  Loading() {
    map_.points.push_back({1.0F, 2.0F, 0.0F});
    samples_.resize(2);
  }

  [[nodiscard]] LoadedExperiment load() const {
    Catalog catalog;
    catalog.map_sources.add<GivenMap>("given", "A given map.", {}, {map_});
    catalog.observation_sources.add<ListedSamples>("listed", "Given samples.", {}, {samples_});
    Experiment experiment = default_experiment();
    experiment.map = catalog.map_sources.choose("given");
    experiment.observations = catalog.observation_sources.choose("listed");
    experiment.trials.every_scan = 1;
    return load_experiment(experiment, catalog, [](const std::string&) {});
  }

  [[nodiscard]] std::string fault() const {
    return error_of([&] { return load(); });
  }

  MapData map_;
  std::vector<Sample> samples_;
};

TEST_F(Loading, TakesWhatIsWhole) {
  EXPECT_EQ(load().starts.size(), 2U);
}

TEST_F(Loading, RefusesAMapThatIsNoPlace) {
  map_.points.push_back({std::numeric_limits<float>::quiet_NaN(), 0.0F, 0.0F});
  EXPECT_THAT(fault(),
              testing::HasSubstr("map source 'given' breaks its contract: a value of the points is not"));
}

TEST_F(Loading, RefusesADriveThatIsNoPlace) {
  samples_[1].observation.odom_from_robot.x = std::numeric_limits<double>::infinity();
  EXPECT_THAT(fault(), testing::HasSubstr("observation source 'listed' breaks its contract: the odometry"));
}

/// A source of maps or drives that counts how often it is made.
template <class Source>
class Counted final : public Source {
 public:
  struct Params {
    typename Source::Params source;
    std::shared_ptr<int> made;
  };
  explicit Counted(Params params) : Source(std::move(params.source)) { ++*params.made; }

  friend void describe(ParamVisitor& /*v*/, Params& /*p*/) {}
};

TEST(ExperimentLoader, LoadsAgainWhatHasChangedAlone) {
  MapData map;
  map.points.push_back({1.0F, 2.0F, 0.0F});
  const auto maps = std::make_shared<int>(0), drives = std::make_shared<int>(0);
  Catalog catalog;
  catalog.map_sources.add<Counted<GivenMap>>("given", "A given map.", {}, {{map}, maps});
  catalog.observation_sources.add<Counted<ListedSamples>>("listed", "Given samples.", {},
                                                          {{std::vector<Sample>(9)}, drives});
  Experiment experiment = default_experiment();
  experiment.map = catalog.map_sources.choose("given");
  experiment.observations = catalog.observation_sources.choose("listed");
  experiment.trials.every_scan = 1;
  ExperimentLoader loader(catalog, [](const std::string&) {});
  const auto first = loader.load(experiment).map;
  EXPECT_EQ(loader.load(experiment).map, first) << "with all that was looked up in it";
  // Trials begin elsewhere.
  experiment.trials.every_scan = 3;
  EXPECT_EQ(loader.load(experiment).starts.size(), 3U);
  EXPECT_EQ(loader.load(experiment).map, first);
  // Another method looks up something else.
  experiment.localizer.contact_epsilon = 0.2;
  const auto other = loader.load(experiment).map;
  EXPECT_NE(other, first);
  EXPECT_EQ(other->points(), first->points());
  EXPECT_EQ(*maps, 1);
  EXPECT_EQ(*drives, 1);
  // Sources draw by the seed.
  experiment.seed = 2;
  EXPECT_NE(loader.load(experiment).map, other);
  EXPECT_EQ(*maps, 2);
  EXPECT_EQ(*drives, 2);
}

TEST(ExperimentLoader, VariantsWithOneMapFollowEachOther) {
  MapData map;
  map.points.push_back({1.0F, 2.0F, 0.0F});
  Catalog catalog;
  catalog.map_sources.add<GivenMap>("given", "A given map.", {}, {map});
  catalog.map_sources.add<GivenMap>("other", "Another one.", {}, {map});
  catalog.observation_sources.add<ListedSamples>("listed", "Given samples.", {}, {});
  catalog.observation_sources.add<ListedSamples>("others", "Other samples.", {}, {});
  std::vector<Variant> variants;
  for (const auto& [place, drive] : {std::pair{"given", "listed"},
                                     {"other", "listed"},
                                     {"given", "others"},
                                     {"other", "others"},
                                     {"given", "listed"}}) {
    Variant variant;
    variant.experiment = default_experiment();
    variant.experiment.map = catalog.map_sources.choose(place);
    variant.experiment.observations = catalog.observation_sources.choose(drive);
    variants.push_back(std::move(variant));
  }
  EXPECT_THAT(loading_order(variants, catalog), testing::ElementsAre(0, 4, 2, 1, 3));
}

TEST_F(Loading, OneDriveOnOneMapAndOnSeveralHasItsReferencesAnewOnEach) {
  MapData floors = map_;
  floors.parts = {{"ground", {}, 0.0}, {"first", Pose2{100.0, 0.0, 0.0}, 50.0}};
  Catalog catalog;
  catalog.map_sources.add<GivenMap>("one", "A map.", {}, {map_});
  catalog.map_sources.add<GivenMap>("floors", "Several maps.", {}, {floors});
  samples_[0].map_from_robot = samples_[1].map_from_robot = Pose2{1.0, 2.0, 0.0};
  catalog.observation_sources.add<ListedSamples>("unnamed", "Given samples.", {}, {samples_});
  samples_[0].map = samples_[1].map = "first";
  catalog.observation_sources.add<ListedSamples>("named", "Given samples.", {}, {samples_});
  std::vector<std::string> warnings;
  ExperimentLoader loader(catalog, [&](const std::string& text) { warnings.push_back(text); });
  const auto reference = [&](const std::string& map, const std::string& drive) {
    Experiment experiment = default_experiment();
    experiment.map = catalog.map_sources.choose(map);
    experiment.observations = catalog.observation_sources.choose(drive);
    experiment.trials.every_scan = 1;
    return loader.load(experiment).drive.samples[1].map_from_robot;
  };
  EXPECT_EQ(reference("one", "unnamed"), Pose3(Pose2{1.0, 2.0, 0.0}));
  EXPECT_EQ(reference("floors", "unnamed"), std::nullopt);
  EXPECT_THAT(warnings, testing::Contains(testing::HasSubstr("do not say which of the maps they are on")));
  EXPECT_EQ(reference("one", "unnamed"), Pose3(Pose2{1.0, 2.0, 0.0}));
  EXPECT_EQ(reference("floors", "named"), Pose3(Pose2{101.0, 2.0, 0.0}));
}

}  // namespace
}  // namespace glocal::test::experiment_loader_test
