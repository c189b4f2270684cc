// An experiment as a described struct.
#pragma once

#include <memory>

#include "config/variants.hpp"
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

/// An experiment file: an experiment, and what is varied of it.
struct ExperimentFile {
  Experiment experiment = default_experiment();
  Variations variations;
};

/// An experiment file as a described struct.
class ExperimentFileParams final : public AnyParams {
 public:
  explicit ExperimentFileParams(const Catalog& catalog) : catalog_(&catalog) {}
  void visit(ParamVisitor& visitor) override {
    describe(visitor, file.experiment, *catalog_);
    describe(visitor, file.variations);
  }
  [[nodiscard]] std::unique_ptr<AnyParams> clone() const override {
    return std::make_unique<ExperimentFileParams>(*this);
  }

  ExperimentFile file;

 private:
  const Catalog* catalog_;
};

}  // namespace glocal
