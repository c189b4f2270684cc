// Where results come from.
#pragma once

#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <set>
#include <string>
#include <string_view>

#include "glocal/catalog.hpp"
#include "glocal/experiment.hpp"
#include "glocal/run_experiment.hpp"

namespace glocal {

/// SHA-256 of a file in hexadecimal digits, as sha256sum prints it. Throws RunError if the file cannot be
/// read.
[[nodiscard]] std::string sha256_of_file(const std::filesystem::path& file);

/// SHA-256 of a text, in the same form.
[[nodiscard]] std::string sha256_of_text(std::string_view text);

[[nodiscard]] std::string host_name();

/// SHA-256 of files, each read once, and of folders: of the names of the files in it that are not hidden.
class FileHashes {
 public:
  /// Throws RunError if it cannot be read.
  [[nodiscard]] const std::string& of(const std::filesystem::path& file);
  /// Tells the hash of what is in no file.
  void tell(const std::string& what, std::string hash) { known_[what] = std::move(hash); }

 private:
  std::map<std::filesystem::path, std::string> known_;
};

/// Version, revision and SHA-256 of the program and of glocal's libraries: all strategies that are in no
/// plugin are in one of them.
[[nodiscard]] nlohmann::ordered_json program_identity(FileHashes& hashes);

/// Version, revision, compiler, host, CPU, threads, SHA-256 of the program and of every input file, and which
/// plugins took part.
[[nodiscard]] nlohmann::ordered_json provenance(const Catalog& catalog, int threads,
                                                const std::set<std::filesystem::path>& inputs,
                                                FileHashes& hashes);

/// What the results of a variant are of: setting, seed, case, role and values. Null for an experiment without
/// variants.
[[nodiscard]] nlohmann::ordered_json origin_json(const Variant& variant);

/// The provenance of a variant's results, with how many trials ran at once, by which command, since when
/// (UTC), and with origin_json().
[[nodiscard]] nlohmann::ordered_json provenance_of_run(const Catalog& catalog, const Variant& variant,
                                                       const RunOptions& options,
                                                       const std::set<std::filesystem::path>& inputs,
                                                       FileHashes& hashes);

/// Why results in `folder`, finished or not, are not those of a run with this effective experiment, as this
/// part of a whole (that of origin_json()), by this very program from the same input files, with these
/// plugins among them; none if they are. The experiment file itself may have changed: its effective values
/// tell all of it.
[[nodiscard]] std::optional<std::string> why_other_run(const std::filesystem::path& folder,
                                                       const std::string& effective,
                                                       const nlohmann::ordered_json& origin,
                                                       const std::filesystem::path& experiment_file,
                                                       const std::vector<std::filesystem::path>& plugins,
                                                       FileHashes& hashes);

}  // namespace glocal
