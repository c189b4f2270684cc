#include "evaluation/running/reference_fit.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "glocal/contact.hpp"
#include "glocal/evenly.hpp"

namespace glocal {
namespace {

/// Adds so many hits of a scan, evenly spread, at a pose.
void place_hits(const Scan& scan, const Pose3& map_from_robot, std::size_t most, Points& ends) {
  const Points placed = moved(scan.hits, map_from_robot);
  for (const std::size_t k : evenly_chosen(placed.size(), most)) ends.push_back(placed[k]);
}

/// Those of many points that may be within `reach` (m) of one of some others, and more: an index of a whole
/// map takes more memory than the map.
Points points_near(const Points& points, const Points& others, double reach) {
  const auto square = [&](double x, double y) {
    return std::pair(static_cast<std::int64_t>(std::floor(x / reach)),
                     static_cast<std::int64_t>(std::floor(y / reach)));
  };
  std::vector<std::pair<std::int64_t, std::int64_t>> squares;
  for (std::size_t i = 0; i < others.size(); ++i) {
    for (const double dx : {-reach, 0.0, reach}) {
      for (const double dy : {-reach, 0.0, reach})
        squares.push_back(square(others.x[i] + dx, others.y[i] + dy));
    }
  }
  std::sort(squares.begin(), squares.end());
  squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
  Points near;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (std::binary_search(squares.begin(), squares.end(), square(points.x[i], points.y[i])))
      near.push_back(points[i]);
  }
  return near;
}

}  // namespace

std::optional<double> reference_fit(const Drive& drive, const GlobalMap& map, double epsilon) {
  constexpr std::size_t scans = 50, hits_of_scan = 200;
  std::vector<const Sample*> judged;
  for (const Sample& sample : drive.samples) {
    if (sample.map_from_robot && !sample.observation.scan.hits.empty()) judged.push_back(&sample);
  }
  if (judged.empty()) return std::nullopt;
  Points ends;
  for (const std::size_t i : evenly_chosen(judged.size(), scans))
    place_hits(judged[i]->observation.scan, map.relative(*judged[i]->map_from_robot), hits_of_scan, ends);
  const Points near = points_near(map.points(), ends, epsilon);
  if (near.empty()) return 0.0;
  // Not one of the map's indexes, whose time to build is counted when a strategy asks for them.
  return KdTreeContact(near, epsilon).share(ends, Transform(Pose2{}));
}

std::optional<double> fit_among_scans(const Drive& drive,
                                      const std::function<std::optional<Pose3>(double)>& reference_at,
                                      double epsilon) {
  constexpr std::size_t scans = 400, hits_of_scan = 100;
  Points ends, others;
  std::size_t placed = 0;
  Vector3 origin = Vector3::Zero();
  const std::vector<std::size_t> picked = evenly_chosen(drive.samples.size(), scans);
  for (const std::size_t i : picked) {
    const Observation& observation = drive.samples[i].observation;
    const auto pose = reference_at(observation.stamp);
    if (!pose) continue;
    if (placed == 0) origin = origin_near(pose->translation());
    place_hits(observation.scan, shifted(*pose, -origin), hits_of_scan, ++placed % 2 == 0 ? others : ends);
  }
  if (ends.empty() || others.empty() || 2 * placed < picked.size()) return std::nullopt;
  return KdTreeContact(others, epsilon).share(ends, Transform(Pose2{}));
}

std::optional<std::string> doubt_of_references(const Drive& drive, const GlobalMap& map, double epsilon) {
  constexpr double least = 0.15;
  constexpr double least_reach = 0.1;  // m; references and maps are off by centimetres, however fine the map
  const double reach = std::max(epsilon, least_reach);
  const auto share = reference_fit(drive, map, reach);
  if (!share || *share >= least) return std::nullopt;
  return fmt::format(
      "at the reference poses only {:.0f} % of what is seen lies within {:g} m of the map: they are in "
      "another frame than the map, or of another time than the scans, and the answers cannot be judged by "
      "them",
      100.0 * *share, reach);
}

}  // namespace glocal
