#pragma once

#include <memory>
#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/box_search/box_pyramid.hpp"
#include "matchers/box_search/search_boxes.hpp"

namespace glocal::verifiers {

/// Searches the whole map for poses with about as much contact as the declared one, by branch and bound on
/// boxes of poses (search_boxes.hpp). If none is found, no pose has it: the certificate holds for every pose
/// of the plane, not for those of a grid alone. Where the motion is upright, it holds for every x, y, z and
/// yaw of the local map, which does not tilt: the robot's roll and pitch are those of the declared pose.
/// Where it is free, it holds for every pose at which the local map is tilted by at most
/// TiltSquares::most_tilt. In space 600 of its points count, or 300 where it tilts, spread evenly.
///
/// The search counts contact (Omega, eq. 4) and nothing else. What the matcher thinks of a pose beyond that,
/// it says of the rivals that the search brings (Matcher::rescore).
///
/// In the plane it looks for the mirrored local map, too (150 of its points), since left and right that have
/// changed places show in nothing else.
///
/// Where a step has no more looks left, the search of that step's local map goes on in the next, as long as
/// the same pose is to be declared in the same local frame.
class WholeMap final : public Verifier {
 public:
  static constexpr Motions motions = all_motions;

  struct Params {
    double margin = 0.05;
    double distance = PoseTolerance::default_translation;
    double rotation_deg = PoseTolerance::default_rotation_deg;
    std::optional<double> contact_epsilon = {};
    std::optional<double> cell = {};
  };

  /// Throws ConfigError where the map is too large for a contact grid or a pyramid.
  WholeMap(const Params& params, const StageSetup& setup);

  [[nodiscard]] Verification verify(const LocalMap& local, const Pose3& map_from_local,
                                    const PoseGate& gate) override;
  [[nodiscard]] Verification go_on(const LocalMap& local, const Pose3& map_from_local, const PoseGate& gate,
                                   std::size_t looks_left) override;
  void reset() override { open_.reset(); }

 private:
  /// A verification that has begun.
  struct Search {
    Points points;
    int epoch;  ///< Of the local frame.
    Pose3 local_from_robot;
    Exclusion declared;
    PoseGate gate;
    double contact;  ///< At the declared pose.
    BoxSearch rivals;
    /// The points with left and right changed, where they can fit clearly better at all.
    std::optional<Points> mirrored_points;
    std::optional<BoxSearch> mirrored;
  };
  [[nodiscard]] bool is_about(const LocalMap& local, const Pose3& map_from_local) const;
  [[nodiscard]] Search begin(const LocalMap& local, const Pose3& map_from_local, const PoseGate& gate) const;
  [[nodiscard]] std::vector<Hypothesis> rivals_of(const Search& search, const BoxSearchResult& found) const;
  /// Contact at the best pose of the mirrored points, in the plane, if it is more than at the declared pose
  /// by the margin or more: rooms are often nearly their own mirror images, and then both fit alike.
  [[nodiscard]] std::optional<double> mirrored_contact(const Search& search) const;
  [[nodiscard]] double contact_of(const Points& points, const Pose3& map_from_points) const;
  /// Near a pose that the search found, one that fits better.
  [[nodiscard]] Pose3 refined(const Points& points, const Pose3& map_from_points) const;

  Params params_;
  bool in_space_;
  double epsilon_;
  int threads_;
  std::size_t looks_per_step_;
  std::size_t most_rivals_;
  std::size_t most_looks_;
  std::shared_ptr<const ContactIndex> contact_;
  std::shared_ptr<const DistanceField> field_;  ///< To refine rivals on; in the plane only.
  std::shared_ptr<const BoxPyramid> pyramid_;
  std::optional<Search> open_;  ///< That goes on in the next step.
};
void describe(ParamVisitor& v, WholeMap::Params& p);

}  // namespace glocal::verifiers
