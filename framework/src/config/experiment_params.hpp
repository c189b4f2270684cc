// An experiment as a described struct.
#pragma once

#include <memory>

#include "glocal/experiment.hpp"

namespace glocal {

/// Refers to an experiment and to the catalog its description needs.
class ExperimentParams final : public AnyParams {
 public:
  ExperimentParams(Experiment& experiment, const Catalog& catalog)
      : experiment_(&experiment), catalog_(&catalog) {}
  void visit(ParamVisitor& visitor) override { describe(visitor, *experiment_, *catalog_); }
  [[nodiscard]] std::unique_ptr<AnyParams> clone() const override {
    return std::make_unique<ExperimentParams>(*this);
  }

 private:
  Experiment* experiment_;
  const Catalog* catalog_;
};

}  // namespace glocal
