#include "sources/disturbed/range_disturbances.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "glocal/pose2.hpp"

namespace glocal::disturbed {

void add_noise(Readings& readings, double sigma, Rng& rng) {
  for (Reading& reading : readings.all()) {
    const auto error = static_cast<float>(rng.normal(sigma));
    if (reading.is_hit) readings.set_range(reading, reading.range + error);
  }
}

void add_bias(Readings& readings, double bias, Rng& /*rng*/) {
  for (Reading& reading : readings.all())
    readings.set_range(reading, reading.range + static_cast<float>(bias));
}

void stretch(Readings& readings, double excess, Rng& /*rng*/) {
  for (Reading& reading : readings.all())
    readings.set_range(reading, reading.range * static_cast<float>(1.0 + excess));
}

void draw_outliers(Readings& readings, double share, Rng& rng) {
  const float farthest = readings.farthest();
  for (Reading& reading : readings.all()) {
    const bool is_outlier = rng.uniform() < share;
    const auto range = static_cast<float>(rng.uniform(0.0, farthest));
    if (is_outlier && reading.is_hit) readings.set_range(reading, range);
  }
}

void cross_talk(Readings& readings, double share, Rng& rng) {
  constexpr std::size_t in_a_row = 10;
  const float farthest = readings.farthest();
  std::vector<Reading>& all = readings.all();
  for (std::size_t begin = 0; begin < all.size(); begin += in_a_row) {
    const bool is_hit = rng.uniform() < share;
    const auto range = static_cast<float>(rng.uniform(0.0, farthest));
    for (std::size_t i = begin; is_hit && i < std::min(begin + in_a_row, all.size()); ++i) {
      if (all[i].is_hit) readings.set_range(all[i], range);
    }
  }
}

void raise_dust(Readings& readings, double density, Rng& rng) {
  for (Reading& reading : readings.all()) {
    const auto clear = static_cast<float>(-std::log(1.0 - rng.uniform()) / density);
    if (clear >= reading.range) continue;
    readings.set_range(reading, clear);
    reading.is_hit = true;
  }
}

void mix_at_edges(Readings& readings, double share, Rng& rng) {
  constexpr float edge = 0.5F;  // m
  std::vector<Reading>& all = readings.all();
  float last = all.empty() ? 0.0F : all.front().range;  // as it was measured
  for (std::size_t i = 1; i < all.size() && all[i].is_hit; ++i) {
    const float here = all[i].range;
    const bool is_mixed = rng.uniform() < share;
    const float between = std::min(last, here) + static_cast<float>(rng.uniform()) * std::abs(here - last);
    if (is_mixed && std::abs(here - last) > edge) readings.set_range(all[here > last ? i : i - 1], between);
    last = here;
  }
}

void drop_beams(Readings& readings, double share, Rng& rng) {
  readings.lose_if([&](const Reading& /*reading*/) { return rng.uniform() < share; });
}

void thin_out(Readings& readings, double step_deg, Rng& /*rng*/) {
  // Beams of a lidar's rings lie above each other: each height has bearings of its own.
  std::map<std::pair<int, bool>, float> last;
  readings.lose_if([&](const Reading& reading) {
    const float bearing = readings.bearing(reading);
    const auto [left, is_first] = last.try_emplace({readings.ring(reading), reading.is_hit}, bearing);
    // Bearings come out of single precision, so a step of its own length may be a little short.
    const double least = radians(step_deg) * (1.0 - 1e-4);
    if (!is_first && std::abs(wrap_angle(static_cast<double>(bearing) - left->second)) < least) return true;
    left->second = bearing;
    return false;
  });
}

void thin_rings(Readings& readings, double step, Rng& /*rng*/) {
  std::map<int, std::size_t> rings;  // By height, and then their places from below.
  for (const Reading& reading : readings.all()) rings.try_emplace(readings.ring(reading));
  std::size_t place = 0;
  for (auto& [ring, number] : rings) number = place++;
  const auto every = static_cast<std::size_t>(std::max(std::lround(step), 1L));
  readings.lose_if([&](const Reading& reading) { return rings.at(readings.ring(reading)) % every != 0; });
}

void cut_range(Readings& readings, double range, Rng& /*rng*/) {
  for (Reading& reading : readings.all()) {
    if (reading.range <= static_cast<float>(range)) continue;
    readings.set_range(reading, static_cast<float>(range));
    reading.is_hit = false;
  }
}

void cut_view(Readings& readings, double angle_deg, Rng& /*rng*/) {
  readings.lose_if(
      [&](const Reading& reading) { return std::abs(readings.bearing(reading)) > radians(angle_deg / 2.0); });
}

void stand_before(Readings& readings, double angle_deg, Rng& /*rng*/) {
  constexpr float away = 0.6F;  // m, an arm's length
  for (Reading& reading : readings.all()) {
    if (reading.range <= away || std::abs(readings.bearing(reading)) > radians(angle_deg / 2.0)) continue;
    readings.set_range(reading, away);
    reading.is_hit = true;
  }
}

}  // namespace glocal::disturbed
