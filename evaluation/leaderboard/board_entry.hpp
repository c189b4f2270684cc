// What a method has come to on a suite, as the leaderboard keeps it: a file of JSON for each of both.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "config/suites.hpp"
#include "evaluation/running/trials.hpp"

namespace glocal {

/// One start. Figures are rounded as they are stored, so that equal results are equal.
struct StartResult {
  Outcome outcome = Outcome::undecided;
  std::size_t steps = 0;          ///< Up to the declaration; all of them if there is none.
  double way_m = 0.0;             ///< Driven in these steps; 0.1 m.
  std::optional<double> cm, deg;  ///< Of the declared pose; 0.1 cm and 0.01 degrees.
  friend bool operator==(const StartResult&, const StartResult&) = default;
};
[[nodiscard]] StartResult start_result(Outcome outcome, std::size_t steps, double way_m,
                                       const std::optional<PoseError>& error);

/// A drive that goes on after the declaration.
struct WholeDrive {
  std::size_t localized = 0;                          ///< Steps on the map that count as localized.
  double cm = 0.0, deg = 0.0;                         ///< Largest errors in these; 0.01 cm and 0.001 degrees.
  std::size_t first_clusters = 0, last_clusters = 0;  ///< In the first step, and in the last.
  friend bool operator==(const WholeDrive&, const WholeDrive&) = default;
};
[[nodiscard]] WholeDrive whole_drive(std::size_t localized, double translation_m, double rotation_deg,
                                     std::size_t first_clusters, std::size_t last_clusters);

/// One case with one seed.
struct CaseResult {
  std::string case_name;
  std::uint64_t seed = 1;
  std::vector<std::size_t> numbers;      ///< Which starts of the case, rising: all, or those of a share.
  std::vector<StartResult> starts;       ///< Of these.
  std::optional<WholeDrive> drive = {};  ///< Where the one trial is a whole drive.
  std::optional<double> step_ms = {};    ///< CPU time of a step, median; none if nobody has measured it.

  /// Of a start, by its number; null if it is not among these.
  [[nodiscard]] const StartResult* find(std::size_t number) const;
};
/// The first `n` starts of a case that belong to a share of the suite. Throws std::invalid_argument where
/// these are not among a million.
[[nodiscard]] std::vector<std::size_t> numbers_in_share(const std::string& case_name, std::uint64_t seed,
                                                        double share, std::size_t n);

struct BoardEntry {
  std::string suite, method;  ///< "planar@1", "indexed".
  double share = 1.0;         ///< Of the suite's starts: is_in_share().
  /// Where it comes from: version, revision, date, command, and more where it is known.
  nlohmann::ordered_json provenance = nlohmann::ordered_json::object();
  std::vector<CaseResult> results;  ///< In the order of the suite, each with all seeds.

  [[nodiscard]] const CaseResult* find(const std::string& case_name, std::uint64_t seed) const;
  /// What runs a method of that name on these starts of a suite, which goes by its name or its file.
  [[nodiscard]] std::string command(const std::string& suite_named) const;
  /// "mcl", or "mcl (share 0.05)" where it has not all starts.
  [[nodiscard]] std::string label() const;
};

/// How many of an entry's starts have ended how.
struct BoardCounts {
  std::size_t starts = 0, right = 0, wrong = 0;
  /// With trials that have failed.
  [[nodiscard]] std::size_t undecided() const { return starts - right - wrong; }
  /// What methods are ranked by: right starts less wrong ones, of all. Entries may have shares of a suite.
  [[nodiscard]] double score() const;
  void add(const CaseResult& result);
};
[[nodiscard]] BoardCounts counts_of(const BoardEntry& entry);

/// CPU time of a step: the median over all starts, each with that of its case. None where nobody has
/// measured.
[[nodiscard]] std::optional<double> median_step_ms(const std::vector<const CaseResult*>& results);

/// Throws ConfigError, at `file`, unless the results are those of all cases, seeds and starts of the suite,
/// or of the entry's share of them; brings them into the suite's order.
void require_whole(BoardEntry& entry, const Suite& suite, const std::filesystem::path& file);

/// The file of a method's entry in the leaderboard's folder.
[[nodiscard]] std::filesystem::path entry_file(const std::filesystem::path& board, const std::string& suite,
                                               const std::string& method);
/// All entries of a suite, by the names of their methods.
[[nodiscard]] std::vector<std::filesystem::path> entry_files(const std::filesystem::path& board,
                                                             const std::string& suite);

/// JSON with an array for each figure, one on a line.
[[nodiscard]] std::string to_text(const BoardEntry& entry);
/// Throws ConfigError for a file that cannot be read, and where it is not as to_text() writes it.
[[nodiscard]] BoardEntry read_entry(const std::filesystem::path& file);

}  // namespace glocal
