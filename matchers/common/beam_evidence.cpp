#include "matchers/common/beam_evidence.hpp"

#include <utility>

#include "glocal/beams.hpp"

namespace glocal {

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
  if (local.epoch != epoch_) scans_.clear();
  epoch_ = local.epoch;
  const Transform local_from_robot(seen_from_above(local.local_from_robot));
  Beams beams{local_from_robot(scan.origin), {}};
  for (const Beam& beam : some_beams(scan, static_cast<std::size_t>(rule_.beams)))
    beams.ends.push_back(local_from_robot(beam.end));
  scans_.push_back(std::move(beams));
  if (scans_.size() > static_cast<std::size_t>(rule_.scans)) scans_.pop_front();
}

double BeamEvidence::blocked_share(const ClearanceGrid& grid, const Pose2& map_from_local,
                                   double most) const {
  const Transform transform(map_from_local);
  double all = 0.0;
  for (const Beams& beams : scans_) all += static_cast<double>(beams.ends.size());
  double blocked = 0.0;
  for (const Beams& beams : scans_) {
    const Point from = transform(beams.origin);
    for (std::size_t i = 0; i < beams.ends.size(); ++i) {
      if (grid.is_blocked(from, transform(beams.ends[i]), rule_.margin)) blocked += 1.0;
      // One beam more, so that no rounding brings the answer back to `most`.
      if (blocked > most * all + 1.0) return blocked / all;
    }
  }
  return all == 0.0 ? 0.0 : blocked / all;
}

}  // namespace glocal
