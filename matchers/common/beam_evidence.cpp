#include "matchers/common/beam_evidence.hpp"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "glocal/beams.hpp"
#include "glocal/pose_tolerance.hpp"

namespace glocal {
namespace {

/// Scans of different places that are kept: as many as a local map of 10 m has.
constexpr std::size_t most_places = 13;
/// What a beam through a wall says against a pose, where one that ends at a wall says 1 for it.
constexpr double blocked_against_contact = 2.0;
/// Fewer beams than these say less than a whole scan.
constexpr std::size_t few_beams = 30;

/// A robot that is no farther from where it was sees the same again.
constexpr PoseTolerance same_place{.translation = 0.5, .rotation = radians(20.0)};

}  // namespace

void describe(ParamVisitor& v, BeamRule& p) {
  v.field("blocked_weight", p.weight,
          {.doc = "What the share of beams through occupied cells takes off the score.",
           .min = 0.0,
           .audience = Audience::tuner});
  v.field("blocked_cap", p.cap,
          {.doc = "Largest share of blocked beams that counts: a door that was open, or a shelf that has "
                  "gone, blocks many beams at once.",
           .min = 0.0,
           .max = 1.0,
           .audience = Audience::expert});
}

void BeamEvidence::add(const LocalMap& local, const Scan& scan) {
  if (local.epoch != epoch_) clear();
  epoch_ = local.epoch;
  if (scan.hits.empty() && scan.free_ends.empty()) return;
  const Pose2 robot = seen_from_above(local.local_from_robot);
  const Transform local_from_robot(robot);
  Beams beams{robot, local_from_robot(scan.origin), {}};
  for (const Beam& beam : some_beams(scan, static_cast<std::size_t>(rule_.beams))) {
    beams.ends.push_back(local_from_robot(beam.end));
    if (beam.is_hit) ++beams.hits;
  }
  const std::size_t n = places_.size();
  if (n > 1 && same_place.are_near(places_[n - 1].local_from_robot, places_[n - 2].local_from_robot))
    places_.pop_back();
  places_.push_back(beams);
  if (places_.size() > most_places) places_.pop_front();
  scans_.push_back(std::move(beams));
  if (scans_.size() > static_cast<std::size_t>(rule_.scans)) scans_.pop_front();
}

void BeamEvidence::clear() {
  scans_.clear();
  places_.clear();
}

double BeamEvidence::blocked_share(const ClearanceGrid& grid, const Pose2& map_from_local,
                                   double most) const {
  const Transform transform(map_from_local);
  double all = 0.0;
  for (const Beams& beams : scans_) all += static_cast<double>(beams.ends.size());
  double blocked = 0.0;
  std::vector<std::uint8_t> are_blocked;
  for (const Beams& beams : scans_) {
    grid.find_blocked(transform(beams.origin), beams.ends, transform, rule_.margin, are_blocked);
    blocked += static_cast<double>(std::ranges::count(are_blocked, 1));
    // One beam more, so that no rounding brings the answer back to `most`.
    if (blocked > most * all + 1.0) break;
  }
  return all == 0.0 ? 0.0 : blocked / all;
}

double BeamEvidence::support(const ContactIndex& contact, const ClearanceGrid& grid,
                             const Pose2& map_from_local) const {
  const Transform transform(map_from_local);
  double sum = 0.0;
  std::vector<std::uint8_t> are_blocked;
  for (const Beams& beams : places_) {
    grid.find_blocked(transform(beams.origin), beams.ends, transform, rule_.margin, are_blocked);
    double support = 0.0;
    for (std::size_t i = 0; i < beams.ends.size(); ++i) {
      if (i < beams.hits && contact.count(beams.ends, i, 1, transform) > 0) {
        support += 1.0;
      } else if (are_blocked[i] != 0) {
        support -= blocked_against_contact;
      }
    }
    sum += support / static_cast<double>(std::max(beams.ends.size(), few_beams));
  }
  return sum;
}

}  // namespace glocal
