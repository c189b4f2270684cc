// Values given on the command line, put into the tree of a file before it is read.
#pragma once

#include <vector>

#include "config/node.hpp"
#include "glocal/experiment.hpp"

namespace glocal {

/// Puts each override into the tree, the last one winning; they are named `--set path=value` in faults, and
/// their relative paths start from the working directory. Where the path names a strategy that the file does
/// not use, it takes the place of the one used; keys that do not exist yet are made, for the reader to judge.
void apply_overrides(YamlNode& tree, const std::vector<Override>& overrides, AnyParams& params,
                     std::vector<Fault>& faults);

}  // namespace glocal
