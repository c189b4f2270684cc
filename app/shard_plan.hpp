// What shards of an experiment have to do, said once in the folder that they share.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "app/commands.hpp"
#include "evaluation/sharding/manifest.hpp"

namespace glocal::app {

/// The manifest of a shared folder, which is made and written if there is none, or if there are more variants
/// now than there were. None if it cannot be made: then what is wrong was said on stderr, and the exit code
/// of the context is set. Throws ConfigError if the folder is another experiment's.
[[nodiscard]] std::optional<Manifest> planned_shards(std::vector<Variant>& variants, const std::string& file,
                                                     const std::filesystem::path& shared, Context& context);

}  // namespace glocal::app
