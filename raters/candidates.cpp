#include "raters/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace glocal::raters {
namespace {

std::size_t count_places(const std::vector<Pose3>& poses) {
  constexpr double same_place_m = 1.0;
  std::vector<Pose3> places;
  for (const Pose3& pose : poses) {
    const bool is_new = std::none_of(places.begin(), places.end(), [&](const Pose3& place) {
      return distance(pose, place) < same_place_m;
    });
    if (is_new) places.push_back(pose);
  }
  return places.size();
}

}  // namespace

Verdict ambiguous(std::vector<Pose3> poses) {
  const std::size_t n = poses.size();
  const std::size_t places = count_places(poses);
  const std::string where = places == n   ? ""
                            : places == 1 ? " at one place"
                                          : fmt::format(" at {} places", places);
  return {VerdictKind::ambiguous, std::nullopt, std::move(poses),
          fmt::format("{} poses{} explain the observations about equally well", n, where)};
}

}  // namespace glocal::raters
