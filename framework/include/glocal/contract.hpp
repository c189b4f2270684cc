// What each kind of strategy promises, tried out: for tests of strategies, in plugins and in the tree.
#pragma once

#include <string>
#include <vector>

#include "glocal/catalog.hpp"

namespace glocal {

/// Has a strategy work in a small room, several times, by one thread and by two, and compares its answers
/// with the contract of its interface and with each other. Returns what it does not keep, a sentence each;
/// nothing if it keeps everything that can be seen so. `choice` has its parameters, or none for the defaults.
/// Local mappers, matchers and verifiers are tried out for every motion that they can do. Throws ConfigError
/// where it cannot be made, and std::out_of_range where the catalog has no such strategy.
[[nodiscard]] std::vector<std::string> broken_promises(const std::string& kind, const StrategyChoice& choice,
                                                       const Catalog& catalog);

}  // namespace glocal
