// An experiment file as a described struct.
#pragma once

#include <memory>

#include "config/variants.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// An experiment file: an experiment, and what is varied of it.
class ExperimentFileParams final : public AnyParams {
 public:
  explicit ExperimentFileParams(const Catalog& catalog) : catalog_(&catalog) {}
  void visit(ParamVisitor& visitor) override {
    describe(visitor, experiment, *catalog_);
    describe(visitor, variations);
  }
  [[nodiscard]] std::unique_ptr<AnyParams> clone() const override {
    return std::make_unique<ExperimentFileParams>(*this);
  }

  Experiment experiment = default_experiment();
  Variations variations;

 private:
  const Catalog* catalog_;
};

}  // namespace glocal
