// One thing that goes wrong with what a robot measures.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "glocal/observation.hpp"
#include "glocal/rng.hpp"
#include "sources/disturbed/chosen.hpp"

namespace glocal::disturbed {

/// Changes the samples of a drive, which come in order.
class Disturbance {
 public:
  virtual ~Disturbance() = default;
  /// What becomes of the next sample; none if it is lost. `rng` is for this sample alone. Reference poses and
  /// segments stay.
  [[nodiscard]] virtual std::optional<Sample> disturb(Sample sample, Rng rng) = 0;

 protected:
  /// Asked once of each sample: whether the drive was interrupted before it, so that nothing goes on from
  /// there.
  [[nodiscard]] bool begins_segment(const Sample& sample) {
    return std::exchange(segment_, sample.segment) != sample.segment;
  }

 private:
  int segment_ = 0;
};

/// A kind of these, and how to make one; `rng` is for the whole drive.
struct DisturbanceKind : Kind {
  std::unique_ptr<Disturbance> (*make)(double amount, Rng rng);
};

/// All of them.
[[nodiscard]] std::span<const DisturbanceKind> disturbance_kinds();

}  // namespace glocal::disturbed
