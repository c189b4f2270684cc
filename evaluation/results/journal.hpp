// What one process has done, line by line: docs/file-formats.md says what is in them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <mutex>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "evaluation/results/file_io.hpp"
#include "evaluation/results/trial_output.hpp"
#include "evaluation/sharding/shares.hpp"

namespace glocal {

/// Which trial it is, wherever and whenever it is run: 128 bits of a hash.
struct TrialId {
  std::uint64_t high = 0, low = 0;
  friend bool operator==(const TrialId&, const TrialId&) = default;
};
struct TrialIdHash {
  std::size_t operator()(const TrialId& id) const { return id.low; }
};

/// 32 hexadecimal digits, and back. The latter throws std::invalid_argument for other text.
[[nodiscard]] std::string to_string(const TrialId& id);
[[nodiscard]] TrialId trial_id_of(std::string_view text);

/// Of a trial by its number and the sample it starts at; `variant` is as identity_of() tells.
[[nodiscard]] TrialId trial_id(const std::string& variant, std::size_t trial, std::size_t sample);

/// A process that a trial has ended.
struct Crash {
  std::string signal;  ///< "SIGSEGV"
  std::string where;   ///< "matcher 'ransam', step 3"; empty if it is not known.
};

/// CRC-32 as 8 hexadecimal digits, as gzip and zip have it.
[[nodiscard]] std::string checksum(std::string_view bytes);

/// What stands behind its checksum and a space; none if the checksum is another one's.
[[nodiscard]] std::optional<std::string_view> checked_content(std::string_view text);

/// The words that lines begin with, behind their checksums.
namespace journal_words {
inline constexpr std::string_view shard = "shard", variant = "variant", begin = "begin", file = "file",
                                  trial = "trial", crash = "crash";
}

/// What a line has of a file of a trial: its name, relative to the results folder, and its content. Throws a
/// std::exception where it is not as a journal makes it, or leads out of the results.
[[nodiscard]] std::pair<std::string, std::string> file_of_line(std::string_view text);

/// Ends of the names of journals: of those that are still written, and of all others.
inline constexpr std::string_view journal_end = ".jsonl", unfinished_journal_end = ".jsonl.part";

/// A file that no other process writes: its name tells shard, host, process and time. It is renamed when its
/// writer is done. Calls may come from several threads. Every failure throws RunError.
class Journal {
 public:
  /// Makes the file in this folder, which is made if there is none. `jobs` trials run side by side.
  Journal(const std::filesystem::path& folder, const Shard& shard, int jobs);

  [[nodiscard]] const std::filesystem::path& file() const { return file_; }

  /// What the files of a variant need besides its trials.
  void add_variant(const std::string& identity, const nlohmann::ordered_json& description);
  /// A trial that is about to run, with its line `start`.
  void begin(const TrialId& id, const nlohmann::ordered_json& start);
  /// A trial that is over. When this returns, it is on the disk for good.
  void finish(const TrialId& id, double ms, const TrialOutput& output);
  void add_crash(const TrialId& id, const Crash& crash);

  /// Says that the writer is alive, by the clock of the file's server.
  void touch() const;
  /// Renames the file: nothing more will come.
  void close();

 private:
  void add_line(std::string_view word, std::string_view text, bool for_good);

  std::filesystem::path file_;
  Descriptor out_;
  std::mutex mutex_;
};

}  // namespace glocal
