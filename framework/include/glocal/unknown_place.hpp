// Notices that the robot is somewhere the map does not show (Section III-D of the paper, eq. 10).
#pragma once

#include <deque>
#include <memory>
#include <optional>

#include "glocal/beams.hpp"
#include "glocal/contact.hpp"
#include "glocal/hypothesis.hpp"
#include "glocal/local_map.hpp"
#include "glocal/params.hpp"

namespace glocal {

/// When a place counts as unknown.
struct UnknownPlaceParams {
  int window = 10;
  double max_contact = 0.2;
  std::optional<double> contact_epsilon = {};
};
void describe(ParamVisitor& v, UnknownPlaceParams& p);

/// Follows Omega' from step to step.
class UnknownPlaceMonitor {
 public:
  /// `contact_epsilon` (m) is that of the localizer, for parameters without one.
  UnknownPlaceMonitor(const UnknownPlaceParams& params, std::shared_ptr<const GlobalMap> map,
                      double contact_epsilon);

  /// Omega' of eq. 10: the mean, over the last `window` scans with hits, of the share of a scan's hits in
  /// contact with the map under the best hypothesis, of which one in each voxel as wide as contact counts.
  /// `hits` are those of the latest scan (m, robot frame), which `local` has taken in. A step without
  /// hypotheses is judged by the best of the last step that had some. None before the first hypothesis in the
  /// local map's frame.
  [[nodiscard]] std::optional<double> update(const LocalMap& local, const Points& hits,
                                             const std::vector<Hypothesis>& hypotheses);

  /// What each hit of a scan (m, robot frame) says where the robot is at a pose.
  [[nodiscard]] std::vector<HitKind> kinds_of(const Scan& scan, const Pose2& map_from_robot) const;

  [[nodiscard]] bool is_unknown(std::optional<double> omega_place) const {
    return omega_place.has_value() && *omega_place < params_.max_contact;
  }

  void reset() {
    scans_.clear();
    best_.reset();
  }

 private:
  UnknownPlaceParams params_;
  std::shared_ptr<const GlobalMap> map_;
  double epsilon_;  ///< m
  std::shared_ptr<const ContactIndex> contact_;
  std::deque<Points> scans_;  ///< Hits of the last `window` scans, in the local frame.
  std::optional<Pose3> best_;
  int epoch_ = 0;  ///< That of the local frame of both.
};

}  // namespace glocal
