// How many looks a step has time for, with a matcher whose pieces take a time that is known.
#include "evaluation/running/search_pace.hpp"

#include <gmock/gmock.h>

#include <chrono>
#include <limits>
#include <memory>
#include <optional>
#include <thread>

#include "framework/pipeline/fakes.hpp"

namespace glocal::test::search_pace_test {
namespace {

using testing::AllOf;
using testing::Ge;
using testing::Le;
using testing::Optional;

class SearchPace : public testing::Test {
 protected:
  SearchPace() {
    register_fake_stages(catalog_);
    experiment_.localizer = follow(script_);
    loaded_.map = map_of_one_point();
    loaded_.drive.samples.resize(3);
    loaded_.drive.path_m.resize(3);
    loaded_.starts = {0, 1};
  }

  /// Each piece of a match takes so long, and the first match so many pieces.
  void search(std::size_t pieces, std::chrono::milliseconds time) {
    script_->searches = pieces;
    script_->match = [time](double, Rng&) {
      std::this_thread::sleep_for(time);
      return MatchResult{};
    };
  }

  std::optional<int> looks(double ms) { return looks_within(ms, experiment_, catalog_, loaded_); }

  std::shared_ptr<Script> script_ = std::make_shared<Script>();
  Catalog catalog_;
  Experiment experiment_;
  LoadedExperiment loaded_;
};

TEST_F(SearchPace, IsLooksOfAPieceByItsTime) {
  search(30, std::chrono::milliseconds(2));
  // Ten pieces of 100,000 looks would fit into 20 ms if none took longer than it sleeps.
  EXPECT_THAT(looks(20.0), Optional(AllOf(Le(1'000'000), Ge(10'000))));
  EXPECT_THAT(script_->calls, testing::Contains("match 100000").Times(30));
}

TEST_F(SearchPace, ALastPieceTellsNothing) {
  search(1, std::chrono::milliseconds(0));
  EXPECT_EQ(looks(20.0), std::nullopt);
}

TEST_F(SearchPace, IsUnknownWithoutASearch) {
  search(0, std::chrono::milliseconds(0));
  EXPECT_EQ(looks(20.0), std::nullopt);
}

TEST_F(SearchPace, ALongTimeIsAsManyLooksAsCanBeSaid) {
  search(30, std::chrono::milliseconds(1));
  EXPECT_EQ(looks(1e9), std::numeric_limits<int>::max());
}

}  // namespace
}  // namespace glocal::test::search_pace_test
