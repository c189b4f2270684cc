// A drive with what goes wrong on real robots.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "glocal/catalog.hpp"
#include "glocal/strategies.hpp"
#include "sources/disturbed/disturbance.hpp"

namespace glocal::disturbed {

struct ChosenDisturbance : Chosen {};
void describe(ParamVisitor& v, ChosenDisturbance& p);

/// What another source delivers, disturbed by one thing after the other. Reference poses are those of the
/// robot as it was. The same seed disturbs in the same way, whatever the trials are.
class DisturbedDrive final : public ObservationSource {
 public:
  struct Params {
    /// Of the source; outlives all that is made of it.
    const Registry<ObservationSource, SourceSetup>* sources = nullptr;
    StrategyChoice source = {};
    std::vector<ChosenDisturbance> by = {};
  };

  DisturbedDrive(const Params& params, const SourceSetup& setup);
  /// Throws ConfigError at the end of a drive of whose hits none is left.
  [[nodiscard]] std::optional<Sample> next() override;

 private:
  [[nodiscard]] std::optional<Sample> disturbed(Sample sample);

  std::unique_ptr<ObservationSource> source_;
  std::vector<std::unique_ptr<Disturbance>> disturbances_;
  Rng rng_;
  std::size_t samples_ = 0, hits_ = 0, hits_left_ = 0;
};
void describe(ParamVisitor& v, DisturbedDrive::Params& p);

}  // namespace glocal::disturbed
