// All strategies a program knows: a plain value, made in main() and handed around.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>

#include "glocal/cloud_registrar.hpp"
#include "glocal/contact.hpp"
#include "glocal/message_link.hpp"
#include "glocal/motion.hpp"
#include "glocal/registry.hpp"
#include "glocal/strategies.hpp"

namespace glocal {

/// Takes a sentence the user should read once.
using Warn = std::function<void(const std::string&)>;

/// Takes the share of an input that has been read, in [0, 1]. It begins anew where something is read again.
using TellProgress = std::function<void(double)>;

/// What sources may use when they are made.
struct SourceSetup {
  std::uint64_t seed = 0;          ///< The experiment's seed, for simulated noise.
  Motion motion = Motion::planar;  ///< What of the robot's pose is looked for; poses keep to it.
  Warn warn = [](const std::string&) {};
  /// To be called with every file read, and every folder of which all files are, for the record of a run's
  /// inputs.
  std::function<void(const std::filesystem::path&)> note_input = [](const std::filesystem::path&) {};
  /// To be called now and then by sources that take long to read.
  TellProgress progress = [](double) {};
  /// To be asked now and then by sources that wait.
  std::function<bool()> is_stopped = [] { return false; };
};

/// What stages may use when they are made.
struct StageSetup {
  std::shared_ptr<const GlobalMap> map;
  int threads = 1;
  double contact_epsilon = 0.10;   ///< m; said once for all stages.
  Motion motion = Motion::planar;  ///< What of the robot's pose is looked for; said once for all stages.
  /// For searches, at points, each about 10 ns: what is not done then goes on later.
  std::size_t looks_per_step = std::numeric_limits<std::size_t>::max();
  bool has_verifier = false;  ///< Whether what is declared is verified; known to verdict rules.
  /// To be called with every file read while the stage is made, for the record of a run's inputs.
  std::function<void(const std::filesystem::path&)> note_input = [](const std::filesystem::path&) {};

  /// The epsilon of eq. 4 (m) for a stage that may have one of its own.
  [[nodiscard]] double epsilon(const std::optional<double>& own) const {
    return own.value_or(contact_epsilon);
  }
};

/// One registry for each kind of strategy.
struct Catalog {
  Registry<MapSource, SourceSetup> map_sources{"map_source"};
  Registry<ObservationSource, SourceSetup> observation_sources{"observation_source"};
  Registry<LocalMapper, StageSetup> local_mappers{"local_mapper"};
  ContactIndexes contact_indexes{"contact_index"};
  Registry<Matcher, StageSetup> matchers{"matcher"};
  Registry<Clusterer, StageSetup> clusterers{"clusterer"};
  Registry<Rater, StageSetup> raters{"rater"};
  Registry<ThresholdPolicy, StageSetup> threshold_policies{"threshold_policy"};
  Registry<VerdictRule, StageSetup> verdict_rules{"verdict_rule"};
  Registry<Verifier, StageSetup> verifiers{"verifier"};
  CloudRegistrars cloud_registrars{"cloud_registrar"};
  Registry<MessageLink, SourceSetup> message_links{"message_link"};

  /// Every registry, in the order of the data's way; last what no localizer has.
  [[nodiscard]] std::array<RegistryBase*, 12> registries() {
    return {&map_sources,   &observation_sources, &local_mappers,    &contact_indexes,
            &matchers,      &clusterers,          &raters,           &threshold_policies,
            &verdict_rules, &verifiers,           &cloud_registrars, &message_links};
  }
  [[nodiscard]] std::array<const RegistryBase*, 12> registries() const {
    return {&map_sources,   &observation_sources, &local_mappers,    &contact_indexes,
            &matchers,      &clusterers,          &raters,           &threshold_policies,
            &verdict_rules, &verifiers,           &cloud_registrars, &message_links};
  }
};

}  // namespace glocal
