#include "matchers/indexed_ransam/exact_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "matchers/box_search/map_area.hpp"

namespace glocal::indexed_ransam {

void describe(ParamVisitor& v, ExactSearchRule& p) {
  v.field("after_steps", p.after_steps,
          {.doc = "An exact search follows the last of so many steps in a row without a clear best pose, the "
                  "next one after twice as many more, and so on; 0 never searches.",
           .min = 0,
           .max = 1e6});
  v.removed("min_rotation_step_deg", "intervals of rotations follow the cell");
  v.removed("min_rotation_step", "intervals of rotations follow the cell");
}

ExactSearch::ExactSearch(const ExactSearchRule& rule, const GlobalMap& map, double contact_epsilon,
                         int threads)
    : rule_(rule), most_looks_(looks_on(map, rule.max_looks)), threads_(threads), wait_(rule.after_steps) {
  if (rule.after_steps == 0) return;
  const double cell = rule.cell.value_or(automatic_box_cell(map, contact_epsilon));
  pyramid_ = box_pyramid(BoxPyramid::Of::all_poses, map, cell, contact_epsilon, Motion::planar, threads);
}

bool ExactSearch::is_due(const std::vector<Hypothesis>& best) {
  const bool is_clear =
      best.size() == 1 || (best.size() > 1 && best[0].score - best[1].score >= rule_.margin);
  if (is_clear) reset();
  if (!pyramid_ || is_clear || open_ || ++undecided_ < wait_) return false;
  undecided_ = 0;
  wait_ = std::min(2 * wait_, std::numeric_limits<int>::max() / 4);
  return true;
}

void ExactSearch::reset() {
  open_.reset();
  undecided_ = 0;
  wait_ = rule_.after_steps;
}

void ExactSearch::begin(Points points, const Pose3& local_from_robot, const PoseGate& gate) {
  // A high bar prunes nearly all of the map at once, and the right pose is above it as a rule.
  constexpr double first_bar = 0.95;
  open_.emplace(Search{std::move(points), local_from_robot, gate, std::max(first_bar, rule_.min_contact)});
}

BoxSearch ExactSearch::round_of(const Search& search, const std::vector<Hypothesis>& best) const {
  const double least = std::max(1.0, std::ceil(search.bar * static_cast<double>(search.points.size())));
  const BoxSearchRule rule{.least = static_cast<std::size_t>(least),
                           .most_places = static_cast<std::size_t>(rule_.max_poses),
                           .most_looks = most_looks_ - search.looks,
                           .gate = search.gate};
  std::optional<Exclusion> known;
  if (!best.empty()) known = {best.front().map_from_local * search.local_from_robot};
  return {*pyramid_, search.points, search.local_from_robot, rule, known, threads_};
}

std::size_t ExactSearch::advance(std::vector<Hypothesis> best, std::size_t looks_left, const Settle& settle) {
  constexpr double lower = 0.1;
  std::size_t looks = 0;
  while (open_ && looks_left > 0) {
    if (!open_->round) open_->round = round_of(*open_, best);
    looks += open_->round->advance(looks_left);
    if (!open_->round->is_over()) break;
    const BoxSearchResult result = open_->round->result();
    open_->round.reset();
    open_->looks += result.looks;
    std::vector<Pose2> poses;
    for (const BoxSearchResult::FoundPose& found : result.poses)
      poses.push_back(seen_from_above(found.pose()));
    if (!poses.empty()) best = settle(poses);
    const double bar = open_->bar;
    const bool is_settled = !best.empty() && best.front().score >= bar - lower;
    if (is_settled || bar <= rule_.min_contact || !result.is_complete || open_->looks >= most_looks_)
      open_.reset();
    else
      open_->bar = std::max(bar - lower, rule_.min_contact);
  }
  return looks;
}

}  // namespace glocal::indexed_ransam
