// Trials and steps with round numbers.
#pragma once

#include "evaluation/running/trials.hpp"

namespace glocal::test {

/// A step with two clusters, the better of 3 members at `pose`.
inline StepRecord step_record(std::size_t step, const Pose2& pose) {
  StepRecord record;
  record.result.step = step;
  record.result.stamp = 100.0 + 0.5 * static_cast<double>(step);
  record.result.local_map_points = 40;
  record.result.local_from_robot = Pose2{1.0, 2.0, 0.5};
  record.result.range_noise = 0.0125;
  record.result.contact_epsilon = 0.1;
  record.result.omega_max = 0.5;
  record.result.omega_best = 0.75;
  record.result.score_best = 0.625;
  record.result.omega_place = 0.875;
  record.result.omega_scan = 0.8125;
  record.result.hit_kinds = {HitKind::on_map, HitKind::unmapped, HitKind::beyond, HitKind::unknown};
  record.result.proposals = 60;
  record.result.points_tested = 700;
  record.result.clusters = {{{0, 2, 3}, pose}, {{1}, Pose2{9.0, 9.0, 0.0}}};
  record.result.ratings = {{0.6, 0.75}, {0.2, 0.25}};
  record.result.verdict = {VerdictKind::searching, std::nullopt, {}, "not yet"};
  record.result.stage_ms = {1.0, 2.0, 3.0, 4.0};
  record.result.stage_cpu_ms = {1.5, 2.5, 3.5, 4.5};
  record.hypotheses = 4;
  record.on_map = true;
  return record;
}

/// The error of a pose that is off by so much.
inline PoseError off_by(double translation_m, double rotation_deg) {
  return {translation_m, radians(rotation_deg)};
}

}  // namespace glocal::test
