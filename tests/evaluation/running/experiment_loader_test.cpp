// Sources that break their contract are refused by name.
#include "evaluation/running/experiment_loader.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "framework/pipeline/fakes.hpp"
#include "glocal/error.hpp"

namespace glocal::test::experiment_loader_test {
namespace {

/// Delivers what it is given.
class GivenMap final : public MapSource {
 public:
  struct Params {
    MapData map;
  };
  explicit GivenMap(Params params) : map_(std::move(params.map)) {}
  [[nodiscard]] MapData load() override { return map_; }

 private:
  MapData map_;
};
void describe(ParamVisitor& /*v*/, GivenMap::Params& /*p*/) {}

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
    try {
      static_cast<void>(load());
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
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

}  // namespace
}  // namespace glocal::test::experiment_loader_test
