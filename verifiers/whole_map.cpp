#include "verifiers/whole_map.hpp"

#include <algorithm>
#include <cmath>

#include "glocal/evenly.hpp"
#include "matchers/box_search/map_area.hpp"
#include "matchers/box_search/search_boxes.hpp"
#include "matchers/common/candidates.hpp"
#include "verifiers/contact_climb.hpp"

namespace glocal {
namespace {

/// That are judged: those with the most contact.
constexpr std::size_t most_rivals = 10;
/// A search that looks at more points is given up, and nothing is declared in that step. On maps of more than
/// 2 hectares it may look at as many more as they are larger.
constexpr double max_looks = 40e6;
/// How many more points a search in space looks at: there are heights, too, and scans have many points.
constexpr double more_looks_in_space = 10.0;

/// Points of a local map in space that count. A share of contact of 80 % among them has a standard deviation
/// of 1.6 %, a third of the margin.
constexpr std::size_t most_points_in_space = 600;

/// Points that are enough to find a mirrored pose that fits clearly better; all of them judge it then.
constexpr std::size_t most_mirrored_points = 150;

Points some_of(const Points& points, std::size_t most) {
  Points chosen;
  for (const std::size_t i : evenly_chosen(points.size(), most)) chosen.push_back(points[i]);
  return chosen;
}

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
      threads_(setup.threads) {
  most_looks_ = looks_on(*setup.map, max_looks * (in_space_ ? more_looks_in_space : 1.0));
  contact_ = contact_index(*setup.map, in_space_ ? "bitset" : contact_for(area_of(*setup.map)), epsilon_);
  if (!in_space_) field_ = distance_field(*setup.map, setup.threads);
  const double automatic = in_space_ ? automatic_box_cell_in_space(*setup.map, epsilon_)
                                     : automatic_box_cell(*setup.map, epsilon_);
  pyramid_ = box_pyramid(BoxPyramid::Of::all_poses, *setup.map, params.cell.value_or(automatic), epsilon_,
                         setup.motion, setup.threads);
}

Verification WholeMap::verify(const LocalMap& local, const Pose3& map_from_local, const PoseGate& gate) {
  const Points points = in_space_ ? some_of(local.points, most_points_in_space) : local.points;
  const auto size = static_cast<double>(points.size());
  const double contact = contact_of(points, map_from_local);
  const double least = std::max(1.0, std::ceil((contact - params_.margin) * size));
  const BoxSearchRule rule{.least = static_cast<std::size_t>(least),
                           .most_places = most_rivals,
                           .most_looks = most_looks_,
                           .gate = gate};
  const Exclusion declared{map_from_local * local.local_from_robot,
                           {.translation = params_.distance, .rotation = radians(params_.rotation_deg)}};
  const BoxSearchResult search =
      search_boxes(*pyramid_, points, local.local_from_robot, rule, declared, threads_);
  Verification result{.near = declared.near, .margin = params_.margin};
  result.points_tested = search.looks;
  result.mirrored_contact = mirrored_contact(points, local.local_from_robot, contact);
  std::vector<Hypothesis> rivals;
  for (const BoxSearchResult::FoundPose& found : search.poses) {
    for (const Pose3& pose : {found.upright(), refined(points, found.upright())}) {
      const Pose3 robot = pose * local.local_from_robot;
      if (gate.allows(pose) && !declared.near.are_near(robot, declared.map_from_robot))
        rivals.push_back(Hypothesis::by_contact(pose, contact_of(points, pose)));
    }
  }
  result.rivals = distinct_candidates(std::move(rivals), local.local_from_robot, rule.most_places);
  if (search.is_complete)
    result.certificate = {.contact = contact,
                          .at_most = static_cast<double>(search.at_most) / size,
                          .epsilon = epsilon_,
                          .delta = pyramid_->delta()};
  return result;
}

std::optional<double> WholeMap::mirrored_contact(Points points, const Pose3& local_from_robot,
                                                 double contact) const {
  if (in_space_ || contact + params_.margin > 1.0) return std::nullopt;
  for (float& y : points.y) y = -y;
  const Points sample = some_of(points, most_mirrored_points);
  const double least = std::ceil((contact + params_.margin) * static_cast<double>(sample.size()));
  const Pose2 robot = seen_from_above(local_from_robot);
  const Pose2 mirrored_robot{robot.x, -robot.y, -robot.theta};
  const BoxSearchRule rule{
      .least = static_cast<std::size_t>(least), .most_places = 1, .most_looks = most_looks_};
  const BoxSearchResult search =
      search_boxes(*pyramid_, sample, mirrored_robot, rule, std::nullopt, threads_);
  if (search.poses.empty()) return std::nullopt;
  const Pose3 best = refined(points, search.poses.front().upright());
  const double mirrored = contact_of(points, best);
  return mirrored >= contact + params_.margin ? std::optional(mirrored) : std::nullopt;
}

double WholeMap::contact_of(const Points& points, const Pose3& map_from_points) const {
  return in_space_ ? contact_->share(points, map_from_points)
                   : contact_->share(points, Transform(seen_from_above(map_from_points)));
}

Pose3 WholeMap::refined(const Points& points, const Pose3& map_from_points) const {
  if (in_space_) return climbed_pose(*contact_, points, map_from_points, pyramid_->frame().cell / 2.0);
  return refined_pose(*field_, points, seen_from_above(map_from_points), {});
}

}  // namespace glocal
