// Where results come from.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <set>

#include "glocal/catalog.hpp"

namespace glocal {

/// Version, revision, compiler, host, CPU, threads, SHA-256 of every input file, and which plugins took part.
[[nodiscard]] nlohmann::ordered_json provenance(const Catalog& catalog, int threads,
                                                const std::set<std::filesystem::path>& inputs);

/// SHA-256 of a file in hexadecimal digits, as sha256sum prints it. Throws RunError if the file cannot be
/// read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

}  // namespace glocal
