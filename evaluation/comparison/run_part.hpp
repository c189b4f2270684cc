// Which part of an experiment a run is.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "evaluation/comparison/comparison.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

struct RunPart {
  std::string setting;    ///< Empty if nothing but case and seed vary.
  std::string case_name;  ///< Empty without cases.
  CaseRole role = CaseRole::none;
  std::uint64_t seed = 0;
  std::vector<std::pair<std::string, std::string>> values;  ///< What the setting changes: paths and values.
};

/// A fault of what a run says of itself, in its provenance.json.
[[noreturn]] void refuse_provenance(const NamedRun& run, const std::string& what);

/// None if the run is the whole of its experiment. Throws ConfigError where it does not say it as glocal run
/// does.
[[nodiscard]] std::optional<RunPart> part_of(const NamedRun& run);

/// Runs that are pooled, as parts of settings. They must stay.
class PooledParts {
 public:
  /// Settings in other folders are other ones. Throws ConfigError where the setting has this case and seed
  /// already, or another localizer: no case changes that.
  void add(const std::filesystem::path& folder, const RunPart& part, const NamedRun& run);

 private:
  using SettingId = std::pair<std::filesystem::path, std::string>;
  std::map<SettingId, const NamedRun*> first_of_;
  std::map<std::tuple<SettingId, std::string, std::uint64_t>, const NamedRun*> runs_;
};

}  // namespace glocal
