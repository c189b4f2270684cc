#include "matchers/box_search/search_boxes.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <span>
#include <utility>
#include <vector>

#include "glocal/parallel.hpp"
#include "matchers/box_search/interval_search.hpp"

namespace glocal {
namespace box_search {
namespace {

std::unique_ptr<const PoseBoxes> boxes_of(const BoxPyramid& pyramid, const Points& points,
                                          double robot_height, double min_rotation_step) {
  if (pyramid.of() == BoxPyramid::Of::pose_grid)
    return std::make_unique<PoseGrid>(points, pyramid.frame(), min_rotation_step, robot_height);
  return std::make_unique<AllPoses>(points, pyramid.frame(), pyramid.top_level(), pyramid.motion());
}

}  // namespace

/// A point is laid into a cell in the time of so many looks (a depot and a warehouse of 70 m: 44 to 52 ns, at
/// 8 to 16 ns for a look).
constexpr std::size_t looks_to_lay = 4;

/// First all intervals get a first look. Then those that promise most are searched, a batch of them at a
/// time, and what they bring raises the bar for the next.
class State {
 public:
  State(const BoxPyramid& pyramid, Points points, const Pose3& local_from_robot, const BoxSearchRule& rule,
        const std::optional<Exclusion>& exclusion, int threads)
      : points_(std::move(points)),
        local_from_robot_(local_from_robot),
        rule_(rule),
        exclusion_(exclusion),
        threads_(threads),
        boxes_(boxes_of(pyramid, points_, local_from_robot.z, rule.min_rotation_step)),
        problem_{.pyramid = pyramid,
                 .boxes = *boxes_,
                 .all_poses = dynamic_cast<const AllPoses*>(boxes_.get()),
                 .local_from_robot = local_from_robot_,
                 .rule = rule_,
                 .exclusion = exclusion_,
                 .looks_of_interval = looks_to_lay * points_.size()},
        best_(rule.most_places, rule.least),
        rotations_(boxes_->rotations(pyramid.top_level())) {
    result_.at_most = rule.least - 1;
    // All of them are kept, with some 130 bytes each.
    constexpr std::size_t most_intervals = 4'000'000;
    if (rotations_ > most_intervals) end(false);
  }
  State(const State&) = delete;  // The problem refers to what is here.
  State& operator=(const State&) = delete;

  /// For the time of so many looks.
  void advance(std::size_t& looks_left) {
    while (!is_over_ && looks_left > 0) {
      const std::size_t before = taken_;
      if (first_looks_.size() < rotations_) {
        take_first_looks(looks_left);
      } else if (batch_.empty()) {
        begin_batch();
      } else {
        search_batch(looks_left);
      }
      looks_left -= std::min(looks_left, taken_ - before);
    }
  }

  [[nodiscard]] bool is_over() const { return is_over_; }
  [[nodiscard]] std::size_t looks() const { return looks_; }

  [[nodiscard]] BoxSearchResult result() const {
    BoxSearchResult result = result_;
    if (!result.is_complete) return result;
    for (const Box& box : best_.falling()) result.poses.push_back(problem_.found_at(box));
    return result;
  }

 private:
  /// At as many intervals as these looks are likely to do for, going by those before.
  void take_first_looks(std::size_t looks) {
    constexpr std::size_t at_first = 1;
    // Of a grid, bits are few, and stay in the cache.
    const std::size_t most_together = problem_.all_poses != nullptr ? 64 : 1;
    const std::size_t done = first_looks_.size();
    const std::size_t likely = done == 0 ? at_first : looks / (taken_ / done + 1);
    const std::size_t size = std::clamp<std::size_t>(likely, 1, rotations_ - done);
    first_looks_.resize(done + size);
    const auto threads = static_cast<std::size_t>(threads_);
    const std::size_t together = std::min(most_together, (size + threads - 1) / threads);
    parallel_for(threads_, (size + together - 1) / together, [&](std::size_t part) {
      const std::size_t first = done + part * together;
      std::vector<FirstLook> some = first_looks(problem_, first, std::min(together, done + size - first));
      std::move(some.begin(), some.end(), first_looks_.begin() + static_cast<std::ptrdiff_t>(first));
    });
    for (const FirstLook& look : std::span(first_looks_).subspan(done)) {
      looks_ += look.found.looks;
      taken_ += look.found.looks + problem_.looks_of_interval;
      take_in(look.found);
    }
    if (first_looks_.size() < rotations_) return;
    best_.raise();
    std::ranges::stable_sort(first_looks_, std::greater<>(),
                             [](const FirstLook& look) { return look.interval.promise; });
  }

  /// Intervals searched before the bar is raised. Fixed, so that the answer does not depend on the threads.
  /// One of all poses has as many rotations as many of a grid.
  [[nodiscard]] std::size_t intervals_at_a_time() const { return problem_.all_poses != nullptr ? 8 : 32; }

  void begin_batch() {
    const auto rest = std::span<const FirstLook>(first_looks_).subspan(next_);
    const auto some = rest.first(std::min(intervals_at_a_time(), rest.size()));
    next_ += some.size();
    const bool is_given_up = result_.looks > rule_.most_looks;
    looks_each_ = is_given_up ? 0 : rule_.most_looks - result_.looks;
    for (const auto& [interval, found] : some) {
      if (interval.bound < best_.bar()) continue;
      if (is_given_up) return end(false);
      batch_.emplace_back(problem_, interval, best_.bar(), looks_each_);
    }
    if (batch_.empty() && next_ == first_looks_.size()) end(true);
  }

  void search_batch(std::size_t looks) {
    const std::size_t looks_of_each = std::max<std::size_t>(looks / batch_.size(), 1);
    const std::size_t before = looks_in_batch();
    std::vector<std::size_t> taken(batch_.size());
    parallel_for(threads_, batch_.size(),
                 [&](std::size_t i) { taken[i] = batch_[i].advance(looks_of_each); });
    for (const std::size_t of_interval : taken) taken_ += of_interval;
    looks_ += looks_in_batch() - before;
    if (std::ranges::all_of(batch_, &IntervalSearch::is_over)) end_batch();
  }

  [[nodiscard]] std::size_t looks_in_batch() const {
    std::size_t looks = 0;
    for (const IntervalSearch& search : batch_) looks += search.found().looks;
    return looks;
  }

  void end_batch() {
    for (const IntervalSearch& search : batch_) {
      take_in(search.found());
      best_.raise();
      if (search.found().looks > looks_each_) return end(false);
    }
    batch_.clear();
    if (next_ == first_looks_.size()) end(true);
  }

  void take_in(const FoundPlaces& found) {
    result_.tested += found.tested;
    result_.looks += found.looks;
    result_.at_most = std::max(result_.at_most, found.at_most);
    best_.add(found.places);
  }

  void end(bool is_complete) {
    result_.is_complete = is_complete;
    is_over_ = true;
  }

  Points points_;
  Pose3 local_from_robot_;
  BoxSearchRule rule_;
  std::optional<Exclusion> exclusion_;
  int threads_;
  std::unique_ptr<const PoseBoxes> boxes_;
  Problem problem_;
  BestPlaces best_;
  BoxSearchResult result_;
  std::size_t looks_ = 0;  ///< With those of intervals whose result does not count yet.
  std::size_t taken_ = 0;  ///< The same with the time that laying points takes, in looks.
  bool is_over_ = false;
  std::size_t rotations_;               ///< How many intervals there are.
  std::vector<FirstLook> first_looks_;  ///< Once there are all, those that promise most come first.
  std::size_t next_ = 0;                ///< Of them; those before are searched, or in the batch.
  std::vector<IntervalSearch> batch_;   ///< Searched before the bar is raised again.
  std::size_t looks_each_ = 0;          ///< That an interval of the batch may take.
};

}  // namespace box_search

BoxSearch::BoxSearch(const BoxPyramid& pyramid, Points points, const Pose3& local_from_robot,
                     const BoxSearchRule& rule, const std::optional<Exclusion>& exclusion, int threads) {
  over_.at_most = rule.least - 1;
  over_.is_complete = points.size() <= TileCounts::most_points && rule.least > points.size();
  if (points.size() <= TileCounts::most_points && !over_.is_complete)
    state_ = std::make_unique<box_search::State>(pyramid, std::move(points), local_from_robot, rule,
                                                 exclusion, threads);
}

BoxSearch::BoxSearch(BoxSearch&&) noexcept = default;
BoxSearch& BoxSearch::operator=(BoxSearch&&) noexcept = default;
BoxSearch::~BoxSearch() = default;

std::size_t BoxSearch::advance(std::size_t& looks_left) {
  if (is_over()) return 0;
  const std::size_t before = state_->looks();
  state_->advance(looks_left);
  return state_->looks() - before;
}

bool BoxSearch::is_over() const {
  return !state_ || state_->is_over();
}

BoxSearchResult BoxSearch::result() const {
  return state_ ? state_->result() : over_;
}

BoxSearchResult search_boxes(const BoxPyramid& pyramid, const Points& points, const Pose3& local_from_robot,
                             const BoxSearchRule& rule, const std::optional<Exclusion>& exclusion,
                             int threads) {
  BoxSearch search(pyramid, points, local_from_robot, rule, exclusion, threads);
  std::size_t looks_left = BoxSearch::to_the_end;
  search.advance(looks_left);
  return search.result();
}

}  // namespace glocal
