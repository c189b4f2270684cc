#include "verifiers/whole_map.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "glocal/evenly.hpp"
#include "matchers/box_search/map_area.hpp"
#include "matchers/common/candidates.hpp"
#include "verifiers/contact_climb.hpp"

namespace glocal::verifiers {
namespace {

/// That are judged: those with the most contact. Of several maps as many for each: floors that are alike have
/// each rival once.
constexpr std::size_t most_rivals_on_map = 10;
/// A search that looks at more points is given up, and nothing is declared in that step. On maps of more than
/// 2 hectares it may look at as many more as they are larger.
constexpr double max_looks = 40e6;
/// What a search may take.
struct Effort {
  double more_looks = 1.0;  ///< So many times those of the plane.
  /// Of a local map that count. A share of contact of 80 % among 600 has a standard deviation of 1.6 %, a
  /// third of the margin, and among 300 of 2.3 %.
  std::size_t most_points = std::numeric_limits<std::size_t>::max();
};

/// In space there are heights, too, and scans have many points. Where poses tilt, there are some hundred
/// tilts for each turn.
Effort effort_of(Motion motion) {
  switch (motion) {
    case Motion::planar:
      break;
    case Motion::upright:
      return {.more_looks = 10.0, .most_points = 600};
    case Motion::free:
      return {.more_looks = 100.0, .most_points = 300};
  }
  return {};
}

/// Points that are enough to find a mirrored pose that fits clearly better; all of them judge it then.
constexpr std::size_t most_mirrored_points = 150;

/// Left and right have changed places where the mirrored local map leaves less than this share of the points
/// out of contact that the declared pose leaves. Offices are nearly their own mirror images: there people and
/// doors put more points out of contact than the mirror does.
constexpr double share_left = 0.5;

/// The exact one would take more memory than all else.
const char* contact_for(double area) {
  return area > huge_area ? "bitset" : "kd_tree";
}

}  // namespace

void describe(ParamVisitor& v, WholeMap::Params& p) {
  v.field("margin", p.margin,
          {.doc = "Poses are searched for whose contact is at most this much lower than the declared pose's, "
                  "and one whose score is at most this much lower refutes the declaration. So does the "
                  "mirrored local map, in the plane, if its contact is higher by this much.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::tuner});
  v.field("distance", p.distance,
          {.doc = "A pose is a rival of the declared one if it is farther away than this, or turned by more "
                  "than rotation_deg.",
           .unit = "m",
           .above = 0.0});
  v.field("rotation_deg", p.rotation_deg,
          {.doc = "A pose is a rival of the declared one if it is turned by more than this, or farther away "
                  "than distance.",
           .unit = "deg",
           .max = 180.0,
           .above = 0.0});
  describe_contact_epsilon(v, p.contact_epsilon);
  v.field("cell", p.cell,
          {.doc = "Side of the smallest boxes of translations, at most contact_epsilon; auto is 0.025 m, "
                  "0.05 m on maps of more than 2 hectares, and 0.1 m on maps of more than 25 hectares; in "
                  "space half of contact_epsilon, and all of it on maps of more than 400 million such "
                  "cells.",
           .unit = "m",
           .min = 0.01,
           .max = 1.0,
           .audience = Audience::expert});
  v.require(!p.contact_epsilon || !p.cell || *p.cell <= *p.contact_epsilon, "cell",
            "must be at most contact_epsilon");
}

WholeMap::WholeMap(const Params& params, const StageSetup& setup)
    : params_(params),
      in_space_(setup.motion != Motion::planar),
      epsilon_(setup.epsilon(params.contact_epsilon)),
      threads_(setup.threads),
      looks_per_step_(setup.looks_per_step),
      most_rivals_(most_rivals_on_map * std::max<std::size_t>(1, setup.map->parts().size())) {
  most_looks_ = looks_on(*setup.map, max_looks * effort_of(setup.motion).more_looks);
  contact_ = contact_index(*setup.map, in_space_ ? "bitset" : contact_for(area_of(setup.map->points())),
                           epsilon_, setup.threads);
  if (!in_space_) field_ = distance_field(*setup.map, setup.threads);
  const double automatic = in_space_ ? automatic_box_cell_in_space(*setup.map, epsilon_)
                                     : automatic_box_cell(*setup.map, epsilon_);
  pyramid_ = box_pyramid(BoxPyramid::Of::all_poses, *setup.map, params.cell.value_or(automatic), epsilon_,
                         setup.motion, setup.threads);
}

Verification WholeMap::verify(const LocalMap& local, const Pose3& map_from_local, const PoseGate& gate) {
  return go_on(local, map_from_local, gate, looks_per_step_);
}

Verification WholeMap::go_on(const LocalMap& local, const Pose3& map_from_local, const PoseGate& gate,
                             std::size_t looks_left) {
  if (!open_ || !is_about(local, map_from_local)) open_.emplace(begin(local, map_from_local, gate));
  Search& search = *open_;
  Verification result{.near = search.declared.near, .margin = params_.margin};
  result.points_tested = search.rivals.advance(looks_left);
  if (search.mirrored) result.points_tested += search.mirrored->advance(looks_left);
  result.goes_on = !search.rivals.is_over() || (search.mirrored && !search.mirrored->is_over());
  if (result.goes_on) return result;
  const BoxSearchResult found = search.rivals.result();
  result.mirrored_contact = mirrored_contact(search);
  result.is_mirrored =
      result.mirrored_contact && 1.0 - *result.mirrored_contact < share_left * (1.0 - search.contact);
  result.rivals = rivals_of(search, found);
  if (found.is_complete)
    result.certificate = {
        .contact = search.contact,
        .at_most = static_cast<double>(found.at_most) / static_cast<double>(search.points.size()),
        .epsilon = epsilon_,
        .delta = pyramid_->delta()};
  open_.reset();
  return result;
}

/// Whether the open search is about this pose.
bool WholeMap::is_about(const LocalMap& local, const Pose3& map_from_local) const {
  const Pose3 declared = map_from_local * open_->local_from_robot;
  return open_->epoch == local.epoch && is_same_candidate(declared, open_->declared.map_from_robot);
}

WholeMap::Search WholeMap::begin(const LocalMap& local, const Pose3& map_from_local,
                                 const PoseGate& gate) const {
  Points points = evenly_chosen(local.points, effort_of(pyramid_->motion()).most_points);
  const double contact = contact_of(points, map_from_local);
  const auto least_of = [](double share, const Points& of) {
    // Not one point more for the rounding of a share that is one of them.
    return static_cast<std::size_t>(std::max(1.0, std::ceil(share * static_cast<double>(of.size()) - 1e-9)));
  };
  const BoxSearchRule rule{.least = least_of(contact - params_.margin, points),
                           .most_places = most_rivals_,
                           .most_looks = most_looks_,
                           .gate = gate};
  const Exclusion declared{map_from_local * local.local_from_robot,
                           {.translation = params_.distance, .rotation = radians(params_.rotation_deg)}};
  BoxSearch rivals(*pyramid_, points, local.local_from_robot, rule, declared, threads_);
  Search search{std::move(points), local.epoch,       local.local_from_robot, declared,    gate,
                contact,           std::move(rivals), std::nullopt,           std::nullopt};
  if (in_space_ || contact + params_.margin > 1.0) return search;
  search.mirrored_points = search.points;
  for (float& y : search.mirrored_points->y) y = -y;
  const Points sample = evenly_chosen(*search.mirrored_points, most_mirrored_points);
  const auto mirrored = [](const Pose3& pose) {
    const Pose2 seen = seen_from_above(pose);
    return Pose2{seen.x, -seen.y, -seen.theta};
  };
  search.mirrored.emplace(*pyramid_, sample, mirrored(local.local_from_robot),
                          BoxSearchRule{.least = least_of(contact + params_.margin, sample),
                                        .most_places = 1,
                                        .most_looks = most_looks_,
                                        .gate = {gate.prior(), mirrored(gate.local_from_start())}},
                          std::nullopt, threads_);
  return search;
}

std::vector<Hypothesis> WholeMap::rivals_of(const Search& search, const BoxSearchResult& found) const {
  std::vector<Hypothesis> rivals;
  for (const BoxSearchResult::FoundPose& place : found.poses) {
    for (const Pose3& pose : {place.pose(), refined(search.points, place.pose())}) {
      const Pose3 robot = pose * search.local_from_robot;
      if (search.gate.allows(pose) && !search.declared.near.are_near(robot, search.declared.map_from_robot))
        rivals.push_back(Hypothesis::by_contact(pose, contact_of(search.points, pose)));
    }
  }
  return distinct_candidates(std::move(rivals), search.local_from_robot, most_rivals_);
}

std::optional<double> WholeMap::mirrored_contact(const Search& search) const {
  if (!search.mirrored) return std::nullopt;
  const BoxSearchResult found = search.mirrored->result();
  if (found.poses.empty()) return std::nullopt;
  const Pose3 best = refined(*search.mirrored_points, found.poses.front().pose());
  const double mirrored = contact_of(*search.mirrored_points, best);
  return mirrored >= search.contact + params_.margin ? std::optional(mirrored) : std::nullopt;
}

double WholeMap::contact_of(const Points& points, const Pose3& map_from_points) const {
  return in_space_ ? contact_->share(points, map_from_points)
                   : contact_->share(points, Transform(seen_from_above(map_from_points)));
}

Pose3 WholeMap::refined(const Points& points, const Pose3& map_from_points) const {
  if (in_space_)
    return climbed_pose(*contact_, points, map_from_points, pyramid_->frame().cell / 2.0, pyramid_->motion());
  return refined_pose(*field_, points, seen_from_above(map_from_points), {});
}

}  // namespace glocal::verifiers
