// Localizes a robot with the map and the strategies of an experiment file. Each line of standard input is one
// keyframe: the odometry pose (x and y in m, heading in rad), then the ranges of a 180 degree laser from
// right to left (m; 8 m and more: nothing seen).
#include <cmath>
#include <glocal/builtin.hpp>
#include <glocal/error.hpp>
#include <glocal/experiment.hpp>
#include <glocal/localizer.hpp>
#include <iostream>
#include <iterator>
#include <numbers>
#include <sstream>
#include <string>

/// With the numbers that glocal's own reader of logs makes, so that answers are the same to the last bit.
glocal::Observation parse(const std::string& line) {
  constexpr double max_range = 8.0;
  std::istringstream text(line);
  glocal::Observation observation;
  glocal::Pose2 odom;
  text >> odom.x >> odom.y >> odom.theta;
  observation.odom_from_robot = odom;
  const std::vector<float> ranges{std::istream_iterator<float>(text), {}};
  const double step = std::numbers::pi / static_cast<double>(ranges.size() - 1);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    const double bearing = static_cast<double>(i) * step - std::numbers::pi / 2.0;
    const double range = std::min<double>(ranges[i], max_range);
    const glocal::Point end{static_cast<float>(range * std::cos(bearing)),
                            static_cast<float>(range * std::sin(bearing))};
    (ranges[i] < max_range ? observation.scan.hits : observation.scan.free_ends).push_back(end);
  }
  return observation;
}

int main(int argc, char** argv) try {
  glocal::Catalog catalog;
  glocal::register_builtin_strategies(catalog);
  const glocal::Experiment experiment =
      glocal::read_experiment(argc > 1 ? argv[1] : "experiment.yaml", {}, catalog);
  const auto map =
      std::make_shared<const glocal::GlobalMap>(catalog.map_sources.make(experiment.map, {})->load());
  glocal::Localizer localizer(experiment.localizer, catalog, {map, experiment.threads},
                              glocal::seed_of(glocal::RandomPart::localizer, experiment));

  for (std::string line; std::getline(std::cin, line);) {
    glocal::StepResult step = localizer.step(parse(line));
    // Until the next scan comes: here the robot waits.
    while (step.goes_on()) step = localizer.go_on();
    std::cout << step.step << ' ' << glocal::to_string(step.verdict.kind);
    if (const auto& pose = step.verdict.map_from_robot)
      std::cout << ' ' << pose->x << ' ' << pose->y << ' ' << pose->heading();
    std::cout << ": " << step.verdict.why << '\n';
  }
} catch (const glocal::ConfigError& e) {
  std::cerr << e.what() << '\n';
  return 2;
}
