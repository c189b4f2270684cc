#include "glocal/setup_check.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace glocal {
namespace {

/// Steps that are looked back at.
constexpr std::size_t window = 40;
/// Scans of fewer hits may be the same by chance.
constexpr std::size_t least_hits = 10;

/// A robot whose odometry tells less holds still.
constexpr double least_way = 0.05;
constexpr double least_turn = radians(2.0);
/// A motion as long as this has a direction.
constexpr double directed_way = 0.1;

/// The local mapper has taken odometry's motion as it was, m and rad: no scan says that.
constexpr double as_it_was = 1e-6;

/// A sensor turned by more is a fault: the heading is off by as much.
constexpr double most_mount_angle_deg = 7.5;
/// Of directions of single steps, at least: nobody drives and measures better.
constexpr double least_spread = radians(2.5);
/// Directions are waited for until this way (m) was driven, but not for ever: the robot perhaps turns in
/// place.
constexpr double first_way = 0.2;
constexpr std::size_t most_steps_for_first_way = 5;

/// Steps in which a scan that came again is remembered.
constexpr std::size_t window_of_repetitions = 20;
/// Scans that are mirrored or late fit odometry that is, too, with less than this share of the difference.
constexpr double share_of_better = 0.4;

/// How far apart scans and odometry of one robot are at most, as a rule: 98 of 100 steps of recorded drives.
constexpr double turn_tolerance = radians(4.0);
constexpr double turn_tolerance_share = 0.25;
constexpr double way_tolerance = 0.06;
constexpr double way_tolerance_share = 0.15;
constexpr double direction_tolerance = radians(30.0);
/// Wheels that spin tell up to twice the motion.
constexpr double least_grip = 0.5;

/// What a step adds to the agreement: logarithms of how much more often it occurs in good recorded drives
/// than in the same with scans 5 to 15 observations late.
constexpr double for_agreement = 0.5;
constexpr double for_agreement_in_turn = 1.5;
constexpr double for_other_turn = -2.5;
/// In bare corridors scans do not tell the way.
constexpr double for_other_way = -0.5;
constexpr double sharp_turn = radians(8.0);
constexpr double most_agreement = 5.0;
constexpr double least_agreement = -10.0;
/// Below this, scans and odometry do not belong together.
constexpr double agreement_of_fault = -6.0;

/// Of ranges that never change, this share is a fault.
constexpr double most_stuck = 0.2;

/// Good sensors are off by less, m, ...
constexpr double most_bias = 0.15;
/// ... and the median over some walls by this, divided by the root of their number, ...
constexpr double spread_of_bias = 0.15;
/// ... or, to be sure, by this over so many.
constexpr double sure_spread_of_bias = 1.0;
constexpr std::size_t least_walls = 12;
/// A doubt of fewer walls passes after so many steps.
constexpr std::size_t few_walls = 8;
constexpr std::size_t most_steps_of_doubt = 12;
/// From places nearer to each other, m, the same walls are seen.
constexpr double other_place = 0.25;

double length_of(const Pose2& motion) {
  return std::hypot(motion.x, motion.y);
}

bool is_motion(const Pose2& motion) {
  return length_of(motion) >= least_way || std::abs(motion.theta) >= least_turn;
}

bool turn_alike(const Pose2& odometry, const Pose2& scans) {
  return rotation_between(scans, odometry) <=
         turn_tolerance + turn_tolerance_share * std::abs(odometry.theta);
}

/// Whether turns and ways are the same, up to what good robots show. Directions may differ by the angle of a
/// sensor that is mounted wrongly.
bool are_alike(const Pose2& odometry, const Pose2& scans) {
  const double way = length_of(odometry), way_of_scans = length_of(scans);
  const double along = odometry.x * scans.x + odometry.y * scans.y;
  const bool has_direction = way >= directed_way && way_of_scans >= directed_way;
  return turn_alike(odometry, scans) &&
         std::abs(way_of_scans - way) <= way_tolerance + way_tolerance_share * way &&
         (!has_direction || along >= std::cos(direction_tolerance) * way * way_of_scans);
}

/// Whether odometry tells no motion, or more of the same than the scans: its wheels spin, or it is lost. That
/// is no matter of the set-up.
bool is_slip(const Pose2& odometry, const Pose2& scans) {
  if (!is_motion(odometry)) return true;
  const double way = length_of(odometry);
  const double turn = std::abs(odometry.theta);
  const double along = way * way + turn * turn;
  const double grip = std::clamp(
      (odometry.x * scans.x + odometry.y * scans.y + odometry.theta * scans.theta) / along, least_grip, 1.0);
  return are_alike({grip * odometry.x, grip * odometry.y, grip * odometry.theta}, scans);
}

bool is_biased(const SetupCheck& check, double spread) {
  return check.range_bias_m &&
         std::abs(*check.range_bias_m) > most_bias + spread / std::sqrt(static_cast<double>(check.walls));
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// How far two motions are from being alike, in [0, 2].
double difference(const Pose2& odometry, const Pose2& scans) {
  constexpr double other_turn = radians(10.0), other_way = 0.25;
  return std::min(rotation_between(scans, odometry) / other_turn, 1.0) +
         std::min(std::abs(length_of(scans) - length_of(odometry)) / other_way, 1.0);
}

}  // namespace

void describe(ParamVisitor& v, SetupCheckParams& p) {
  v.field(
      "enabled", p.enabled,
      {.doc = "Nothing is declared while scans and odometry tell motions that show a fault of the set-up: "
              "a sensor upside down or turned, scans that come late or again and again. Only in the plane.",
       .audience = Audience::tuner});
  v.field(
      "min_agreement", p.min_agreement,
      {.doc = "Nothing is declared before the agreement of scans and odometry reaches this: the logarithm "
              "of how much more likely their motions are if they are of one time than if not. A step "
              "straight on adds 0.5, one with a turn 1.5. Late scans of a robot that drives straight on "
              "show in no other way.",
       .min = 0.0,
       .max = most_agreement,
       .audience = Audience::tuner});
}

void SetupMonitor::reset() {
  *this = SetupMonitor(params_);
}

SetupCheck SetupMonitor::update(const Observation& observation, const LocalMap& local) {
  if (last_) {
    motions_.push_back(motions_since(*last_, observation, local));
    if (motions_.size() > window) motions_.pop_front();
    ++steps_;
    weigh(motions_.back());
  }
  const std::vector<PolarReading> readings = readings_of(observation.scan);
  const Pose2 odom_from_robot = seen_from_above(observation.odom_from_robot);
  if (!bias_told_at_ || distance(*bias_told_at_, odom_from_robot) >= other_place) {
    bias_.take_in(by_direction(readings));
    bias_told_at_ = odom_from_robot;
  }
  stuck_.take_in(readings, odom_from_robot);
  last_ = {observation.scan.hits, odom_from_robot, seen_from_above(local.local_from_robot), local.epoch};
  SetupCheck check = measured();
  if (agreement_ <= agreement_of_fault) check.late_by = lag();
  check.fault = fault(check);
  check.is_in_doubt = !check.fault && is_in_doubt(check);
  return check;
}

SetupMonitor::Motions SetupMonitor::motions_since(const Last& last, const Observation& observation,
                                                  const LocalMap& local) const {
  Motions motions{inverse(last.odom_from_robot) * seen_from_above(observation.odom_from_robot), {}, false};
  motions.is_repeated = observation.scan.hits.size() >= least_hits && is_motion(motions.odometry) &&
                        observation.scan.hits == last.hits;
  if (motions.is_repeated || local.epoch != last.epoch) return motions;
  const Pose2 scans = inverse(last.local_from_robot) * seen_from_above(local.local_from_robot);
  const bool is_odometry =
      distance(scans, motions.odometry) < as_it_was && rotation_between(scans, motions.odometry) < as_it_was;
  if (!is_odometry) motions.scans = scans;
  return motions;
}

void SetupMonitor::weigh(const Motions& motions) {
  if (!motions.scans) return;
  const Pose2& odometry = motions.odometry;
  double evidence = 0.0;
  if (are_alike(odometry, *motions.scans)) {
    if (is_motion(odometry))
      evidence = std::abs(odometry.theta) >= sharp_turn ? for_agreement_in_turn : for_agreement;
  } else if (!is_slip(odometry, *motions.scans)) {
    evidence = turn_alike(odometry, *motions.scans) ? for_other_way : for_other_turn;
  }
  agreement_ = std::clamp(agreement_ + evidence, least_agreement, most_agreement);
}

SetupCheck SetupMonitor::measured() const {
  SetupCheck check{.agreement = agreement_,
                   .range_bias_m = bias_.median(),
                   .walls = bias_.walls(),
                   .stuck_share = stuck_.share()};
  std::vector<double> angles;
  for (const auto& [odometry, scans, is_repeated] : motions_) {
    if (!scans) continue;
    check.way_m += length_of(odometry);
    if (length_of(odometry) < directed_way || length_of(*scans) < directed_way ||
        !are_alike(odometry, *scans))
      continue;
    // What lies ahead of a sensor that looks too far to the left is seen to its right.
    angles.push_back(std::atan2(scans->x * odometry.y - scans->y * odometry.x,
                                scans->x * odometry.x + scans->y * odometry.y));
  }
  if (angles.empty()) return check;
  const double middle = median(angles);
  const auto number = static_cast<double>(angles.size());
  for (double& angle : angles) angle = std::abs(angle - middle);
  // Of a normal distribution, half of which lies within 0.67 standard deviations.
  const double spread = std::max(median(std::move(angles)) / 0.6745, least_spread);
  check.mount_angle_deg = degrees(middle);
  check.mount_angle_sd_deg = degrees(spread / std::sqrt(number));
  return check;
}

bool SetupMonitor::is_repeated(std::size_t times) const {
  const std::size_t looked_at = std::min(motions_.size(), window_of_repetitions);
  return static_cast<std::size_t>(std::count_if(motions_.end() - static_cast<std::ptrdiff_t>(looked_at),
                                                motions_.end(),
                                                [](const Motions& m) { return m.is_repeated; })) >= times;
}

bool SetupMonitor::is_mirrored(double turned_rad) const {
  double difference = 0.0, mirrored_difference = 0.0;
  for (const Motions& m : motions_) {
    if (!m.scans || std::abs(m.odometry.theta) < turn_tolerance) continue;
    difference += rotation_between(*m.scans, m.odometry);
    mirrored_difference += rotation_between(*m.scans, inverse(m.odometry));
  }
  return difference >= turned_rad && mirrored_difference < share_of_better * difference;
}

std::optional<std::size_t> SetupMonitor::lag() const {
  constexpr std::size_t most = 20, least_pairs = 6;
  constexpr double least_difference = 0.5;
  std::optional<std::size_t> best;
  double best_share = share_of_better;
  for (std::size_t lag = 1; lag <= most && lag + least_pairs <= motions_.size(); ++lag) {
    double as_they_are = 0.0, as_before = 0.0;
    std::size_t pairs = 0;
    for (std::size_t i = lag; i < motions_.size(); ++i) {
      const auto& scans = motions_[i].scans;
      if (!scans) continue;
      as_they_are += difference(motions_[i].odometry, *scans);
      as_before += difference(motions_[i - lag].odometry, *scans);
      ++pairs;
    }
    if (pairs < least_pairs || as_they_are < least_difference * static_cast<double>(pairs)) continue;
    if (as_before >= best_share * as_they_are) continue;
    best_share = as_before / as_they_are;
    best = lag;
  }
  return best;
}

std::optional<SetupFault> SetupMonitor::fault(const SetupCheck& check) const {
  if (is_repeated(3)) return SetupFault::repeated_scans;
  if (is_mirrored(radians(50.0))) return SetupFault::upside_down;
  if (check.late_by) return SetupFault::late_scans;
  if (check.stuck_share >= most_stuck) return SetupFault::stuck_ranges;
  if (check.walls >= least_walls && is_biased(check, sure_spread_of_bias)) return SetupFault::biased_ranges;
  if (check.way_m >= 1.0 && check.mount_angle_deg &&
      std::abs(*check.mount_angle_deg) - 2.0 * check.mount_angle_sd_deg > most_mount_angle_deg)
    return SetupFault::mount_angle;
  return std::nullopt;
}

bool SetupMonitor::is_in_doubt(const SetupCheck& check) const {
  if (steps_ == 0) return false;
  const bool is_turned = check.mount_angle_deg &&
                         std::abs(*check.mount_angle_deg) + check.mount_angle_sd_deg > most_mount_angle_deg;
  const bool is_too_early = check.way_m < first_way && steps_ < most_steps_for_first_way;
  const bool tells_bias = check.walls >= few_walls || steps_ <= most_steps_of_doubt;
  return is_too_early || is_turned || agreement_ < params_.min_agreement ||
         (tells_bias && is_biased(check, spread_of_bias)) || is_repeated(1) || is_mirrored(radians(12.0));
}

}  // namespace glocal
