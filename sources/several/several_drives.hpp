// Drives on several maps, one after the other.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"

namespace glocal::several {

/// One of the drives, and the map that it is on.
struct DriveOnMap {
  /// Of the source; outlives all that is made of it.
  const Registry<ObservationSource, SourceSetup>* sources = nullptr;
  std::string map = {};
  StrategyChoice source = {};
};
void describe(ParamVisitor& v, DriveOnMap& p);

/// One drive after the other, as the segments of one; their reference poses are told with the map that they
/// are on. In a lift, odometry goes on where it was: a robot that cannot tell that it has changed floors.
class SeveralDrives final : public ObservationSource {
 public:
  struct Params {
    const Registry<ObservationSource, SourceSetup>* sources = nullptr;
    std::vector<DriveOnMap> drives = {};
    bool in_lift = false;
  };

  SeveralDrives(const Params& params, const SourceSetup& setup);
  [[nodiscard]] std::optional<Sample> next() override;

 private:
  struct Drive {
    std::string map;
    std::unique_ptr<ObservationSource> source;
  };

  /// What is to be added to this drive, which begins with this observation, so that it follows the last one.
  void follow_on(const Sample& first);

  std::vector<Drive> drives_;
  bool in_lift_ = false;
  std::size_t now_ = 0;
  bool is_first_ = true;  ///< Of this drive.
  // Of what was delivered last.
  int last_segment_ = -1;
  double last_stamp_ = 0.0;  ///< s
  Pose3 last_odom_;
  // What is added to this drive.
  int segments_ = 0;
  double stamp_shift_ = 0.0;  ///< s
  Pose3 odom_from_odom_;      ///< From its odometry to the common one.
};
void describe(ParamVisitor& v, SeveralDrives::Params& p);

}  // namespace glocal::several
