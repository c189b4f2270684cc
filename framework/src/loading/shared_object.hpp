// Whether a file can be handed to the dynamic linker.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace glocal {

/// Why a file is no complete shared object for this machine, with a hint what to do; none if it is one. The
/// dynamic linker itself does not check that: it maps a truncated file and dies of a bus error.
[[nodiscard]] std::optional<std::string> why_no_shared_object(const std::filesystem::path& file);

}  // namespace glocal
