// Values given elsewhere, put into the tree of a file before it is read.
#pragma once

#include <string>
#include <vector>

#include "config/node.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// Puts a value where `path` (a.b.c) leads; `place` is where the path is written, for faults. Where the path
/// names a strategy that the tree does not use, it takes the place of the one used; keys that do not exist
/// yet are made, for the reader to judge.
void apply_change(YamlNode& tree, const std::string& path, YamlNode value, const Place& place,
                  AnyParams& params, std::vector<Fault>& faults);

/// Puts each override into the tree, the last one winning; they are named `--set path=value` in faults, and
/// their relative paths start from the working directory.
void apply_overrides(YamlNode& tree, const std::vector<Override>& overrides, AnyParams& params,
                     std::vector<Fault>& faults);

/// Fills the struct from a tree into which the overrides are put. Throws ConfigError with all faults.
void fill(AnyParams& params, YamlNode tree, const std::vector<Override>& overrides);

}  // namespace glocal
