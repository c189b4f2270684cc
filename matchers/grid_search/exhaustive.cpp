#include "matchers/grid_search/exhaustive.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

#include "glocal/parallel.hpp"
#include "matchers/box_search/allowed_translations.hpp"

namespace glocal::grid_search {
namespace {

/// Rotations searched before the bar is raised. Fixed, so that the answer does not depend on the threads.
constexpr std::size_t rotations_per_round = 32;
/// Points looked at before a pose is asked again whether it can still reach the bar.
constexpr std::size_t batch = 16;

/// For each batch of n points, how many must have been in contact so that the others can make up the rest.
std::vector<std::uint32_t> least_after_batches(std::size_t n, std::size_t least) {
  std::vector<std::uint32_t> result;
  for (std::size_t looked_at = 0; looked_at < n;) {
    looked_at = std::min(n, looked_at + batch);
    const std::size_t others = n - looked_at;
    result.push_back(static_cast<std::uint32_t>(least > others ? least - others : 0));
  }
  return result;
}

/// Poses of one rotation on their way through the test, as many at a time as a MotionBatch has.
class Candidates {
 public:
  Candidates(const ContactIndex& contact, const Points& points, std::size_t least)
      : contact_(contact),
        points_(points),
        least_(least),
        least_after_(least_after_batches(points.size(), least)) {}

  [[nodiscard]] bool full() const { return size_ == MotionBatch::capacity; }
  void add(const Transform& map_from_points, const Box& pose) {
    motions_.cosine[size_] = map_from_points.cosine();
    motions_.sine[size_] = map_from_points.sine();
    motions_.x[size_] = map_from_points.x();
    motions_.y[size_] = map_from_points.y();
    poses_[size_++] = pose;
  }

  /// Adds those that reach the bar, and begins anew.
  void test(const RobotCells& robots, FoundPlaces& found) {
    const std::size_t n = points_.size();
    const ContactIndex::BatchColumn begins{};
    contact_.count_at_most(points_, n, motions_, size_, begins, at_most_);
    found.tested += size_;
    found.looks += size_ * n;
    for (std::size_t i = 0; i < size_; ++i) {
      if (at_most_[i] < least_) continue;
      const auto [in_contact, looked_at] =
          contact_.count_while(points_, 0, n, batch, least_after_, motions_[i]);
      found.looks += looked_at;
      if (in_contact < least_) continue;
      poses_[i].at_middle = in_contact;
      take_in(found.places, robots.of(poses_[i]), poses_[i]);
    }
    size_ = 0;
  }

 private:
  const ContactIndex& contact_;
  const Points& points_;
  std::size_t least_;
  std::vector<std::uint32_t> least_after_;
  std::size_t size_ = 0;
  MotionBatch motions_;
  std::array<Box, MotionBatch::capacity> poses_{};
  ContactIndex::BatchColumn at_most_{};
};

}  // namespace

void describe(ParamVisitor& v, Exhaustive::Params& p) {
  describe(v, p.matching.grid);
  v.field("min_rotation_step_deg", p.matching.grid.min_rotation_step_deg,
          {.doc = "Smallest step between rotations; a step moves the farthest point by one cell otherwise.",
           .unit = "deg",
           .min = 0.005,
           .max = 5.7,
           .audience = Audience::expert,
           .formerly = "min_rotation_step"});
  p.contact.describe_as("contact", v);
}

Exhaustive::Exhaustive(const Params& params, const StageSetup& setup)
    : GridMatcher(
          params.matching, setup,
          contact_index(*setup.map, params.contact, setup.epsilon(params.matching.grid.contact_epsilon))),
      threads_(setup.threads),
      frame_(cell_frame(setup.map->points(), params.matching.grid.cell,
                        setup.epsilon(params.matching.grid.contact_epsilon))) {
  check_cell(params.matching.grid.cell, setup.epsilon(params.matching.grid.contact_epsilon));
}

BoxSearchResult Exhaustive::search(const Points& points, const Pose3& local_from_robot,
                                   const BoxSearchRule& rule) const {
  const PoseGrid grid(points, frame_, rule.min_rotation_step);
  BestPlaces best(rule.most_places, rule.least);
  BoxSearchResult result{.is_complete = true};
  for (std::size_t begin = 0; begin < grid.rotations(0); begin += rotations_per_round) {
    std::vector<FoundPlaces> found(std::min(rotations_per_round, grid.rotations(0) - begin));
    parallel_for(threads_, found.size(), [&](std::size_t i) {
      found[i] = search_rotation(grid, begin + i, points, local_from_robot, rule, best.bar());
    });
    for (const FoundPlaces& rotation : found) {
      result.tested += rotation.tested;
      result.looks += rotation.looks;
      best.add(rotation.places);
    }
    best.raise();
  }
  for (const Box& box : best.falling())
    result.poses.push_back({grid.pose(0, box.rotation, box.column, box.row), 0.0, box.at_middle});
  return result;
}

FoundPlaces Exhaustive::search_rotation(const PoseGrid& grid, std::size_t rotation, const Points& points,
                                        const Pose3& local_from_robot, const BoxSearchRule& rule,
                                        std::size_t least) const {
  const Translations all = grid.translations(grid.cells(0, rotation), least);
  const Pose2 at_zero = grid.pose(0, rotation, 0.0, 0.0);
  const RobotCells robots(at_zero * seen_from_above(local_from_robot), 0.0, frame_.cell, rule.cell_distance,
                          rule.cell_rotation);
  const AllowedTranslations allowed(rule.gate, at_zero, frame_.cell);
  const Transform turned(at_zero);
  Candidates candidates(contact(), points, least);
  FoundPlaces found;
  for (int row = all.first_row; row <= all.last_row; ++row) {
    for (int column = all.first_column; column <= all.last_column; ++column) {
      if (!allowed.any(column, row)) continue;
      candidates.add({turned.cosine(), turned.sine(), static_cast<float>(at_zero.x + frame_.cell * column),
                      static_cast<float>(at_zero.y + frame_.cell * row)},
                     {.rotation = rotation, .row = row, .column = column});
      if (candidates.full()) candidates.test(robots, found);
    }
  }
  candidates.test(robots, found);
  return found;
}

}  // namespace glocal::grid_search
