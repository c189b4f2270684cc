// glocal map align: where one map lies in another.
#include "map_align.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <optional>

#include "glocal/contact.hpp"
#include "matchers/ransam.hpp"

namespace glocal::app {
namespace {

/// How well a pose fits: points in contact, over several distances, so that nearer ones count more.
class Fit {
 public:
  Fit(const GlobalMap& map, const Points& other) : other_(other) {
    for (std::size_t i = 0; i < indexes_.size(); ++i)
      indexes_[i] = contact_index(map, "bitset", 0.05 * (1 << i));
  }
  [[nodiscard]] std::size_t operator()(const Pose2& map_from_other) const {
    const Transform transform(map_from_other);
    return std::transform_reduce(
        indexes_.begin(), indexes_.end(), std::size_t{0}, std::plus<>(),
        [&](const auto& index) { return index->count(other_, 0, other_.size(), transform); });
  }

 private:
  const Points& other_;
  std::array<std::shared_ptr<const ContactIndex>, 3> indexes_;  ///< Within 5, 10 and 20 cm.
};

/// Climbs to the pose with the best fit near by, in steps that become smaller.
Pose2 refined(Pose2 pose, const Fit& fit) {
  constexpr double smallest_step = 0.002;
  std::size_t best = fit(pose);
  for (double step = 0.1; step > smallest_step;) {
    const double turn = step / 10.0;  // as much at 10 m from the middle
    const std::size_t before = best;
    for (const Pose2& d : {Pose2{step, 0, 0}, Pose2{-step, 0, 0}, Pose2{0, step, 0}, Pose2{0, -step, 0},
                           Pose2{0, 0, turn}, Pose2{0, 0, -turn}}) {
      const Pose2 tried = pose * d;
      const std::size_t value = fit(tried);
      if (value <= best) continue;
      best = value;
      pose = tried;
    }
    if (best == before) step /= 2.0;
  }
  return pose;
}

/// About the middle of the points, so that turning them does not move them.
Pose2 middle(const Points& points) {
  const auto mean = [&](const std::vector<float>& v) {
    return std::accumulate(v.begin(), v.end(), 0.0) / static_cast<double>(v.size());
  };
  return {mean(points.x), mean(points.y), 0.0};
}

}  // namespace

std::optional<Alignment> align_maps(const std::shared_ptr<const GlobalMap>& map, const Points& other,
                                    const Ransam::Params& params, std::uint64_t seed) {
  Ransam matcher(params, {map, 1});
  LocalMap local;
  local.points = other;
  local.ends = {other.size()};
  Rng rng(seed);
  // Maps of one place may have little in common: furniture, rooms behind doors.
  for (const double omega_max : {0.6, 0.4, 0.25}) {
    const MatchResult result = matcher.match(local, {}, omega_max, rng);
    if (result.hypotheses.empty()) continue;
    const Pose2 other_from_middle = middle(other);
    Points centred;
    const Transform to_middle(inverse(other_from_middle));
    for (std::size_t i = 0; i < other.size(); ++i) centred.push_back(to_middle(other[i]));
    const Fit fit(*map, centred);
    const Pose2 map_from_middle = refined(result.hypotheses.front().map_from_local * other_from_middle, fit);
    const Pose2 map_from_other = map_from_middle * inverse(other_from_middle);
    const auto contact = contact_index(*map, params.contact, params.contact_epsilon);
    return Alignment{map_from_other,
                     static_cast<double>(contact->count(other, 0, other.size(), Transform(map_from_other))) /
                         static_cast<double>(other.size())};
  }
  return std::nullopt;
}

}  // namespace glocal::app
