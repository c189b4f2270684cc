#include "glocal/readings.hpp"

#include <cmath>
#include <numbers>

#include "glocal/pose2.hpp"

namespace glocal {

std::vector<PolarReading> readings_of(const Scan& scan) {
  std::vector<PolarReading> readings;
  readings.reserve(scan.hits.size());
  for (std::size_t i = 0; i < scan.hits.size(); ++i) {
    const double x = static_cast<double>(scan.hits.x[i]) - static_cast<double>(scan.origin.x);
    const double y = static_cast<double>(scan.hits.y[i]) - static_cast<double>(scan.origin.y);
    readings.push_back({std::sqrt(x * x + y * y), std::atan2(y, x)});
  }
  return readings;
}

ReadingByDirection by_direction(const std::vector<PolarReading>& readings) {
  constexpr double width = 2.0 * std::numbers::pi / static_cast<double>(directions);
  struct Sum {
    double number = 0.0, range = 0.0, offset = 0.0;
  };
  std::array<Sum, directions> sums{};
  const auto middle = [&](std::size_t i) { return width * (static_cast<double>(i) + 0.5); };
  for (const PolarReading& reading : readings) {
    const double angle = reading.angle < 0.0 ? reading.angle + 2.0 * std::numbers::pi : reading.angle;
    const std::size_t i = static_cast<std::size_t>(angle / width) % directions;
    sums[i].number += 1.0;
    sums[i].range += reading.range;
    sums[i].offset += wrap_angle(angle - middle(i));
  }
  ReadingByDirection means;
  for (std::size_t i = 0; i < directions; ++i) {
    const Sum& sum = sums[i];
    if (sum.number > 0.0)
      means[i] = {sum.range / sum.number, wrap_angle(middle(i) + sum.offset / sum.number)};
  }
  return means;
}

}  // namespace glocal
