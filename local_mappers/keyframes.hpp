// A local map of those scans that bring something new.
#pragma once

#include <optional>

#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "local_mappers/scan_matching.hpp"

namespace glocal::local_mappers {

/// Matches every scan as scan_matching does, but registers only keyframes: observations made `distance` or
/// `angle_deg` away from the last keyframe, or of which less than `overlap` lies on the map. The others only
/// move the robot. Fewer scans to blur the map, and less to do where the robot stands or observations come
/// fast.
class Keyframes final : public LocalMapper {
 public:
  struct Params {
    double distance = 0.5;
    double angle_deg = 20.0;
    double overlap = 0.6;
    ScanMatching::Params matching = {};
  };

  explicit Keyframes(const Params& params) : params_(params), matching_(params.matching) {}

  void add(const Observation& observation) override;
  [[nodiscard]] const LocalMap& map() const override { return matching_.map(); }
  void reset() override;

 private:
  [[nodiscard]] bool is_keyframe(const Points& hits) const;
  /// Share of hits (local frame) that have a point of the map near.
  [[nodiscard]] double overlap(const Points& hits) const;

  Params params_;
  ScanMatching matching_;
  std::optional<Pose2> local_from_last_;  ///< The robot at the last keyframe of this epoch.
};
void describe(ParamVisitor& v, Keyframes::Params& p);

}  // namespace glocal::local_mappers
