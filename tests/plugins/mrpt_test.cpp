// plugins/mrpt, as users have it: a matcher chosen in YAML.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "files.hpp"
#include "glocal/builtin.hpp"
#include "glocal/run_experiment.hpp"
#include "glocal/yaml.hpp"
#include "loading/plugin_loader.hpp"
#include "test_world.hpp"

namespace glocal::test::mrpt_test {
namespace {

using testing::HasSubstr;

/// Rays of a laser with a view of 270 degrees, one each degree, as the small world lets them through.
/// `sensor` is its pose on the robot.
Scan scan_from(const Pose2& map_from_robot, const Pose2& sensor, double max_range) {
  static const std::vector<std::pair<double, double>> corners = {
      {0, 0}, {8, 0}, {8, 3}, {7, 3}, {7, 3.6}, {8, 3.6}, {8, 5}, {4, 5}, {4, 9}, {0, 9}, {0, 0}};
  const Pose2 from = map_from_robot * sensor;
  Scan scan;
  scan.origin = {static_cast<float>(sensor.x), static_cast<float>(sensor.y), 0.0F};
  for (int i = 0; i <= 270; ++i) {
    const double angle = radians(i - 135.0);
    const double dx = std::cos(from.theta + angle);
    const double dy = std::sin(from.theta + angle);
    double range = std::numeric_limits<double>::infinity();
    for (std::size_t k = 1; k < corners.size(); ++k) {
      const auto [x0, y0] = corners[k - 1];
      const double wx = corners[k].first - x0;
      const double wy = corners[k].second - y0;
      const double across = dx * wy - dy * wx;
      if (across == 0.0) continue;
      const double along_ray = ((x0 - from.x) * wy - (y0 - from.y) * wx) / across;
      const double along_wall = ((x0 - from.x) * dy - (y0 - from.y) * dx) / across;
      if (along_ray > 0.0 && along_wall >= 0.0 && along_wall <= 1.0) range = std::min(range, along_ray);
    }
    const bool is_hit = range <= max_range;
    const Pose2 end = sensor * Pose2{std::min(range, max_range) * std::cos(angle),
                                     std::min(range, max_range) * std::sin(angle), 0.0};
    (is_hit ? scan.hits : scan.free_ends)
        .push_back({static_cast<float>(end.x), static_cast<float>(end.y), 0.0F});
  }
  return scan;
}

/// The local map of one scan, which begins where the robot is.
LocalMap local_map_of(const Scan& scan) {
  LocalMap local;
  local.points = scan.hits;
  local.ends = {local.points.size()};
  return local;
}

/// A drive from one room into the other.
std::vector<Pose2> way_through_small_world() {
  std::vector<Pose2> way;
  Pose2 pose{6.0, 1.5, 3.0};
  for (int i = 0; i < 25; ++i) {
    way.push_back(pose);
    pose = pose * Pose2{0.2, 0.0, i > 12 && i < 20 ? -0.25 : 0.0};
  }
  return way;
}

/// The small world in a frame that is turned and lies far from its grid's, with walls and what is behind them
/// unknown.
std::shared_ptr<const GlobalMap> world_in(const Pose2& map_from_world) {
  MapData data;
  data.points = glocal::test::moved(glocal::test::small_world_points(), map_from_world);
  data.grid = glocal::test::small_world()->grid();
  for (int row = 0; row < data.grid.height; ++row) {
    for (int column = 0; column < data.grid.width; ++column) {
      const Pose2 place = data.grid.centre(column, row);
      const bool inside = place.x > 0.0 && place.y > 0.0 && place.x < (place.y < 5.0 ? 8.0 : 4.0);
      data.grid.cell(column, row) = inside ? Cell::free : Cell::unknown;
    }
  }
  data.grid.map_from_grid = map_from_world * data.grid.map_from_grid;
  return std::make_shared<const GlobalMap>(std::move(data));
}

/// A grid of free and other cells of 0.1 m, by rows from the highest y on: '.' is free, '?' is not known; and
/// a point of the map in the middle of each '#'.
std::shared_ptr<const GlobalMap> drawn(const std::vector<std::string>& rows) {
  MapData data;
  data.grid = {{}, 0.1, static_cast<int>(rows.front().size()), static_cast<int>(rows.size()), {}};
  data.grid.cells = PackedCells(rows.size() * rows.front().size(), Cell::unknown);
  for (int row = 0; row < data.grid.height; ++row) {
    const std::string& line = rows[rows.size() - 1 - static_cast<std::size_t>(row)];
    for (int column = 0; column < data.grid.width; ++column) {
      const char mark = line[static_cast<std::size_t>(column)];
      if (mark == '.') data.grid.cell(column, row) = Cell::free;
      if (mark != '#') continue;
      data.grid.cell(column, row) = Cell::occupied;
      const Pose2 centre = data.grid.centre(column, row);
      data.points.push_back({static_cast<float>(centre.x), static_cast<float>(centre.y), 0.0F});
    }
  }
  return std::make_shared<const GlobalMap>(std::move(data));
}

const Hypothesis& heaviest(const std::vector<Hypothesis>& hypotheses) {
  return *std::max_element(hypotheses.begin(), hypotheses.end(),
                           [](const Hypothesis& a, const Hypothesis& b) { return a.support < b.support; });
}

/// What most particles agree on after each step of a drive.
struct Answer {
  std::vector<std::size_t> proposals;
  std::vector<Pose3> heaviest;
  std::vector<double> scores;

  friend bool operator==(const Answer&, const Answer&) = default;
};

class Mrpt : public testing::Test {
 protected:
  Mrpt() {
    register_builtin_strategies(catalog_);
    PluginLoader(catalog_).load(GLOCAL_MRPT_PLUGIN);
  }

  std::unique_ptr<Matcher> matcher(const std::string& params, std::shared_ptr<const GlobalMap> map) {
    StrategyChoice choice = catalog_.matchers.choose("mrpt_mcl");
    if (!params.empty()) read_yaml(folder_.write("params.yaml", params), *choice.params);
    return catalog_.matchers.make(choice, {std::move(map), 1});
  }

  std::string fault(const std::string& params) {
    return config_error(folder_ / "", [&] { (void)matcher(params, glocal::test::small_world()); });
  }

  static Answer drive(Matcher& matcher, const Pose2& sensor = {}, double max_range = 10.0) {
    Answer answer;
    std::uint64_t step = 0;
    for (const Pose2& pose : way_through_small_world()) {
      Observation observation;
      observation.scan = scan_from(pose, sensor, max_range);
      observation.odom_from_robot = Pose2{40.0, -3.0, 2.0} * pose;
      Rng rng(step++);
      const MatchResult result = matcher.match({local_map_of(observation.scan), observation, 0.0}, rng);
      answer.proposals.push_back(result.proposals);
      // Where nothing is in reach there is no answer.
      if (result.hypotheses.empty()) continue;
      const Hypothesis& best = heaviest(result.hypotheses);
      answer.heaviest.push_back(best.map_from_local);
      answer.scores.push_back(best.score);
    }
    return answer;
  }

  TemporaryFolder folder_;
  Catalog catalog_;
};

const char* const few = "particles_count: 8000\nkld_params: {kld_max_sample_size: 8000}\n";

TEST_F(Mrpt, FindsTheRobotWhereverTheMapAndTheLaserAre) {
  const Pose2 end = way_through_small_world().back();
  for (const Pose2& map_from_world : {Pose2{}, Pose2{1200.0, -700.0, 2.5}}) {
    for (const Pose2& sensor : {Pose2{}, Pose2{0.25, -0.1, 3.0}}) {
      const auto made = matcher(few, world_in(map_from_world));
      const Answer answer = drive(*made, sensor);
      const Pose2 truth = map_from_world * end;
      EXPECT_LT(distance(answer.heaviest.back(), truth), 0.1) << map_from_world.x << " " << sensor.x;
      EXPECT_LT(rotation_between(answer.heaviest.back(), truth), radians(3.0));
      // KLD-sampling needs few particles where they agree.
      EXPECT_EQ(answer.proposals.front(), 8000U);
      EXPECT_LT(answer.proposals.back(), 1500U);
      EXPECT_GE(answer.proposals.back(), 250U);
    }
  }
}

/// A laser of 4 m: many rays meet nothing.
TEST_F(Mrpt, RaysThatMeetNothingAreNoHits) {
  const auto made = matcher(few, world_in({}));
  const Answer answer = drive(*made, {}, 4.0);
  EXPECT_LT(distance(answer.heaviest.back(), way_through_small_world().back()), 0.25);
}

TEST_F(Mrpt, EveryKindOfFilterAndNoiseFindsTheRobot) {
  const Pose2 end = way_through_small_world().back();
  const std::string noise =
      "motion_model: {gaussian_model: {a1: 0.1, min_std_xy: 0.03, min_std_phi_deg: 2}}\n";
  const std::string fixed = "pf_options: {adaptive_sample_size: false, pow_factor: 0.3, ";
  for (const std::string& params : {
           few + fixed + "pf_algorithm: pfAuxiliaryPFStandard}\n" + noise,
           few + fixed + "resampling_method: prMultinomial}\n" + noise,
           few + fixed + "resampling_method: prResidual}\n" + noise,
           few + fixed + "resampling_method: prStratified}\n" + noise,
           few + fixed + "resampling_method: prSystematic}\n" + noise,
           few + std::string("likelihood_options: {lf_alternate_average_method: true, lf_std_hit: 0.1}\n") +
               noise,
           few + std::string("likelihood_options: {lf_use_square_dist: true}\n") + noise,
           few + std::string("motion_model: {model_selection: mmThrun, thrun_model: {alfa3_trans_trans: 0.2, "
                             "additional_std_xy: 0.03, additional_std_phi_deg: 2}}\n"),
       }) {
    const auto made = matcher(params, world_in({}));
    const Answer answer = drive(*made);
    EXPECT_LT(distance(answer.heaviest.back(), end), 0.25) << params;
    EXPECT_LT(rotation_between(answer.heaviest.back(), end), radians(6.0)) << params;
  }
}

/// 10 m of corridor; one end has a wall, nothing is known of the other.
TEST_F(Mrpt, WhatIsUnknownIsNoWall) {
  std::vector<std::string> rows(22, "######" + std::string(100, '.') + "??????");
  rows.front() = rows.back() = "######" + std::string(100, '#') + "??????";
  const auto made = matcher("likelihood_options: {lf_decimation: 1}\n", drawn(rows));
  // 2 m before the wall: both ends would look alike if the unknown were one.
  Observation observation;
  for (int i = -9; i <= 9; ++i) observation.scan.hits.push_back({2.0F, 0.1F * static_cast<float>(i), 0.0F});
  for (int i = -20; i <= 20; ++i) {
    for (const float side : {-1.05F, 1.05F})
      observation.scan.hits.push_back({0.1F * static_cast<float>(i), side, 0.0F});
  }
  std::vector<Hypothesis> found;
  for (std::uint64_t step = 0; step < 10; ++step) {
    Rng rng(step);
    found = made->match({local_map_of(observation.scan), observation, 0.0}, rng).hypotheses;
  }
  std::size_t near_the_wall = 0;
  std::size_t all = 0;
  for (const Hypothesis& h : found) {
    all += h.support;
    if (h.map_from_local.x < 5.0) near_the_wall += h.support;
  }
  EXPECT_GE(all, 200U);
  EXPECT_GT(static_cast<double>(near_the_wall), 0.95 * static_cast<double>(all));
}

TEST_F(Mrpt, ParticlesBeginWhereTheMapIsFree) {
  const Pose2 map_from_world{300.0, 200.0, 1.0};
  MapData data;
  data.points = glocal::test::moved(glocal::test::small_world_points(), map_from_world);
  data.grid = glocal::test::small_world()->grid();
  data.grid.map_from_grid = map_from_world * data.grid.map_from_grid;
  data.grid.cells = PackedCells(data.grid.cells.size(), Cell::unknown);
  data.grid.cell(40, 20) = Cell::free;
  const auto made = matcher(few, std::make_shared<const GlobalMap>(std::move(data)));
  Observation observation;
  observation.scan = scan_from({4.0, 2.0, 0.5}, {}, 10.0);
  Rng rng(1);
  const auto found = made->match({local_map_of(observation.scan), observation, 0.0}, rng).hypotheses;
  ASSERT_FALSE(found.empty());
  const Pose2 centre = map_from_world * Pose2{4.0, 2.0, 0.0};
  // A cell of 0.1 m, which MRPT takes twice as large, and its least noise.
  for (const Hypothesis& h : found) EXPECT_LT(distance(h.map_from_local, centre), 0.2);
  EXPECT_LT(rotation_between(found.front().map_from_local, Pose2{0.0, 0.0, 1.5}), radians(10.0));
}

/// MRPT's own draws would be one and the same increment of mmThrun.
TEST_F(Mrpt, EachParticleErrsByItself) {
  for (const char* model : {"gaussian_model: {min_std_xy: 0.3}",
                            "model_selection: mmThrun, thrun_model: {additional_std_xy: 0.3}"}) {
    std::vector<std::string> rows(60, std::string(60, '.'));
    rows[30][30] = '#';
    const auto made = matcher("particles_count: 1\nkld_params: {kld_min_sample_size: 2000}\nmotion_model: {" +
                                  std::string(model) + "}\nlikelihood_options: {lf_z_hit: 0}\n",
                              drawn(rows));
    Observation observation;
    observation.scan.hits.push_back({1.0F, 0.0F, 0.0F});
    Rng rng(1);
    const auto found = made->match({local_map_of(observation.scan), observation, 0.0}, rng).hypotheses;
    // Thousands of draws from one place: their spread is the noise.
    double n = 0.0;
    double sum = 0.0;
    double squares = 0.0;
    for (const Hypothesis& h : found) {
      const auto weight = static_cast<double>(h.support);
      n += weight;
      sum += weight * h.map_from_local.x;
      squares += weight * h.map_from_local.x * h.map_from_local.x;
    }
    EXPECT_GE(n, 1900.0);
    EXPECT_NEAR(std::sqrt(squares / n - sum * sum / n / n), 0.3, 0.03) << model;
  }
}

TEST_F(Mrpt, WhatIsNoPointOfAScanChangesNothing) {
  const auto answer = [&](bool with_more) {
    const auto made = matcher(few, world_in({}));
    Observation observation;
    observation.scan = scan_from({2.0, 2.0, 0.5}, {0.2, 0.1, 0.0}, 10.0);
    const LocalMap local = local_map_of(observation.scan);
    if (with_more) {
      const float nan = std::numeric_limits<float>::quiet_NaN();
      const float infinite = std::numeric_limits<float>::infinity();
      observation.scan.hits.push_back({nan, 1.0F, 0.0F});
      observation.scan.hits.push_back({1.0F, -infinite, 0.0F});
      observation.scan.hits.push_back(observation.scan.origin);
      observation.scan.free_ends.push_back({infinite, nan, 0.0F});
    }
    Rng rng(1);
    return made->match({local, observation, 0.0}, rng).hypotheses;
  };
  const auto plain = answer(false);
  const auto more = answer(true);
  ASSERT_GT(plain.size(), 100U);
  ASSERT_EQ(more.size(), plain.size());
  const auto by_weight = [](const Hypothesis& a, const Hypothesis& b) { return a.support < b.support; };
  EXPECT_EQ(std::max_element(more.begin(), more.end(), by_weight)->map_from_local,
            std::max_element(plain.begin(), plain.end(), by_weight)->map_from_local);
}

TEST_F(Mrpt, ScansMayHaveAnyNumberOfBeams) {
  const auto made = matcher(few, world_in({}));
  std::uint64_t step = 0;
  MatchResult result;
  for (const Pose2& pose : way_through_small_world()) {
    Observation observation;
    const Scan whole = scan_from(pose, {}, 10.0);
    observation.scan.origin = whole.origin;
    // All of them, every second one, a part with a gap; now and then a single one, or none.
    for (std::size_t i = 0; i < whole.hits.size(); ++i) {
      const bool taken[] = {true, i % 2 == 0, i % 7 < 3 || i > 200, i == 30, false};
      if (taken[step % 5]) observation.scan.hits.push_back(whole.hits[i]);
    }
    observation.odom_from_robot = pose;
    Rng rng(step++);
    result = made->match({local_map_of(whole), observation, 0.0}, rng);
    EXPECT_EQ(result.hypotheses.empty(), observation.scan.hits.empty());
    if (step == 24) break;
  }
  const Pose2 truth = way_through_small_world()[23];
  EXPECT_LT(distance(heaviest(result.hypotheses).map_from_local, truth), 0.2);
}

/// The same answers, whatever else the thread draws, and in another thread.
TEST_F(Mrpt, AnswersAreTheSameInEveryThread) {
  const auto world = world_in({});
  const auto one = matcher(few, world);
  const Answer alone = drive(*one);
  ASSERT_EQ(alone.heaviest.size(), way_through_small_world().size());
  one->reset();
  EXPECT_EQ(drive(*one), alone);
  std::vector<Answer> together(2);
  std::vector<std::unique_ptr<Matcher>> matchers;
  for (int i = 0; i < 2; ++i) matchers.push_back(matcher(few, world));
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < 2; ++i) threads.emplace_back([&, i] { together[i] = drive(*matchers[i]); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(together[0], alone);
  EXPECT_EQ(together[1], alone);
}

/// Trials of a simulated drive, one after the other and two at a time.
TEST_F(Mrpt, FindsTheRobotOnSimulatedDrivesWithAnyNumberOfJobs) {
  const std::filesystem::path file;
  const std::vector<Override> overrides = {
      {"name", "tracking"},
      {"methods", "mrpt_mcl"},
      {"cases", "tracking"},
      {"trials", "{every_m: 5, max_steps: 40, min_steps: 40}"},
      {"localizer.matcher.mrpt_mcl", "{particles_count: 20000, kld_params: {kld_max_sample_size: 20000}}"}};
  const auto run = [&](int jobs) {
    std::mutex mutex;
    std::map<std::size_t, std::pair<std::size_t, std::optional<Pose3>>> ends;
    RunObserver observer;
    observer.trial = [&](const TrialEnd& end) {
      const std::lock_guard lock(mutex);
      ends[end.trial] = {end.steps, end.pose};
    };
    const RunResult result = run_experiment(
        file, overrides, catalog_, {.out = folder_.path() / std::to_string(jobs), .jobs = jobs}, observer);
    EXPECT_GE(result.variants.front().right, 4U);
    EXPECT_LE(result.variants.front().wrong, 1U);
    return ends;
  };
  const auto one = run(1);
  EXPECT_GE(one.size(), 5U);
  EXPECT_EQ(run(2), one);
}

TEST_F(Mrpt, SaysNothingOnTheTerminal) {
  const auto made = matcher(
      std::string(few) + "pf_options: {pf_algorithm: pfAuxiliaryPFStandard, adaptive_sample_size: false}\n",
      world_in({}));
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  (void)drive(*made);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(Mrpt, MapsWithoutPlaceForParticlesAreRefused) {
  MapData data;
  data.points = glocal::test::small_world_points();
  data.grid = {{}, 0.1, 10, 10, PackedCells(100, Cell::unknown)};
  const auto refused = [&](const MapData& map) {
    return config_error(folder_ / "", [&] { (void)matcher("", std::make_shared<const GlobalMap>(map)); });
  };
  EXPECT_THAT(refused(data), HasSubstr("no cell that is known to be free"));
  data.grid.cells[0] = Cell::free;
  EXPECT_EQ(refused(data), "");
  data.points.push_back({2000.0F, 2000.0F, 0.0F});
  EXPECT_THAT(refused(data),
              HasSubstr("the map's points reach over 20001 x 20001 cells of 0.1 m, which is more "
                        "than 64 million cells"));
}

TEST_F(Mrpt, ParametersThatDoNotGoTogetherAreRefused) {
  EXPECT_EQ(fault(few), "");
  EXPECT_THAT(fault("pf_options: {resampling_method: prSystematic}\n"),
              HasSubstr("resampling_method: must be prMultinomial with an adaptive_sample_size"));
  EXPECT_THAT(fault("pf_options: {pf_algorithm: pfAuxiliaryPFStandard}\n"),
              HasSubstr("pf_algorithm: must be pfStandardProposal with an adaptive_sample_size"));
  EXPECT_THAT(fault("pf_options: {pf_algorithm: pfAuxiliaryPFStandard, adaptive_sample_size: false}\n"
                    "motion_model: {model_selection: mmThrun}\n"),
              HasSubstr("motion_model: must have the model_selection mmGaussian with pfAuxiliaryPFStandard"));
  EXPECT_THAT(fault("kld_params: {kld_min_sample_size: 50000}\n"),
              HasSubstr("kld_min_sample_size: must be at most kld_max_sample_size"));
  EXPECT_THAT(fault("pf_options: {pf_algorithm: pfOptimalProposal}\n"), HasSubstr("pfOptimalProposal"));
  EXPECT_THAT(fault("particles_count: 0\n"), HasSubstr("particles_count"));
  EXPECT_THAT(fault("likelihood_options: {lf_z_random: 0}\n"), HasSubstr("lf_z_random"));
}

}  // namespace
}  // namespace glocal::test::mrpt_test
