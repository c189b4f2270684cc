#include "sources/disturbed/disturbed_drive.hpp"

#include <algorithm>
#include <utility>

#include "glocal/error.hpp"

namespace glocal::disturbed {
namespace {

/// Names the streams of random numbers of a drive.
enum Stream : std::uint64_t { of_drive, of_sample, of_outer };

}  // namespace

void describe(ParamVisitor& v, ChosenDisturbance& p) {
  describe_chosen(v, p, said_of(disturbance_kinds()));
}

void describe(ParamVisitor& v, DisturbedDrive::Params& p) {
  v.strategy("source", p.source, *p.sources, {.doc = "What is disturbed.", .required = true});
  v.field(
      "by", p.by,
      {.doc = "What goes wrong, one thing after the other in this order.", .min_items = 1, .required = true});
}

DisturbedDrive::DisturbedDrive(const Params& params, const SourceSetup& setup)
    : source_(params.sources->make(params.source, setup)), rng_(setup.seed) {
  // What is disturbed twice is not so by the same numbers.
  if (const auto* inner = dynamic_cast<const DisturbedDrive*>(source_.get()))
    rng_ = inner->rng_.stream({of_outer});
  for (const ChosenDisturbance& chosen : params.by) {
    const DisturbanceKind& kind = kind_named(chosen.kind, disturbance_kinds());
    disturbances_.push_back(kind.make(chosen.amount_of(kind), rng_.stream({of_drive, disturbances_.size()})));
  }
}

std::optional<Sample> DisturbedDrive::next() {
  while (std::optional<Sample> sample = source_->next()) {
    hits_ += sample->observation.scan.hits.size();
    sample = disturbed(*std::move(sample));
    ++samples_;
    if (!sample) continue;
    hits_left_ += sample->observation.scan.hits.size();
    return sample;
  }
  if (hits_ > 0 && hits_left_ == 0)
    throw ConfigError(
        {{"", 0, 0, "nothing of what the source has measured is left; choose lower levels or amounts",
          "observations.disturbed.by"}});
  return std::nullopt;
}

std::optional<Sample> DisturbedDrive::disturbed(Sample sample) {
  std::optional<Sample> left = std::move(sample);
  for (std::size_t i = 0; i < disturbances_.size() && left; ++i)
    left = disturbances_[i]->disturb(*std::move(left), rng_.stream({of_sample, i, samples_}));
  return left;
}

}  // namespace glocal::disturbed
