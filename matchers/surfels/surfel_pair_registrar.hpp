// register_clouds() among the other ways to register clouds.
#pragma once

#include "glocal/cloud_registrar.hpp"
#include "glocal/params.hpp"

namespace glocal::surfels {

/// glocal's own way: register_clouds().
class SurfelPairRegistrar final : public CloudRegistrar {
 public:
  using Params = NoParams;

  SurfelPairRegistrar(const Params& /*params*/, const RegistrationOptions& options) : options_(options) {}

  [[nodiscard]] Registration find(const Points& source, const Points& target) override {
    return register_clouds(source, target, options_);
  }

 private:
  RegistrationOptions options_;
};

}  // namespace glocal::surfels
