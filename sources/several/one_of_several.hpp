// What a source that is one of several is set up with.
#pragma once

#include <cstddef>

#include "glocal/rng.hpp"
#include "glocal/strategies.hpp"

namespace glocal::several {

/// The first draws as it would alone; each other one draws random numbers of its own.
[[nodiscard]] inline SourceSetup setup_of(std::size_t i, const SourceSetup& of_all) {
  SourceSetup own = of_all;
  if (i > 0) own.seed = Rng(of_all.seed).stream({i}).next();
  return own;
}

}  // namespace glocal::several
