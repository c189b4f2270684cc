#include "raters/candidates.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <utility>

namespace glocal::raters {
namespace {

std::size_t count_places(const std::vector<Pose3>& poses) {
  std::vector<Pose3> places;
  for (const Pose3& pose : poses) {
    const bool is_new = std::ranges::none_of(places, [&](const Pose3& place) {
      return distance(pose, place) < PoseTolerance::default_translation;
    });
    if (is_new) places.push_back(pose);
  }
  return places.size();
}

}  // namespace

std::optional<Verdict> ambiguous(std::vector<Pose3> poses) {
  constexpr std::size_t max_candidates = 10;
  const std::size_t n = poses.size();
  if (n < 2 || n > max_candidates) return std::nullopt;
  const std::size_t places = count_places(poses);
  const std::string where = places == n   ? ""
                            : places == 1 ? " at one place"
                                          : fmt::format(" at {} places", places);
  return Verdict{.kind = VerdictKind::ambiguous,
                 .candidates = std::move(poses),
                 .why = fmt::format("{} poses{} explain the observations about equally well", n, where)};
}

}  // namespace glocal::raters
