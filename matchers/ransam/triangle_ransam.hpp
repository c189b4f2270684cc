#pragma once

#include <memory>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/strategies.hpp"
#include "matchers/common/quality.hpp"
#include "matchers/ransam/triple_matching.hpp"
#include "matchers/ransam/triple_search.hpp"

namespace glocal::ransam {

/// Those of some points of a cloud that lie on a surface, with its normal, which may look to either side.
struct SurfacePoints {
  /// Surfaces are surfels of voxels of a side (m). Throws ConfigError if the cloud reaches too far.
  SurfacePoints(const Points& cloud, const Points& some, float voxel_size);

  Points points;   ///< m
  Points normals;  ///< Unit length.
};

/// Random sample matching in space (Section II of the paper): the relation of three points are the lengths of
/// the sides between them. Where the motion is upright, proposals that are not are dropped, and others made
/// upright.
///
/// Three points are laid on their mirror image by a rotation, so sides cannot tell the two apart. Normals
/// can: triples are drawn from points on surfaces, and a proposal must turn each corner's normal to within 41
/// degrees of its partner's, n and -n being the same. Omega (eq. 4) asks all points of the local map.
class TriangleRansam final : public Matcher {
 public:
  struct Params {
    TripleSearch triples = {};
  };
  static constexpr Motions motions = motions_in_space;

  /// Throws ConfigError where the map is too large for a contact grid or has no surfaces.
  TriangleRansam(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override {}

 private:
  [[nodiscard]] MatchResult test_hypotheses(const SurfacePoints& local, const PoseGate& gate,
                                            const QualityTest& quality, const TripleBatch& local_triples,
                                            const TripleBatch& map_triples) const;

  TripleSearch params_;
  bool upright_;
  float voxel_size_;
  std::shared_ptr<const ContactIndex> contact_;
  std::shared_ptr<const SurfacePoints> map_;
  TripleMatching matching_;
};
void describe(ParamVisitor& v, TriangleRansam::Params& p);

}  // namespace glocal::ransam
