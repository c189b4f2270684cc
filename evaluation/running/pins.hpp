// What a suite pins of its cases: starts, and input files by what is in them.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>

#include "config/suites.hpp"
#include "evaluation/results/provenance.hpp"
#include "evaluation/running/experiment_loader.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// SHA-256 of the input files of a case by the names that the suite has for them. Three files or more of one
/// folder have one hash, of their names and hashes. Throws RunError if one cannot be read.
[[nodiscard]] std::map<std::string, std::string> input_hashes(const Suite& suite,
                                                              const std::set<std::filesystem::path>& inputs,
                                                              FileHashes& hashes);

/// Throws ConfigError, with every fault, where a variant of a suite that is pinned has read other inputs, or
/// has not as many starts.
void check_pins(const Variant& variant, const LoadedExperiment& loaded, FileHashes& hashes);

}  // namespace glocal
