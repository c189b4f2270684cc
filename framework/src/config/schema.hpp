// A JSON schema of experiment files, for editors.
#pragma once

#include <nlohmann/json.hpp>

#include "glocal/catalog.hpp"

namespace glocal {

/// JSON Schema, draft 2020-12. Rules that span fields, and whether files are there, only the program checks.
[[nodiscard]] nlohmann::ordered_json experiment_schema(const Catalog& catalog);

}  // namespace glocal
