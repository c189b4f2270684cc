#pragma once

#include <cstddef>
#include <memory>
#include <optional>

#include "glocal/catalog.hpp"
#include "glocal/contact.hpp"
#include "glocal/distance_field.hpp"
#include "glocal/params.hpp"
#include "glocal/strategies.hpp"
#include "matchers/common/quality.hpp"

namespace glocal::ransac {

/// Random sample consensus (Fischler and Bolles 1981) on bare points: what `ransam` is measured against.
///
/// Each iteration draws two points of the local map and two of the global one, all at random. Where their
/// distances agree, the motion of least squares that lays one pair on the other is a hypothesis; its quality
/// is Omega (eq. 4), given up early as in eq. 5. The comparison of distances costs next to nothing and spares
/// most draws the rest. There is no table: what one iteration has drawn helps no other.
///
/// Fischler and Bolles end with a fit to all points of the consensus set. A refinement does that for every
/// hypothesis kept, with the points weighted by how near they are.
class Ransac final : public Matcher {
 public:
  struct Params {
    int iterations = 5000000;
    std::optional<double> contact_epsilon = {};
  };

  /// Throws ConfigError where the map is too large for a contact grid or a distance field.
  Ransac(const Params& params, const StageSetup& setup);

  [[nodiscard]] MatchResult match(const MatchRequest& request, Rng& rng) override;
  void reset() override {}

 private:
  [[nodiscard]] MatchResult draw(const LocalMap& local, const QualityTest& quality, std::size_t iterations,
                                 Rng rng) const;
  void refine_all(const LocalMap& local, double omega_max, MatchResult& result, Rng& rng) const;

  Params params_;
  StageSetup setup_;
  std::shared_ptr<const ContactIndex> contact_;
  std::shared_ptr<const DistanceField> field_;
};
void describe(ParamVisitor& v, Ransac::Params& p);

}  // namespace glocal::ransac
