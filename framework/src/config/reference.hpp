// The parameter reference, docs/parameters.md.
#pragma once

#include <string>

#include "glocal/catalog.hpp"

namespace glocal {

/// All keys of an experiment file and all parameters of all strategies, in Markdown.
[[nodiscard]] std::string parameter_reference(const Catalog& catalog);

}  // namespace glocal
