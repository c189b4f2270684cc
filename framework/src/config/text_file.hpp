// Files as the configuration needs them: there, readable, text.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "config/node.hpp"

namespace glocal {

/// Why a file cannot be read ("no such file: /a/b"), or none if it can. Named pipes and devices do not count
/// as files: opening them may block for ever.
[[nodiscard]] std::optional<std::string> why_unreadable(const std::filesystem::path& file);

/// The file's content. Throws ConfigError if it cannot be read or is larger than 1 MiB.
[[nodiscard]] std::string read_text_file(const std::filesystem::path& file);

/// The first fault of bytes that are to be UTF-8 text without control characters; none if there is none.
[[nodiscard]] std::optional<Fault> find_binary(const std::string& bytes, const Origin& origin);

}  // namespace glocal
